#include "test/mission_control/made_up_drive.hpp"

#include <unistd.h>

#include <opencv2/imgproc.hpp>
#include <rover/control_status_t.hpp>
#include <rover/correction_t.hpp>
#include <rover/disparity_t.hpp>
#include <rover/drive_permit_t.hpp>
#include <rover/hazards_t.hpp>
#include <rover/heartbeat_t.hpp>
#include <rover/image_t.hpp>
#include <rover/path_t.hpp>
#include <rover/planner_status_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/ptu_state_t.hpp>
#include <rover/slam_pose_t.hpp>
#include <rover/slip_t.hpp>
#include <rover/supervisor_state_t.hpp>
#include <rover/tick_t.hpp>
#include <rover/traversability_t.hpp>
#include <rover/wheel_state_t.hpp>

#include "common/bus/channels.hpp"
#include "common/bus/convert.hpp"
#include "traversability/convert.hpp"
#include "traversability/difficulty.hpp"

namespace rover::mission::test {
namespace {

constexpr double kSpeedMps = 0.2;
constexpr double kAheadM = 12.0;  // driven before the page is opened
constexpr double kWholeM = 45.0;
const Pose2 kMapOdom{12.0, 18.0, 0.15};

World rocky_world() {
  WorldConfig config;
  config.rocks.k = 0.10;
  config.roughness.rms_m = 0.015;
  return World(config, plane_raster(80.0, 80.0, 1.0, to_rad(5.0), 0.7), 4);
}

bool each(Utime now, Utime period) {
  return now % period == 0;
}

Pose2 in_odom(const Pose2& map) {
  return planar(from_planar(kMapOdom).inverse() * from_planar(map));
}

// Grey ground with round stones under a light sky.
image_t picture(int width, int height, int horizon, Utime now) {
  cv::Mat grey(height, width, CV_8UC1);
  for (int v = 0; v < height; ++v)
    grey.row(v) = v < horizon ? 205 - v / 6 : 95 + 70 * (v - horizon) / (height - horizon);
  for (int k = 0; k < 26; ++k) {
    const int u = (k * 197 + static_cast<int>(now / 400'000) * 3) % width,
              v = horizon + 12 + (k * 71) % (height - horizon - 12);
    const int r = 3 + (v - horizon) / 14;
    cv::ellipse(grey, {u + r / 2, v + r / 2}, {2 * r, r / 2}, 0, 0, 360, 45, cv::FILLED, cv::LINE_AA);
    cv::ellipse(grey, {u, v}, {r + r / 3, r}, 10 * k, 0, 360, 130 + (k * 13) % 70, cv::FILLED, cv::LINE_AA);
  }
  image_t image{};
  image.width = static_cast<std::int16_t>(width);
  image.height = static_cast<std::int16_t>(height);
  image.encoding = image_t::MONO8;
  image.size = width * height;
  image.data.assign(grey.data, grey.data + image.size);
  return image;
}

}  // namespace

MadeUpDrive::MadeUpDrive(lcm::LCM& bus, std::vector<std::string> services)
    : bus_(bus), services_(std::move(services)), world_(rocky_world()) {}

Pose2 MadeUpDrive::pose_at(double distance_m) {
  const double yaw = 0.35 + 0.45 * std::sin(0.12 * distance_m);
  double x = 14.0, y = 20.0;
  for (double s = 0.0; s < distance_m; s += 0.05) {
    const double along = 0.35 + 0.45 * std::sin(0.12 * s);
    x += 0.05 * std::cos(along);
    y += 0.05 * std::sin(along);
  }
  return {x, y, yaw};
}

double MadeUpDrive::distance_m(Utime now) const {
  return std::min(kWholeM, kAheadM + kSpeedMps * to_seconds(now));
}

template <class Message>
void MadeUpDrive::publish(const char* channel, Message message, Utime utime) {
  message.header.utime = message.header.release_utime = utime;
  message.header.publisher = "made_up_drive";
  bus_.publish(channel, &message);
}

void MadeUpDrive::say(Utime now) {
  travelled_m_ = distance_m(now);
  publish(channel::kTick, tick_t{}, now);
  say_motion(now);
  if (each(now, 200'000)) say_supervision(now);
  if (each(now, 1'000'000)) say_paths(now);
  if (each(now, 400'000)) say_hazards(now);
  if (each(now, 2'500'000)) {
    say_images(now);
    say_terrain(now);
    say_slam(now);
  }
}

void MadeUpDrive::say_motion(Utime now) {
  const Pose2 at = pose_at(travelled_m_);
  Eigen::Isometry3d T_odom_body = from_planar(in_odom(at));
  T_odom_body.linear() = rotation_from_rpy(0.04, -0.06, yaw_of(T_odom_body));
  pose_t pose{};
  pose_to(T_odom_body, pose.position_odom_body_m, pose.quat_odom_body_wxyz);
  pose_to(from_planar(kMapOdom), pose.position_map_odom_m, pose.quat_map_odom_wxyz);
  pose.covariance[0] = pose.covariance[7] = 0.02;
  pose.velocity_body_mps[0] = kSpeedMps;
  pose.travelled_m = travelled_m_;
  publish(channel::kPose, pose, now);
  wheel_state_t wheels{};
  for (int i = 0; i < 6; ++i) wheels.drive_current_a[i] = 1.2 + 0.3 * i;
  publish(channel::kWheelState, wheels, now);
  slip_t slip{};
  slip.valid = 1;
  slip.slip_ratio = 0.08;
  publish(channel::kSlip, slip, now);
  control_status_t control{};
  publish(channel::kControlStatus, control, now);
  ptu_state_t unit{};
  unit.pan_rad = 0.5 * std::sin(0.3 * to_seconds(now));
  unit.tilt_rad = 0.1;
  publish(channel::kPtuState, unit, now);
}

void MadeUpDrive::say_supervision(Utime now) {
  supervisor_state_t state{};
  state.state = supervisor_state_t::DRIVING;
  state.level = supervisor_state_t::FULL;
  state.cause = "slow_progress";
  state.quantity = "effective_speed_mps";
  state.value = 0.043;
  state.threshold = 0.06;
  state.hazard_stops = 1;
  publish(channel::kState, state, now);
  drive_permit_t permit{};
  permit.granted = 1;
  permit.valid_until_utime = now + 400'000;
  permit.max_speed_mps = kSpeedMps;
  publish(channel::kDrivePermit, permit, now);
  planner_status_t planner{};
  planner.state = planner_status_t::FOLLOWING;
  planner.goal_distance_m = kWholeM - travelled_m_;
  planner.replans = 3;
  publish(channel::kPlannerStatus, planner, now);
  for (const std::string& name : services_) {
    heartbeat_t heartbeat{};
    heartbeat.service = name;
    heartbeat.pid = getpid();
    heartbeat.cpu_s = 0.1 * to_seconds(now);
    heartbeat.rss_mb = 40.0;
    heartbeat.header.boot_id = 1;
    publish(channel::kHeartbeat, heartbeat, now);
  }
}

void MadeUpDrive::say_paths(Utime now) {
  path_t path{};
  path.path_id = now / 1'000'000 + 1;
  path.frame = path_t::ODOM;
  path.kind = path_t::CONTINUOUS;
  for (double s = travelled_m_; s <= travelled_m_ + 7.0; s += 0.25) {
    const Pose2 at = in_odom(pose_at(s));
    path.x_m.push_back(at.x_m);
    path.y_m.push_back(at.y_m);
    path.level.push_back(path_t::FULL);
    path.direction.push_back(std::int8_t{path_t::FORWARD});
  }
  path.point_count = static_cast<std::int32_t>(path.x_m.size());
  publish(channel::kPath, path, now);
}

bool MadeUpDrive::seen(double x_m, double y_m) const {
  return std::any_of(stations_.begin(), stations_.end(), [&](const Pose2& from) {
    const double dx = x_m - from.x_m, dy = y_m - from.y_m, range = std::hypot(dx, dy);
    return range > 1.2 && range < 9.0 && std::abs(wrap_angle(std::atan2(dy, dx) - from.yaw_rad)) < to_rad(45.0);
  });
}

elevation_t MadeUpDrive::elevation() const {
  const Pose2 at = in_odom(pose_at(travelled_m_));
  elevation_t map{};
  map.cell_m = 0.1;
  map.cells_x = map.cells_y = 200;
  map.size = 40000;
  map.origin_x_m = 0.1 * std::round(10.0 * (at.x_m - 10.0));
  map.origin_y_m = 0.1 * std::round(10.0 * (at.y_m - 10.0));
  map.sigma_m.assign(40000, 0.01F);
  const Eigen::Isometry3d T_map_odom = from_planar(kMapOdom);
  for (int iy = 0; iy < 200; ++iy)
    for (int ix = 0; ix < 200; ++ix) {
      const Eigen::Vector3d p =
          T_map_odom * Eigen::Vector3d(map.origin_x_m + 0.1 * (ix + 0.5), map.origin_y_m + 0.1 * (iy + 0.5), 0.0);
      map.height_m.push_back(seen(p.x(), p.y()) ? static_cast<float>(world_.height_m(p.x(), p.y())) : NAN);
    }
  return map;
}

void MadeUpDrive::say_terrain(Utime now) {
  stations_.clear();
  for (double back = 0.0; back <= 9.0; back += 1.0) stations_.push_back(pose_at(std::max(0.0, travelled_m_ - back)));
  const elevation_t map = elevation();
  publish(channel::kElevation, map, now);
  const trav::TraversabilityConfig config;
  const trav::TraversabilityMap costs = trav::compute_traversability(trav::grid_from(map), config);
  traversability_t terrain{};
  trav::traversability_to(costs, trav::difficulty_ahead(costs, in_odom(pose_at(travelled_m_)), config.ahead), terrain);
  publish(channel::kTraversability, terrain, now);
}

void MadeUpDrive::say_hazards(Utime now) {
  hazards_t hazards{};
  hazards.cell_m = 0.1;
  hazards.origin_x_m = 0.5;
  hazards.origin_y_m = -2.0;
  hazards.cells_x = 35;
  hazards.cells_y = 40;
  hazards.size = 1400;
  for (int iy = 0; iy < 40; ++iy)
    for (int ix = 0; ix < 35; ++ix) {
      const bool view = std::abs(iy - 19.5) < 4.0 + 0.35 * ix && ix > 3 && ix < 22;
      const bool rock = std::hypot(ix - 16.0, iy - 26.0) < 2.5;
      hazards.cells.push_back(static_cast<std::uint8_t>(rock ? +hazards_t::OBSTACLE : view ? +hazards_t::FREE : 0));
    }
  publish(channel::kHazards, hazards, now);
  publish(channel::kLocCamRectLeft, picture(512, 384, 20, now), now);
}

void MadeUpDrive::say_images(Utime now) {
  publish(channel::kNavCamLeft, picture(640, 480, 90, now), now);
}

void MadeUpDrive::say_slam(Utime now) {
  slam_pose_t slam{};
  slam.status = slam_pose_t::OK;
  slam.information = 0.7;
  slam.particles = 120;
  publish(channel::kSlamPose, slam, now);
  if (!each(now, 10'000'000)) return;
  correction_t correction{};
  correction.accepted = 1;
  correction.x_m = kMapOdom.x_m + 0.3;
  correction.y_m = kMapOdom.y_m - 0.2;
  correction.yaw_rad = kMapOdom.yaw_rad;
  correction.score = 0.83;
  publish(channel::kCorrection, correction, now);
}

}  // namespace rover::mission::test
