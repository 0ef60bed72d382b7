#include "localization/localization.hpp"

#include <algorithm>
#include <cmath>

namespace rover::loc {
namespace {

constexpr Utime kFutureUs = 1'000'000;    // later inputs than this after the newest tick are rejected
constexpr Utime kEncoderGapUs = 500'000;  // wheel travel over a longer gap is unknown
constexpr Utime kPoseGapUs = 100'000;     // the pose within a longer gap is unknown
constexpr double kHistoryMarginS = 2.0;   // what leaves the history next
constexpr double kMinCoverage = 0.5;      // of a record's time; the mean rate fills the rest
constexpr double kWheelMotionRad = 0.01;  // smaller rotations are encoder noise
constexpr double kChordM = 0.05;          // chord length for measuring the travelled distance

Eigen::Vector3d planar_motion(const Eigen::Isometry3d& T) {
  return {T.translation().x(), T.translation().y(), yaw_of(T)};
}

MotionRecord without_gyro(MotionRecord record) {
  record.gyro_valid = false;
  record.stationary = record.settled = false;
  return record;
}

}  // namespace

Localization::Localization(const LocalizationConfig& config, const Vehicle& vehicle)
    : config_(config),
      wheels_(vehicle),
      ground_m_(0.0, 0.0, config.camera_only.enabled ? 0.0 : -vehicle.origin_height_m),
      filter_(config.filter, -ground_m_.z()),
      imu_monitor_(config.imu),
      static_alignment_(config.static_alignment),
      map_(config.map),
      slip_(config.slip, wheels_),
      history_(to_utime(config.history_s)),
      chain_(config.chain_s) {}

// ---- inputs

std::string_view Localization::add_imu(const ImuSample& sample) {
  if (!sample.healthy) return {};  // the monitor times out
  if (const auto error = validation_error(sample); !error.empty()) return error;
  if (sample.utime <= newest_imu_utime_) return "not newer than the one before";
  if (is_future(sample.utime)) return "from the future";
  newest_imu_utime_ = sample.utime;
  if (imu_monitor_.add(sample)) imu_queue_.push_back(sample);
  return {};
}

std::string_view Localization::add_wheels(const WheelSample& sample) {
  if (!sample.healthy) return {};
  if (const auto error = validation_error(sample); !error.empty()) return error;
  if (sample.utime <= newest_wheels_utime_) return "not newer than the one before";
  if (is_future(sample.utime)) return "from the future";
  newest_wheels_utime_ = sample.utime;
  wheel_queue_.push_back(sample);
  return {};
}

std::string_view Localization::add_wheel_command(const WheelCommand& command) {
  if (const auto error = validation_error(command); !error.empty()) return error;
  command_ = command;
  return {};
}

std::string_view Localization::add_visual_motion(const VisualMotion& motion) {
  if (const auto error = validation_error(motion, config_.max_speed_mps); !error.empty()) return error;
  if (motion.status == VisualStatus::kLost || !initialised_) return {};
  return fuse_visual_motion(motion);
}

std::string_view Localization::set_start_pose(const StartPose& start) {
  if (const auto error = validation_error(start); !error.empty()) return error;
  if (!initialised_) return "not level yet: the rover has to stand, with IMU and wheels alive";
  map_.set_start(start, predicted_.T_odom_body);
  slam_queue_.clear();
  reset_covariance(start);
  return {};
}

std::string_view Localization::apply_correction(const MapMeasurement& measurement) {
  if (const auto error = validation_error(measurement); !error.empty()) return error;
  const auto T_odom_body = pose_at(measurement.utime);
  if (!T_odom_body) return "of a time without a pose";
  // The pose's covariance is optimistic after long drives: inflate it if the correction lies outside the gate.
  const bool outside_gate = map_.known() && !map_.within_gate(measurement, *T_odom_body, predicted_.P);
  const auto rejection = map_.apply_correction(
      measurement, *T_odom_body, outside_gate ? map_.inflated(predicted_.P, measurement.cov) : predicted_.P);
  if (!rejection.empty()) return rejection;
  slam_queue_.clear();
  for (ErrorCov* P : {&fused_.P, &predicted_.P, &chain_.anchor().P})
    *P = map_.updated_cov(outside_gate ? map_.inflated(*P, measurement.cov) : *P, measurement.cov);
  return {};
}

std::string_view Localization::add_slam_pose(const MapMeasurement& measurement) {
  if (const auto error = validation_error(measurement); !error.empty()) return error;
  const auto T_odom_body = pose_at(measurement.utime);
  if (!T_odom_body) return "of a time without a pose";
  const auto rejection = map_.rejection(measurement, *T_odom_body, predicted_.P);
  if (rejection.empty()) slam_queue_.push_back(measurement);
  return rejection;
}

// The next visual motion changes odometry at the time of a cloud for the last time. If it is overdue, SLAM replaces it.
void Localization::fuse_slam(Utime now) {
  for (; !slam_queue_.empty(); slam_queue_.pop_front()) {
    const MapMeasurement& slam = slam_queue_.front();
    const bool settled = fused_.utime >= slam.utime;
    if (!settled && to_seconds(now - slam.utime) < config_.status.visual_degraded_s) return;
    FilterState at_cloud = settled ? fused_ : propagate_to(fused_, slam.utime);
    const bool moved = map_.add_slam_pose(slam, at_cloud);
    if (settled || !moved || !slam.position_observable) continue;
    at_cloud.dead_reckoned_m = 0.0;
    apply_fused_state(at_cloud);
  }
}

void Localization::reset_covariance(const StartPose& start) {
  for (FilterState* state : {&fused_, &predicted_}) {
    for (const int i : {kPosition, kPosition + 1, kPosition + 2, kAttitude + 2}) {
      state->P.row(i).setZero();
      state->P.col(i).setZero();
      const double sigma = i == kAttitude + 2 ? start.sigma_yaw_rad : start.sigma_m;
      state->P(i, i) = sigma * sigma;
    }
  }
  // The chain's anchor still has the old covariance.
  chain_.clear();
}

// ---- tick

// Relative to the tick, not to the pose: after a clock step the pose is old, but new samples are valid.
bool Localization::is_future(Utime utime) const {
  return newest_tick_utime_ != kNever && utime > newest_tick_utime_ + kFutureUs;
}

void Localization::step(Utime now) {
  newest_tick_utime_ = now;
  if (const auto record = next_record(now)) {
    history_.add(*record);
    slip_.add(*record);
    if (!initialised_)
      initialise(*record);
    else
      predict(*record);
    if (initialised_) {
      fuse_slam(now);
      update_pose(*record);
    }
  }
  update_status(now);
}

std::optional<MotionRecord> Localization::next_record(Utime now) {
  Utime end = last_record_end_ == kNever ? (config_.camera_only.enabled ? now : kNever) : last_record_end_ + kTickUs;
  bool measured = false;
  for (const ImuSample& s : imu_queue_)
    if (s.utime <= now) end = measured ? std::max(end, s.utime) : s.utime, measured = true;
  for (const WheelSample& s : wheel_queue_)
    if (s.utime <= now) end = measured ? std::max(end, s.utime) : s.utime, measured = true;
  if (end == kNever || end > now || end <= last_record_end_) return std::nullopt;
  MotionRecord record;
  record.start = last_record_end_ == kNever ? end - kTickUs : last_record_end_;
  record.end = end;
  integrate_imu(record);
  integrate_wheels(record);
  integrate_command(record);
  detect_stationary(record);
  last_record_end_ = end;
  return record;
}

void Localization::integrate_imu(MotionRecord& record) {
  double covered_s = 0.0;
  record.fog_valid = true;
  while (!imu_queue_.empty() && imu_queue_.front().utime <= record.end) {
    const ImuSample& s = imu_queue_.front();
    if (s.utime > record.start - to_utime(config_.imu.timeout_s)) {  // late, not lost
      covered_s += s.dt_s;
      Eigen::Vector3d rotation = s.delta_angle_rad;
      if (std::isfinite(s.fog_delta_yaw_rad))
        rotation.z() = s.fog_delta_yaw_rad;
      else
        record.fog_valid = false;
      record.delta_angle_rad += rotation;
      record.delta_velocity_mps += s.delta_velocity_mps;
    }
    imu_queue_.pop_front();
  }
  if (covered_s < kMinCoverage * record.dt_s()) return;
  record.gyro_valid = record.force_valid = true;
  record.delta_angle_rad *= record.dt_s() / covered_s;
  record.delta_velocity_mps *= record.dt_s() / covered_s;
}

void Localization::integrate_wheels(MotionRecord& record) {
  std::optional<WheelSample> newest;
  while (!wheel_queue_.empty() && wheel_queue_.front().utime <= record.end) {
    newest = wheel_queue_.front();
    wheel_queue_.pop_front();
  }
  Utime gap = 0;
  if (newest && last_wheels_) {
    gap = newest->utime - last_wheels_->utime;
    double fastest = 0.0;
    for (size_t i = 0; i < 6; ++i) {
      record.wheel_turn_rad[i] = newest->drive_angle_rad[i] - last_wheels_->drive_angle_rad[i];
      fastest = std::max(fastest, std::abs(record.wheel_turn_rad[i]) / to_seconds(gap));
    }
    record.wheels_valid = (gap <= kEncoderGapUs || encoders_from_checkpoint_) && fastest < kMaxWheelRateRadps;
  }
  if (newest) {
    last_wheels_ = newest;
    encoders_from_checkpoint_ = false;
  }
  if (record.wheels_valid) {
    record.steer_rad = last_wheels_->steer_angle_rad;
    record.wheel_motion = wheels_.body_motion(record.wheel_turn_rad, record.steer_rad);
    // The visual velocity has bridged the gap until this record.
    if (wheels_bridged_) record.wheel_motion.head<2>() *= std::min(1.0, record.dt_s() / to_seconds(gap));
    wheels_bridged_ = false;
    return;
  }
  record.wheel_turn_rad = {};
  const bool silent = to_seconds(record.end - newest_wheels_utime_) > config_.status.wheel_timeout_s;
  const bool recent_vo = newest_visual_utime_ != kNever &&
                         to_seconds(record.end - newest_visual_utime_) < config_.status.no_odometry_lost_s;
  if (!silent || !recent_vo) return;
  record.wheel_motion.head<2>() = visual_velocity_mps_.head<2>() * record.dt_s();
  wheels_bridged_ = !encoders_from_checkpoint_;  // a new process knows no visual velocity
}

void Localization::integrate_command(MotionRecord& record) const {
  if (!command_ || command_->valid_until_utime < record.end) return;
  std::array<double, 6> turned{};
  for (size_t i = 0; i < 6; ++i) turned[i] = command_->drive_rate_radps[i] * record.dt_s();
  record.commanded_path_m = wheels_.path_m(turned);
}

void Localization::detect_stationary(MotionRecord& record) {
  if (!record.wheels_valid || !record.gyro_valid) return;
  for (size_t i = 0; i < 6; ++i) turned_since_stop_rad_[i] += record.wheel_turn_rad[i];
  bool moved = std::any_of(turned_since_stop_rad_.begin(), turned_since_stop_rad_.end(),
                           [](double turned) { return std::abs(turned) > kWheelMotionRad; });
  // Steering on the spot rotates the body more slowly than the gyro threshold.
  for (size_t i = 0; i < steer_at_stop_rad_.size(); ++i)
    moved = moved || std::abs(wrap_angle(record.steer_rad[i] - steer_at_stop_rad_[i])) > kWheelMotionRad;
  const Eigen::Vector3d rate = record.delta_angle_rad / record.dt_s() - predicted_.gyro_bias_radps;
  if (moved || rate.norm() > config_.stationary.rate_radps) {
    turned_since_stop_rad_ = {};
    steer_at_stop_rad_ = record.steer_rad;
    stationary_s_ = settled_s_ = 0.0;
    return;
  }
  stationary_s_ += record.dt_s();
  const bool rotating = record.fog_valid && std::abs(rate.z()) > config_.stationary.settled_rate_radps;
  settled_s_ = rotating ? 0.0 : settled_s_ + record.dt_s();
  record.stationary = stationary_s_ >= config_.stationary.after_s;
  record.settled = record.stationary && settled_s_ >= config_.stationary.settled_after_s;
}

void Localization::initialise(const MotionRecord& record) {
  if (config_.camera_only.enabled) {
    const Eigen::Matrix3d R = rotation_from_rpy(config_.camera_only.roll_rad, config_.camera_only.pitch_rad, 0.0);
    predicted_ = fused_ = filter_.initial_state(record.end, R, Eigen::Vector3d::Zero());
    initialised_utime_ = record.end;
    initialised_ = true;
    return;
  }
  const auto alignment = static_alignment_.add(record);
  if (!alignment) return;
  filter_.set_gravity(alignment->gravity_mps2);
  predicted_ = fused_ = filter_.initial_state(record.end, alignment->R_odom_body, alignment->gyro_bias_radps);
  initialised_utime_ = record.end;
  initialised_ = true;
}

void Localization::predict(const MotionRecord& record) {
  predicted_ = filter_.propagate(predicted_, without_suspect_gyro(record), ground_motion(record));
  // Without visual motions it would fall out of the history, and what the wheels measured since with it.
  const Utime oldest = record.end - to_utime(config_.history_s) + to_utime(kHistoryMarginS);
  if (fused_.utime < oldest - to_utime(kHistoryMarginS) / 2) fused_ = propagate_to(fused_, oldest);
}

// A velocity that bridges missing encoders contains the slip.
Eigen::Vector2d Localization::ground_motion(const MotionRecord& record) const {
  const Eigen::Vector2d rolled = record.wheel_motion.head<2>();
  if (!record.wheels_valid) return rolled;
  return slip_.traction(record.end) * rolled + Eigen::Vector2d(0.0, slip_.side_slip(record.end) * rolled.norm());
}

MotionRecord Localization::without_suspect_gyro(const MotionRecord& record) const {
  return gyro_suspect() ? without_gyro(record) : record;
}

FilterState Localization::propagate_to(FilterState state, Utime to) const {
  for (const MotionRecord& record : history_.slice(state.utime, to))
    state = filter_.propagate(state, without_suspect_gyro(record), ground_motion(record));
  return state;
}

// ---- visual update

std::string_view Localization::fuse_visual_motion(const VisualMotion& motion) {
  if (motion.previous_utime < fused_.utime) return "begins before the newest motion used";
  if (!history_.covers(motion.previous_utime, motion.utime)) return "of a time that is forgotten or to come";
  if (!chain_.is_continued_by(motion)) chain_.restart(propagate_to(fused_, motion.previous_utime), motion);
  VisualChain extended = chain_;
  extended.extend(motion);
  const auto fused = fuse_chain(extended);
  if (!fused) return "contradicts the gyro";
  chain_ = extended;
  const auto records = history_.slice(motion.previous_utime, motion.utime);
  const Eigen::Isometry3d on_ground =
      Eigen::Translation3d(-ground_m_) * motion.T_prev_cur * Eigen::Translation3d(ground_m_);
  slip_.add_visual(records, planar_motion(on_ground));
  visual_velocity_mps_ = on_ground.translation() / to_seconds(motion.utime - motion.previous_utime);
  newest_visual_utime_ = motion.utime;
  apply_fused_state(*fused);
  return {};
}

std::optional<FilterState> Localization::fuse_chain(const VisualChain& chain) {
  auto records = history_.slice(chain.anchor().utime, chain.interval().to);
  auto fused = filter_.fuse_visual(chain.anchor(), records, chain.interval());
  const double span_s = to_seconds(chain.interval().to - chain.interval().from);
  if (!fused) {
    ++gyro_conflicts_;
    ++consecutive_conflicts_;
    conflict_span_s_ = consecutive_conflicts_ == 1 ? span_s : std::min(conflict_span_s_, span_s);
  } else if (span_s >= conflict_span_s_) {  // a shorter motion shows less of a wrong rate
    consecutive_conflicts_ = 0;
    conflict_span_s_ = 0.0;
  }
  if (!gyro_suspect()) return fused;
  // One bad image gives one conflict; repeated conflicts mean that the gyro is wrong.
  for (MotionRecord& record : records) record = without_gyro(record);
  return filter_.fuse_visual(chain.anchor(), records, chain.interval());
}

void Localization::apply_fused_state(const FilterState& fused) {
  fused_ = fused;
  const Eigen::Isometry3d before = predicted_.T_odom_body;
  predicted_ = propagate_to(fused_, history_.end());
  smoothing_offset_m_ += before.translation() - predicted_.T_odom_body.translation();
  const Eigen::Matrix3d R_out = exp_so3(smoothing_offset_rad_) * before.linear();
  smoothing_offset_rad_ = log_so3(R_out * predicted_.T_odom_body.linear().transpose());
}

// ---- output

void Localization::update_pose(const MotionRecord& record) {
  const double fade = std::exp(-record.dt_s() / config_.smoothing_s);
  smoothing_offset_m_ *= fade;
  smoothing_offset_rad_ *= fade;
  const Eigen::Isometry3d T = make_pose(exp_so3(smoothing_offset_rad_) * predicted_.T_odom_body.linear(),
                                        predicted_.T_odom_body.translation() + smoothing_offset_m_);
  map_.step(record.dt_s(), T);
  const double chord = (T.translation() - last_chord_end_m_).norm();
  if (chord > kChordM) {
    travelled_m_ += chord;
    last_chord_end_m_ = T.translation();
  }
  pose_.utime = record.end;
  pose_.T_odom_body = T;
  pose_.T_map_odom = map_.known() ? map_.T_map_odom() : nan_pose();
  pose_.cov = cov_map();
  pose_.velocity_body_mps << ground_motion(record) / record.dt_s(), 0.0;
  pose_.rate_body_radps.setZero();
  if (record.stationary)
    pose_.velocity_body_mps.setZero();
  else if (without_suspect_gyro(record).gyro_valid)
    pose_.rate_body_radps = record.delta_angle_rad / record.dt_s() - predicted_.gyro_bias_radps;
  else
    pose_.rate_body_radps.z() = record.wheel_motion.z() / record.dt_s();
  pose_.travelled_m = travelled_m_;
  pose_.last_vo_utime = newest_visual_utime_;
  poses_.push_back({record.end, T});
  while (poses_.front().utime < record.end - to_utime(config_.history_s)) poses_.pop_front();
}

Matrix6d Localization::cov_map() const {
  if (!map_.known()) return nan_cov();
  Matrix6d B = Matrix6d::Zero();
  B.topLeftCorner<3, 3>() = B.bottomRightCorner<3, 3>() = map_.T_map_odom().linear();
  return B * predicted_.P.topLeftCorner<6, 6>() * B.transpose();
}

void Localization::update_status(Utime now) {
  const auto set = [this](PoseStatus status, std::string_view reason) {
    pose_.status = status;
    pose_.reason = reason;
  };
  if (!initialised_) return set(PoseStatus::kUninitialised, "not level yet");
  if (!map_.known()) return set(PoseStatus::kUninitialised, "no start pose yet");
  const double visual_age = to_seconds(now - std::max(newest_visual_utime_, initialised_utime_));
  const double wheels_age = to_seconds(now - newest_wheels_utime_);
  if (config_.camera_only.enabled) {
    if (visual_age > config_.status.no_odometry_lost_s) return set(PoseStatus::kLost, "no visual odometry");
    if (predicted_.dead_reckoned_m > config_.status.max_dead_reckoned_m)
      return set(PoseStatus::kLost, "too far on wheels alone");
    return set(PoseStatus::kOk, {});
  }
  const bool imu_healthy = imu_monitor_.healthy(now);
  if (imu_healthy) imu_healthy_utime_ = now;
  if (to_seconds(now - imu_healthy_utime_) > config_.status.imu_lost_s)
    return set(PoseStatus::kLost, "no IMU for too long");
  if (predicted_.dead_reckoned_m > config_.status.max_dead_reckoned_m)
    return set(PoseStatus::kLost, "too far on wheels alone");
  if (wheels_age > config_.status.wheel_timeout_s && visual_age > config_.status.no_odometry_lost_s)
    return set(PoseStatus::kLost, "neither wheels nor visual odometry");
  if (!imu_healthy) return set(PoseStatus::kDegraded, imu_monitor_.frozen() ? "IMU frozen" : "no IMU");
  if (gyro_suspect()) return set(PoseStatus::kDegraded, "gyro contradicts visual odometry");
  if (wheels_age > config_.status.wheel_timeout_s) return set(PoseStatus::kDegraded, "no wheels");
  if (visual_age > config_.status.visual_degraded_s) return set(PoseStatus::kDegraded, "no visual odometry");
  set(PoseStatus::kOk, {});
}

std::optional<Eigen::Isometry3d> Localization::pose_at(Utime utime) const {
  if (poses_.empty() || utime < poses_.front().utime || utime > poses_.back().utime) return std::nullopt;
  const auto after =
      std::lower_bound(poses_.begin(), poses_.end(), utime, [](const StampedPose& p, Utime t) { return p.utime < t; });
  if (after->utime == utime) return after->T_odom_body;
  const auto before = std::prev(after);
  if (after->utime - before->utime > kPoseGapUs) return std::nullopt;
  const double u = static_cast<double>(utime - before->utime) / static_cast<double>(after->utime - before->utime);
  return interpolate(before->T_odom_body, after->T_odom_body, u);
}

// ---- checkpoint

std::optional<Checkpoint> Localization::checkpoint() const {
  if (!initialised_ || pose_.utime == kNever) return std::nullopt;
  Checkpoint c;
  c.utime = last_record_end_;
  c.T_odom_body = predicted_.T_odom_body;
  c.map_known = map_.known();
  c.T_map_odom = map_.T_map_odom();
  c.gyro_bias_radps = predicted_.gyro_bias_radps;
  c.P = predicted_.P;
  c.gravity_mps2 = filter_.gravity();
  c.travelled_m = travelled_m_;
  c.newest_visual_utime = newest_visual_utime_;
  c.drive_angle_rad.fill(kNaN);
  if (last_wheels_) c.drive_angle_rad = last_wheels_->drive_angle_rad;
  c.traction = slip_.newest_traction();
  c.mean_traction = slip_.mean_traction();
  c.side_slip = slip_.newest_side_slip();
  c.smoothing_offset_m = smoothing_offset_m_;
  c.smoothing_offset_rad = smoothing_offset_rad_;
  c.consecutive_conflicts = consecutive_conflicts_;
  c.conflict_span_s = conflict_span_s_;
  c.imu_healthy_utime = std::min(imu_healthy_utime_, c.utime);
  c.dead_reckoned_m = predicted_.dead_reckoned_m;
  return c;
}

void Localization::restore(const Checkpoint& c) {
  filter_.set_gravity(c.gravity_mps2);
  fused_.utime = c.utime;
  fused_.T_odom_body = c.T_odom_body;
  fused_.gyro_bias_radps = c.gyro_bias_radps;
  fused_.P = c.P;
  fused_.dead_reckoned_m = c.dead_reckoned_m;
  predicted_ = fused_;
  if (c.map_known) map_.restore(c.T_map_odom);
  travelled_m_ = c.travelled_m;
  newest_visual_utime_ = c.newest_visual_utime;  // a restart alone must not make visual odometry look stale
  smoothing_offset_m_ = c.smoothing_offset_m;
  smoothing_offset_rad_ = c.smoothing_offset_rad;
  last_chord_end_m_ = c.T_odom_body.translation() + c.smoothing_offset_m;
  last_record_end_ = initialised_utime_ = newest_wheels_utime_ = c.utime;
  slip_.restore(c.traction, c.mean_traction, c.side_slip, c.newest_visual_utime);
  consecutive_conflicts_ = c.consecutive_conflicts;
  conflict_span_s_ = c.conflict_span_s;
  imu_healthy_utime_ = c.imu_healthy_utime;
  initialised_ = true;
  if (!std::isfinite(c.drive_angle_rad[0])) return;
  last_wheels_ = WheelSample{};
  last_wheels_->utime = c.utime;
  last_wheels_->drive_angle_rad = c.drive_angle_rad;
  encoders_from_checkpoint_ = true;
}

}  // namespace rover::loc
