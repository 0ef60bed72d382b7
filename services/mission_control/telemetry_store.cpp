#include "mission_control/telemetry_store.hpp"

#include <algorithm>
#include <cmath>

#include "common/bus/convert.hpp"
#include "common/bus/s6_client.hpp"
#include "common/bus/service_names.hpp"
#include "common/bus/state_names.hpp"

namespace rover::mission {
namespace {

constexpr Utime kRateWindow = 3'000'000;
constexpr double kCpuWindowS = 3.0;
constexpr double kStartupGraceS = 2.0;
constexpr Utime kPoseHistory = 4'000'000;
constexpr size_t kImagesKept = 8;  // the hazard grid arrives about one image later
constexpr Utime kHazardsTimeout = 1'500'000;
constexpr int kMaxGridCells = 2048;                 // per side
constexpr std::int64_t kMaxCountedBoots = 100'000;  // larger boot ids are clock values of processes started manually

bool is_valid_grid(int nx, int ny, size_t size, double cell_m) {
  return nx > 0 && ny > 0 && nx <= kMaxGridCells && ny <= kMaxGridCells && size == static_cast<size_t>(nx) * ny &&
         cell_m > 0.0 && cell_m < 10.0;
}

}  // namespace

TelemetryStore::TelemetryStore(const std::vector<std::string>& services) : expected_(services) {
  for (const std::string& name : expected_) services_[name];
}

void TelemetryStore::reset() {
  TelemetryStore fresh(expected_);
  fresh.camera_ = camera_;
  *this = std::move(fresh);
}

void TelemetryStore::add(const tick_t& message, double wall_s) {
  const Utime utime = message.header.utime;
  if (utime <= view_.now) return;  // repeated
  view_.now = utime;
  if (first_tick_ == kNever) first_tick_ = utime;
  ticks_.emplace_back(utime, wall_s);
  while (ticks_.front().first < utime - kRateWindow) ticks_.pop_front();
}

void TelemetryStore::add(const heartbeat_t& message, double wall_s) {
  ServiceRecord& record = services_[message.service];
  if (message.header.boot_id != record.boot_id) record.cpu.clear();
  record.last_heartbeat = message.header.utime;
  record.boot_id = message.header.boot_id;
  record.pid = message.pid;
  record.status = message.status;
  record.rss_mb = message.rss_mb;
  record.text = message.text;
  record.cpu.emplace_back(wall_s, message.cpu_s);
  while (record.cpu.size() > 2 && record.cpu.front().first < wall_s - kCpuWindowS) record.cpu.pop_front();
}

void TelemetryStore::add(const supervisor_state_t& m) {
  view_.state = {m.header.utime, state_name(m.state), level_name(m.level), m.since_utime, m.cause, m.quantity,
                 m.value,        m.threshold,         m.hazard_stops,      m.faults};
  if (!std::exchange(full_services_run_, m.full_stopped == 0) && full_services_run_) ++starts_on_demand_;
}

void TelemetryStore::add(const fault_t& m) {
  if (m.active == 0)
    view_.faults.erase(m.id);
  else
    view_.faults[m.id] = {m.value, m.limit, response_name(m.response)};
}

void TelemetryStore::add(const drive_permit_t& m) {
  view_.permit = {m.granted == 1, m.valid_until_utime, m.max_speed_mps, m.reason};
}

void TelemetryStore::add(const pose_t& m) {
  const Eigen::Isometry3d T_odom_body = pose_from(m.position_odom_body_m, m.quat_odom_body_wxyz);
  const Eigen::Isometry3d T_map_odom = pose_from(m.position_map_odom_m, m.quat_map_odom_wxyz);
  const Eigen::Isometry3d T_map_body = T_map_odom * T_odom_body;
  PoseView& pose = view_.pose;
  pose.utime = m.header.utime;
  pose.status = m.status;
  pose.position_map_m = T_map_body.translation();
  const Eigen::Vector3d rpy = rpy_of(T_odom_body.rotation());
  pose.roll_rad = rpy.x();
  pose.pitch_rad = rpy.y();
  pose.yaw_rad = yaw_of(T_map_body);
  pose.speed_mps = m.velocity_body_mps[0];
  pose.sigma_m = std::sqrt(std::max(m.covariance[0], m.covariance[7]));
  pose.travelled_m = m.travelled_m;
  pose.map_odom = planar(T_map_odom);
  poses_.emplace_back(m.header.utime, planar(T_odom_body));
  while (poses_.front().first < m.header.utime - kPoseHistory) poses_.pop_front();
}

void TelemetryStore::add(const planner_status_t& m) {
  view_.planner = {m.state, m.blocked_in_m, m.goal_distance_m, m.corridor_offset_m, m.replans, m.text};
}

void TelemetryStore::add(const control_status_t& m) {
  view_.motion.cross_track_m = m.cross_track_m;
  view_.motion.corridor_half_width_m = m.corridor_half_width_m;
}

void TelemetryStore::add(const slip_t& m) {
  view_.motion.slip_ratio = m.valid == 1 ? m.slip_ratio : kNaN;
}

void TelemetryStore::add(const wheel_state_t& m) {
  for (size_t i = 0; i < 6; ++i)
    view_.motion.drive_current_a[i] = std::fmax(view_.motion.drive_current_a[i], std::abs(m.drive_current_a[i]));
  std::copy(std::begin(m.steer_angle_rad), std::end(m.steer_angle_rad), view_.motion.steer_rad.begin());
}

void TelemetryStore::add(const path_t& m) {
  if (m.frame != path_t::ODOM || m.path_id == view_.path.id) return;
  view_.path = {m.path_id, m.kind, m.x_m, m.y_m};
}

GridContent& TelemetryStore::set_grid(const std::string& name, const header_t& header, const Pose2& odom, double cell_m,
                                      double x_m, double y_m, int nx, int ny) {
  GridView& grid = view_.grids[name];
  grid.seq = header.utime;
  grid.utime = header.utime;
  grid.odom = odom;
  grid.cell_m = cell_m;
  grid.origin_x_m = x_m;
  grid.origin_y_m = y_m;
  grid.cells_x = nx;
  grid.cells_y = ny;
  return grids_[name] = {header.utime, nx, ny, cell_m, {}, {}};
}

void TelemetryStore::add(const hazards_t& m) {
  if (!is_valid_grid(m.cells_x, m.cells_y, m.cells.size(), m.cell_m)) return;
  set_grid("hazards", m.header, odom_at(m.header.utime), m.cell_m, m.origin_x_m, m.origin_y_m, m.cells_x, m.cells_y)
      .cells = m.cells;
  GridView& grid = view_.grids["hazards"];
  grid.note = m.state == hazards_t::BLIND ? "blind" : m.state == hazards_t::HAZARD ? "hazard" : "clear";
  grid.plane_pitch_rad = m.plane_pitch_rad;
  grid.plane_roll_rad = m.plane_roll_rad;
  select_loccam_image();
}

void TelemetryStore::add(const traversability_t& m) {
  if (!is_valid_grid(m.cells_x, m.cells_y, m.cells.size(), m.cell_m)) return;
  set_grid("traversability", m.header, {}, m.cell_m, m.origin_x_m, m.origin_y_m, m.cells_x, m.cells_y).cells = m.cells;
  constexpr auto kUnknown = traversability_t::UNKNOWN;  // LCM's constants have no address
  const auto unknown = std::count(m.cells.begin(), m.cells.end(), kUnknown);
  view_.terrain = {m.header.utime, m.difficulty,
                   1.0 - static_cast<double>(unknown) / static_cast<double>(m.cells.size())};
}

void TelemetryStore::add(const elevation_t& m) {
  if (!is_valid_grid(m.cells_x, m.cells_y, m.height_m.size(), m.cell_m)) return;
  set_grid("elevation", m.header, {}, m.cell_m, m.origin_x_m, m.origin_y_m, m.cells_x, m.cells_y).heights_m =
      m.height_m;
}

void TelemetryStore::add(const ptu_state_t& m) {
  view_.pan_tilt = {m.header.utime, m.pan_rad, m.tilt_rad, m.moving != 0};
}

void TelemetryStore::add(const slam_pose_t& m) {
  view_.slam = {m.header.utime, m.status, m.information, m.particles};
}

// CORRECTION arrives before localization applies it, so the current pose is the uncorrected one.
void TelemetryStore::add(const correction_t& m) {
  const Pose2 corrected{m.x_m, m.y_m, m.yaw_rad};
  const Pose2 odom = poses_.empty() ? Pose2{kNaN, kNaN, kNaN} : poses_.back().second;
  const Eigen::Vector3d at = from_planar(odom).translation();
  const double moved_m = (from_planar(corrected) * at - from_planar(view_.pose.map_odom) * at).head<2>().norm();
  view_.correction = {m.header.utime, m.accepted != 0, m.accepted ? moved_m : kNaN, m.score, m.reason};
}

void TelemetryStore::add_loccam(const image_t& message) {
  loccam_.push_back(std::make_shared<const image_t>(message));
  if (loccam_.size() > kImagesKept) loccam_.pop_front();
  select_loccam_image();
}

void TelemetryStore::add_navcam(const image_t& message) {
  show("navcam", std::make_shared<const image_t>(message));
}

// Shows the image of the newest hazard grid; the newest image if the grid is 1.5 s late.
void TelemetryStore::select_loccam_image() {
  if (loccam_.empty()) return;
  const auto grid = view_.grids.find("hazards");
  const Utime analysed = grid == view_.grids.end() ? kNever : grid->second.utime;
  const auto same =
      std::find_if(loccam_.begin(), loccam_.end(), [&](const auto& i) { return i->header.utime == analysed; });
  if (same != loccam_.end())
    show("loccam", *same);
  else if (loccam_.back()->header.utime - analysed > kHazardsTimeout)
    show("loccam", loccam_.back());
}

void TelemetryStore::show(const std::string& name, const std::shared_ptr<const image_t>& image) {
  if (image->width <= 0 || image->height <= 0 || image->encoding != image_t::MONO8 ||
      image->data.size() != static_cast<size_t>(image->width) * static_cast<size_t>(image->height))
    return;
  images_[name] = image;
  view_.images[name] = {image->header.utime, image->header.utime, image->width, image->height};
}

void TelemetryStore::add(const disparity_t& message) {
  camera_ = camera_from(message);
}

void TelemetryStore::add(const truth_t& m) {
  const Eigen::Isometry3d T = pose_from(m.position_map_body_m, m.quat_map_body_wxyz);
  truth_ = {m.header.utime, T.translation(), yaw_of(T)};
}

Pose2 TelemetryStore::odom_at(Utime utime) const {
  const auto at = std::find_if(poses_.begin(), poses_.end(), [utime](const auto& p) { return p.first >= utime; });
  if (at != poses_.end()) return at->second;
  return poses_.empty() ? Pose2{kNaN, kNaN, kNaN} : poses_.back().second;
}

ServiceView TelemetryStore::view_of(const std::string& name, const ServiceRecord& record) const {
  const bool full = is_full_service(name);
  const bool never = record.last_heartbeat == kNever;
  const bool lost = never || view_.now - record.last_heartbeat > kHeartbeatTimeoutUs || !process_alive(record.pid);
  ServiceView out;
  if (lost && full && !full_services_run_) {
    out.health = Health::kStopped;
    return out;
  }
  if (never) {
    if (first_tick_ != kNever && to_seconds(view_.now - first_tick_) > kStartupGraceS) out.health = Health::kLost;
    return out;
  }
  out.age_s = std::max(0.0, to_seconds(view_.now - record.last_heartbeat));
  out.rss_mb = record.rss_mb;
  out.text = record.text;
  if (record.boot_id < kMaxCountedBoots)
    out.restarts = std::max(0, static_cast<int>(record.boot_id) - 1 - (full ? starts_on_demand_ : 0));
  const auto& [wall_0, cpu_0] = record.cpu.front();
  const auto& [wall_1, cpu_1] = record.cpu.back();
  if (wall_1 - wall_0 > 0.3) out.cpu_percent = 100.0 * (cpu_1 - cpu_0) / (wall_1 - wall_0);
  out.health = lost                                     ? Health::kLost
               : record.status == heartbeat_t::OK       ? Health::kOk
               : record.status == heartbeat_t::DEGRADED ? Health::kDegraded
                                                        : Health::kFault;
  return out;
}

View TelemetryStore::view(double wall_s) {
  if (!ticks_.empty()) {
    const double span_s = wall_s - ticks_.front().second;
    view_.tick_age_s = wall_s - ticks_.back().second;
    view_.realtime_factor = span_s > 0.5 ? to_seconds(ticks_.back().first - ticks_.front().first) / span_s : kNaN;
  }
  for (const auto& [name, record] : services_) view_.services[name] = view_of(name, record);
  View out = view_;
  view_.motion.drive_current_a.fill(kNaN);
  return out;
}

std::optional<GridContent> TelemetryStore::grid(const std::string& name) const {
  const auto found = grids_.find(name);
  if (found == grids_.end()) return std::nullopt;
  return found->second;
}

std::shared_ptr<const image_t> TelemetryStore::image(const std::string& name) const {
  const auto found = images_.find(name);
  return found == images_.end() ? nullptr : found->second;
}

}  // namespace rover::mission
