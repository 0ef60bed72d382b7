#include "test/bench_faults/judge/evidence.hpp"

#include <algorithm>
#include <cmath>

#include "common/bus/channels.hpp"
#include "common/bus/convert.hpp"
#include "common/bus/streams.hpp"
#include "common/bus/zone_list.hpp"
#include "common/core/frames.hpp"

namespace rover::bench_faults {
namespace {

constexpr double kLossWindowS = 4.0;
constexpr double kFaultStopWayM = 10.0;
constexpr double kTurningMps = 0.03;
constexpr double kStraysFrom = 0.4;  // fraction of the corridor's half width; below, the prediction is ignored

template <class Message>
Message decoded(const Delivery& delivery) {
  Message message{};
  decode_message(delivery.bytes.data(), static_cast<int>(delivery.bytes.size()), message);
  return message;
}

// NaN counts as bad.
bool above(double value, double limit) {
  return !(value <= limit);
}

template <size_t N>
bool all_finite(const double (&values)[N]) {
  return std::all_of(values, values + N, [](double v) { return std::isfinite(v); });
}

// A winding that heats with the square of current over nominal current.
void heat(double& load, double current_a, double nominal_a, double dt_s, double time_s) {
  if (!std::isfinite(current_a)) return;
  const double square = std::pow(current_a / nominal_a, 2);
  load = square + (load - square) * std::exp(-dt_s / time_s);
}

void forget_older(std::deque<Utime>& times, Utime than) {
  while (!times.empty() && times.front() < than) times.pop_front();
}

double roll_deg(const double q[4]) {
  return to_deg(std::atan2(2.0 * (q[0] * q[1] + q[2] * q[3]), 1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2])));
}
double pitch_deg(const double q[4]) {
  return to_deg(std::asin(std::clamp(2.0 * (q[0] * q[2] - q[3] * q[1]), -1.0, 1.0)));
}

}  // namespace

void Evidence::take(const Delivery& delivery) {
  const std::string& from = delivery.channel;
  headers_[from] = delivery.header;
  if (from == channel::kPose) pose_ = decoded<pose_t>(delivery);
  if (from == channel::kImu) imu_ = decoded<imu_t>(delivery);
  if (from == channel::kWheelState) add_wheels(decoded<wheel_state_t>(delivery));
  if (from == channel::kPlannerStatus) planner_ = decoded<planner_status_t>(delivery);
  if (from == channel::kPath) path_ = decoded<path_t>(delivery);
  if (from == channel::kControlStatus) control_ = decoded<control_status_t>(delivery);
  if (from == channel::kSlip) slip_ = decoded<slip_t>(delivery);
  if (from == channel::kVo) visual_ = decoded<vo_motion_t>(delivery);
  if (from == channel::kSlamPose) slam_ = decoded<slam_pose_t>(delivery);
  if (from == channel::kTraversability) terrain_at_m_ = pose_.travelled_m;
  if (from == channel::kHeartbeat) add_heartbeat(decoded<heartbeat_t>(delivery));
  if (from != channel::kHazards) return;
  hazards_ = decoded<hazards_t>(delivery);
  const bool seen =
      (hazards_.state == hazards_t::CLEAR || hazards_.state == hazards_t::HAZARD) && std::isfinite(hazards_.coverage);
  blind_in_a_row_ = seen ? 0 : blind_in_a_row_ + 1;
  if (seen) seen_utime_ = hazards_.header.utime;
}

void Evidence::add_wheels(const wheel_state_t& wheels) {
  const double dt_s = wheels_.header.utime > 0 ? to_seconds(wheels.header.utime - wheels_.header.utime) : 0.0;
  wheels_ = wheels;
  for (size_t i = 0; i < 6; ++i)
    heat(drive_heat_[i], wheels.drive_current_a[i], settings_.drive_nominal_a, dt_s, settings_.motor_time_s);
  for (size_t i = 0; i < 4; ++i)
    heat(steer_heat_[i], wheels.steer_current_a[i], settings_.steer_nominal_a, dt_s, settings_.motor_time_s);
}

void Evidence::add_heartbeat(const heartbeat_t& beat) {
  const auto account = [](const heartbeat_t& b) {
    Loss sum{b.header.utime, 0.0, 0.0};
    for (const input_health_t& input : b.inputs) {
      if (input.channel != channel::kTick) sum.received += static_cast<double>(input.received);
      sum.lost += static_cast<double>(input.gaps + input.malformed);
    }
    return sum;
  };
  Service& service = services_[beat.header.publisher];
  beat_utime_ = std::max(beat_utime_, beat.header.utime);
  if (service.received && beat.header.boot_id > service.beat.header.boot_id)
    service.starts.push_back(beat.header.utime);
  if (service.received && beat.header.boot_id == service.beat.header.boot_id) {
    const Loss before = account(service.beat), after = account(beat);
    losses_.push_back({after.utime, after.received - before.received, after.lost - before.lost});
  }
  service.received = true;
  service.beat = beat;
}

void Evidence::state(const supervisor_state_t& state) {
  const bool begins = state.state == supervisor_state_t::FAULT_STOP && state_.state != supervisor_state_t::FAULT_STOP;
  if (begins) fault_stops_m_.push_back(pose_.travelled_m);
  state_ = state;
}

void Evidence::forget_counts() {
  for (auto& [name, service] : services_) service.starts.clear();
  kills_.clear();
  fault_stops_m_.clear();
}

void Evidence::tick(Utime now) {
  clock_step_s_ = now_ == kNever ? 0.0 : std::abs(to_seconds(now - now_ - kTickUs));
  now_ = now;
  const Utime window = to_utime(settings_.restart_window_s);
  for (auto& [name, service] : services_) forget_older(service.starts, now - window);
  for (auto& [name, kills] : kills_) forget_older(kills, now - window);
  while (!losses_.empty() && now - losses_.front().utime > to_utime(kLossWindowS)) losses_.pop_front();
  std::erase_if(fault_stops_m_, [&](double at_m) { return pose_.travelled_m - at_m > kFaultStopWayM; });
  const bool on_path = forced_level_ == ground_command_t::AUTO &&
                       std::count(path_.level.begin(), path_.level.end(), std::int8_t{path_t::FULL}) > 0;
  const bool full_waits =
      (on_path || forced_level_ == ground_command_t::FULL) && state_.level != supervisor_state_t::FULL;
  if (!full_waits) full_waits_since_ = kNever;
  if (full_waits && full_waits_since_ == kNever) full_waits_since_ = now;
  const bool turning =
      std::any_of(std::begin(wheels_.drive_rate_radps), std::end(wheels_.drive_rate_radps),
                  [&](double rate) { return std::abs(rate) * settings_.wheel_radius_m > kTurningMps; });
  if (permitted_ || !turning) turning_since_ = kNever;
  if (!permitted_ && turning && turning_since_ == kNever) turning_since_ = now;
  if (!permitted_ || turning) idle_since_ = kNever;
  if (permitted_ && !turning && idle_since_ == kNever) idle_since_ = now;
}

bool Evidence::armed(const Row& row) const {
  using S = supervisor_state_t;
  const std::int8_t s = state_.state;
  if (s == S::BOOT) return false;
  const bool drive_in_progress =
      s == S::DRIVING || s == S::HAZARD_STOP || s == S::REPAIRING || s == S::SWEEPING || s == S::FAULT_STOP;
  switch (row.armed) {
    case Armed::kAlways:
      return true;
    case Armed::kMotion:
      return drive_in_progress || s == S::TELEOP;
    case Armed::kUnderWay:
      return drive_in_progress;
    case Armed::kFull:
      return drive_in_progress && state_.level == S::FULL;
    case Armed::kEfficient:
      return state_.level == S::EFFICIENT;
  }
  return false;
}

bool Evidence::stationary() const {
  const double* v = pose_.velocity_body_mps;
  return std::hypot(v[0], v[1], v[2]) < settings_.stationary_speed_mps &&
         std::abs(pose_.rate_body_radps[2]) < settings_.stationary_rate_radps;
}

Measurement Evidence::of(const header_t& header, bool bad) const {
  if (header.seq == 0) return {};
  return {header.utime, header.release_utime, bad, false};
}

Measurement Evidence::age(Utime utime) const {
  return {utime, utime, false, true};
}

Measurement Evidence::counted(double count, const Row& row) const {
  return {now_, now_, count > row.limit, false};
}

Measurement Evidence::measure(const Row& row) const {
  static const std::map<std::string, const char*> kAges = {{"imu_age_s", channel::kImu},
                                                           {"wheel_state_age_s", channel::kWheelState},
                                                           {"pose_age_s", channel::kPose},
                                                           {"hazards_age_s", channel::kHazards},
                                                           {"planner_age_s", channel::kPlannerStatus},
                                                           {"control_age_s", channel::kControlStatus},
                                                           {"motion_command_age_s", channel::kMotionCommand}};
  if (const auto stream = kAges.find(row.quantity); stream != kAges.end()) {
    const auto newest = headers_.find(stream->second);
    return newest == headers_.end() ? Measurement{} : age(newest->second.utime);
  }
  using Measure = Measurement (Evidence::*)(const Row&) const;
  for (const Measure part :
       {&Evidence::measure_pose, &Evidence::measure_wheels, &Evidence::measure_seen, &Evidence::measure_followed,
        &Evidence::measure_full, &Evidence::measure_service, &Evidence::measure_own})
    if (const Measurement found = (this->*part)(row); found.utime != kNever) return found;
  return {};
}

Measurement Evidence::measure_pose(const Row& row) const {
  const std::string& q = row.quantity;
  const pose_t& p = pose_;
  const auto bad = [&](bool is_bad) { return of(p.header, is_bad); };
  // None used yet: infinite age, from the first pose on that reports it.
  if (q == "vo_age_s") return p.last_vo_utime < 0 ? bad(true) : age(p.last_vo_utime);
  if (q == "pose_lost") {
    const bool known = p.status == pose_t::OK || p.status == pose_t::DEGRADED;
    return bad(!known || !all_finite(p.position_odom_body_m) || !all_finite(p.quat_odom_body_wxyz) ||
               !all_finite(p.position_map_odom_m) || !all_finite(p.quat_map_odom_wxyz) ||
               !all_finite(p.velocity_body_mps) || !std::isfinite(p.rate_body_radps[2]));
  }
  if (q == "pose_sigma_m") return bad(above(std::sqrt(std::max(p.covariance[0], p.covariance[7])), row.limit));
  if (q == "roll_deg") return bad(above(std::abs(roll_deg(p.quat_odom_body_wxyz)), row.limit));
  if (q == "pitch_deg") return bad(above(std::abs(pitch_deg(p.quat_odom_body_wxyz)), row.limit));
  if (q == "tilt_rate_degps")
    return bad(above(to_deg(std::hypot(p.rate_body_radps[0], p.rate_body_radps[1])), row.limit));
  if (q == "slip_ratio") return of(slip_.header, slip_.valid == 1 && above(slip_.slip_ratio, row.limit));
  return {};
}

Measurement Evidence::measure_wheels(const Row& row) const {
  const std::string& q = row.quantity;
  const auto i = static_cast<size_t>(row.motor);
  const auto bad = [&](bool is_bad) { return of(wheels_.header, is_bad); };
  if (q == "drive_current_a") return bad(above(std::abs(wheels_.drive_current_a[i]), row.limit));
  if (q == "steer_current_a") return bad(above(std::abs(wheels_.steer_current_a[i]), row.limit));
  if (q == "drive_i2t_load") return bad(above(drive_heat_[i], row.limit));
  if (q == "steer_i2t_load") return bad(above(steer_heat_[i], row.limit));
  if (q == "wheel_fault")
    return bad(wheels_.status == wheel_state_t::FAULT || !all_finite(wheels_.drive_current_a) ||
               !all_finite(wheels_.steer_current_a) || !all_finite(wheels_.drive_rate_radps));
  if (q == "imu_fault")
    return of(imu_.header, imu_.status != imu_t::OK || !all_finite(imu_.delta_angle_rad) ||
                               !all_finite(imu_.delta_velocity_mps) || !std::isfinite(imu_.fog_delta_yaw_rad));
  return {};
}

Measurement Evidence::measure_seen(const Row& row) const {
  if (row.quantity == "blind_frames") return of(hazards_.header, blind_in_a_row_ > row.limit);
  if (row.quantity == "loccam_age_s") return age(seen_utime_);
  if (row.quantity == "loccam_displaced") return of(visual_.header, visual_.status == vo_motion_t::DISPLACED);
  if (row.quantity == "stereo_coverage") return of(hazards_.header, !(hazards_.coverage >= row.limit));
  return {};
}

Measurement Evidence::measure_followed(const Row& row) const {
  const std::string& q = row.quantity;
  const auto planned = [&](bool is_bad) { return of(planner_.header, is_bad); };
  const auto controlled = [&](bool is_bad) { return of(control_.header, is_bad); };
  if (q == "corridor_deviation") return controlled(control_.state == control_status_t::OUT_OF_CORRIDOR);
  if (q == "path_mismatch") return controlled(planner_.path_id >= 0 && control_.path_id != planner_.path_id);
  if (q == "no_path") return planned(planner_.state == planner_status_t::NO_PATH && stationary());
  if (q == "predicted_corridor_ratio") {
    const double half_m = control_.corridor_half_width_m;
    if (control_.state == control_status_t::STALE_POSE || !(half_m > 0.0)) return controlled(false);
    const double ratio = control_.predicted_corridor_error_m / half_m;
    const bool strays = std::abs(control_.cross_track_m) > kStraysFrom * half_m;
    return controlled(std::isnan(ratio) || (ratio > row.limit && strays));
  }
  if (q == "keep_out_depth_m") return of(pose_.header, above(keep_out_depth_m(), row.limit));
  if (q == "blocked") {
    const bool waits = state_.state == supervisor_state_t::HAZARD_STOP || state_.state == supervisor_state_t::REPAIRING;
    return planned(waits && stationary());
  }
  return {};
}

// Of the footprint now, and until it is stationary if it brakes 0.2 s from now.
double Evidence::keep_out_depth_m() const {
  const std::vector<Zone> zones = zones_from(path_);
  const Pose2 now = planar(pose_from(pose_.position_odom_body_m, pose_.quat_odom_body_wxyz));
  constexpr double kReactionS = 0.2;
  const double v = pose_.velocity_body_mps[0], rate = pose_.rate_body_radps[2], a = settings_.deceleration_mps2;
  const double stop_m = v * kReactionS + 0.5 * v * std::abs(v) / a;
  const bool drives = std::abs(v) > settings_.stationary_speed_mps;
  const double turn =
      drives ? stop_m * rate / v : rate * kReactionS + 0.5 * rate * std::abs(rate) * settings_.half_length_m / a;
  double deepest_m = 0.0;
  for (const double u : {0.0, 0.5, 1.0}) {
    const double course = now.yaw_rad + 0.5 * u * turn;
    const Pose2 then{now.x_m + u * stop_m * std::cos(course), now.y_m + u * stop_m * std::sin(course),
                     now.yaw_rad + u * turn};
    deepest_m = std::max(deepest_m, forbidden_depth_m(zones, then, settings_.half_length_m, settings_.half_width_m));
  }
  return deepest_m;
}

Measurement Evidence::measure_full(const Row& row) const {
  const std::string& q = row.quantity;
  if (q == "terrain_distance_m") {
    const bool sweeps = state_.state == supervisor_state_t::SWEEPING;
    return of(pose_.header, !sweeps && !(pose_.travelled_m - terrain_at_m_ <= row.limit));
  }
  if (q == "slam_lost") return of(slam_.header, slam_.status == slam_pose_t::LOST);
  if (q == "sweep_s") {
    const bool sweeps = state_.state == supervisor_state_t::SWEEPING;
    return counted(sweeps ? to_seconds(now_ - state_.since_utime) : 0.0, row);
  }
  return {};
}

// Services of the Full level have the same quantities under other names.
Measurement Evidence::measure_service(const Row& row) const {
  std::string q = row.quantity;
  for (const std::string prefix : {"full_idle_", "full_"})
    if (q.starts_with(prefix)) q.erase(0, prefix.size());
  const auto known = services_.find(q == "log_lost" ? "recorder" : row.service);
  if (known == services_.end()) return {};
  const Service& service = known->second;
  if (q == "heartbeat_age_s" || q == "optional_heartbeat_age_s") return age(service.beat.header.utime);
  if (q == "missing_s") {
    const bool silent = to_seconds(now_ - service.beat.header.utime) > row.limit;
    return counted(silent && full_waits_since_ != kNever ? to_seconds(now_ - full_waits_since_) : 0.0, row);
  }
  if (q == "log_lost") return of(service.beat.header, service.beat.status != heartbeat_t::OK);
  if (q == "service_fault")
    return of(service.beat.header,
              service.beat.status != heartbeat_t::OK && service.beat.status != heartbeat_t::DEGRADED);
  if (q == "starts_per_minute") return counted(static_cast<double>(service.starts.size()), row);
  if (q == "restart_attempts") {
    const auto kills = kills_.find(row.service);
    return counted(kills == kills_.end() ? 0.0 : static_cast<double>(kills->second.size()), row);
  }
  return {};
}

Measurement Evidence::measure_own(const Row& row) const {
  const std::string& q = row.quantity;
  if (q == "clock_step_s") return counted(clock_step_s_, row);
  if (q == "fault_stops") return counted(static_cast<double>(fault_stops_m_.size()), row);
  if (q == "unpermitted_motion_s")
    return counted(turning_since_ == kNever ? 0.0 : to_seconds(now_ - turning_since_), row);
  if (q == "idle_drive_s") return counted(idle_since_ == kNever ? 0.0 : to_seconds(now_ - idle_since_), row);
  if (q == "message_loss_ratio") {
    double received = 0.0, lost = 0.0;
    for (const Loss& loss : losses_) received += loss.received, lost += loss.lost;
    return {beat_utime_, beat_utime_ + kTickUs, lost > row.limit * (received + lost), false};
  }
  return {};
}

}  // namespace rover::bench_faults
