#include "localization/localization.hpp"

#include <algorithm>
#include <cmath>

namespace rover::loc {
namespace {

constexpr Utime kFutureUs = 1'000'000;    // messages later than this after the newest tick are nonsense
constexpr Utime kEncoderGapUs = 500'000;  // after a longer silence the wheels' way is not known
constexpr double kMinCover = 0.5;         // of a record's time; what is missing is taken to go on alike
constexpr double kStillRad = 0.01;        // a wheel that turned less stands: above encoder noise
constexpr double kVertexM = 0.05;         // the driven track is measured in chords of this length

Eigen::Vector3d planar_motion(const Eigen::Isometry3d& T) {
  return {T.translation().x(), T.translation().y(), yaw_of(T)};
}

MotionRecord without_gyro(MotionRecord record) {
  record.gyro = false;
  record.standing = record.at_rest = false;
  return record;
}

}  // namespace

Localization::Localization(const LocalizationConfig& config, const Vehicle& vehicle)
    : config_(config),
      wheels_(vehicle),
      filter_(config.filter),
      imu_monitor_(config.imu),
      levelling_(config.levelling),
      map_(config.map),
      slip_(config.slip, wheels_),
      history_(to_utime(config.history_s)),
      chain_(config.chain_s) {}

// ---- inputs

std::string_view Localization::take_imu(const ImuSample& sample) {
  if (!sample.healthy) return {};  // silence, which the monitor sees
  if (const auto flaw = flaw_of(sample); !flaw.empty()) return flaw;
  if (sample.utime <= imu_newest_) return "not newer than the one before";
  if (is_future(sample.utime)) return "from the future";
  imu_newest_ = sample.utime;
  if (imu_monitor_.take(sample)) imu_waiting_.push_back(sample);
  return {};
}

std::string_view Localization::take_wheels(const WheelSample& sample) {
  if (!sample.healthy) return {};
  if (const auto flaw = flaw_of(sample); !flaw.empty()) return flaw;
  if (sample.utime <= wheels_newest_) return "not newer than the one before";
  if (is_future(sample.utime)) return "from the future";
  wheels_newest_ = sample.utime;
  wheels_waiting_.push_back(sample);
  return {};
}

std::string_view Localization::take_wheel_command(const WheelCommand& command) {
  if (const auto flaw = flaw_of(command); !flaw.empty()) return flaw;
  command_ = command;
  return {};
}

std::string_view Localization::take_visual(const VisualMotion& motion) {
  if (const auto flaw = flaw_of(motion, config_.max_speed_mps); !flaw.empty()) return flaw;
  if (motion.status == VisualStatus::kLost || !initialised_) return {};
  return use_visual(motion);
}

std::string_view Localization::take_start_pose(const StartPose& start) {
  if (const auto flaw = flaw_of(start); !flaw.empty()) return flaw;
  if (!initialised_) return "not level yet: the rover has to stand, with IMU and wheels alive";
  map_.set_start(start, tip_.T_odom_body);
  start_covariance(start);
  return {};
}

std::string_view Localization::take_correction(const MapMeasurement& measurement) {
  if (const auto flaw = flaw_of(measurement); !flaw.empty()) return flaw;
  const auto T_odom_body = pose_at(measurement.utime);
  if (!T_odom_body) return "of a time that is forgotten or to come";
  // global_localization looks further than the pose's own covariance goes, which is optimistic after long drives.
  const bool surprised = map_.known() && !map_.consistent(measurement, *T_odom_body, tip_.P);
  const auto refusal = map_.take_correction(measurement, *T_odom_body, surprised ? map_.widened(tip_.P) : tip_.P);
  if (!refusal.empty()) return refusal;
  for (ErrorCov* P : {&latest_.P, &tip_.P, &chain_.anchor().P})
    *P = map_.updated(surprised ? map_.widened(*P) : *P, measurement.cov);
  return {};
}

std::string_view Localization::take_slam(const MapMeasurement& measurement) {
  if (const auto flaw = flaw_of(measurement); !flaw.empty()) return flaw;
  const auto T_odom_body = pose_at(measurement.utime);
  if (!T_odom_body) return "of a time that is forgotten or to come";
  return map_.take_slam(measurement, *T_odom_body, tip_.P);
}

void Localization::start_covariance(const StartPose& start) {
  for (FilterState* state : {&latest_, &tip_}) {
    for (const int i : {kPosition, kPosition + 1, kPosition + 2, kAttitude + 2}) {
      state->P.row(i).setZero();
      state->P.col(i).setZero();
      const double sigma = i == kAttitude + 2 ? start.sigma_yaw_rad : start.sigma_m;
      state->P(i, i) = sigma * sigma;
    }
  }
  // The joined motions would bring the old covariance back.
  chain_.clear();
}

// ---- the tick

// Against the tick's time, not the pose's: after a step of the clock the pose is old, and the samples are not to blame.
bool Localization::is_future(Utime utime) const {
  return stepped_ != kNever && utime > stepped_ + kFutureUs;
}

void Localization::step(Utime now) {
  stepped_ = now;
  if (const auto record = next_record(now)) {
    history_.add(*record);
    slip_.add(*record);
    if (!initialised_)
      initialise(*record);
    else
      carry_on(*record);
    if (initialised_) publish_pose(*record);
  }
  judge(now);
}

std::optional<MotionRecord> Localization::next_record(Utime now) {
  Utime end = record_end_ == kNever ? (config_.cameras_alone.enabled ? now : kNever) : record_end_ + kTickUs;
  bool measured = false;
  for (const ImuSample& s : imu_waiting_)
    if (s.utime <= now) end = measured ? std::max(end, s.utime) : s.utime, measured = true;
  for (const WheelSample& s : wheels_waiting_)
    if (s.utime <= now) end = measured ? std::max(end, s.utime) : s.utime, measured = true;
  if (end == kNever || end > now || end <= record_end_) return std::nullopt;
  MotionRecord record;
  record.start = record_end_ == kNever ? end - kTickUs : record_end_;
  record.end = end;
  gather_imu(record);
  gather_wheels(record);
  gather_command(record);
  judge_standing(record);
  record_end_ = end;
  return record;
}

void Localization::gather_imu(MotionRecord& record) {
  double covered_s = 0.0;
  record.fog = true;
  while (!imu_waiting_.empty() && imu_waiting_.front().utime <= record.end) {
    const ImuSample& s = imu_waiting_.front();
    if (s.utime > record.start) {
      covered_s += s.dt_s;
      Eigen::Vector3d turned = s.delta_angle_rad;
      if (std::isfinite(s.fog_delta_yaw_rad))
        turned.z() = s.fog_delta_yaw_rad;
      else
        record.fog = false;
      record.delta_angle_rad += turned;
      record.delta_velocity_mps += s.delta_velocity_mps;
    }
    imu_waiting_.pop_front();
  }
  if (covered_s < kMinCover * record.dt_s()) return;
  record.gyro = record.force = true;
  record.delta_angle_rad *= record.dt_s() / covered_s;
  record.delta_velocity_mps *= record.dt_s() / covered_s;
}

void Localization::gather_wheels(MotionRecord& record) {
  std::optional<WheelSample> newest;
  while (!wheels_waiting_.empty() && wheels_waiting_.front().utime <= record.end) {
    newest = wheels_waiting_.front();
    wheels_waiting_.pop_front();
  }
  if (newest && last_wheels_) {
    const Utime gap = newest->utime - last_wheels_->utime;
    double fastest = 0.0;
    for (size_t i = 0; i < 6; ++i) {
      record.turned_rad[i] = newest->drive_angle_rad[i] - last_wheels_->drive_angle_rad[i];
      fastest = std::max(fastest, std::abs(record.turned_rad[i]) / to_seconds(gap));
    }
    record.wheels = (gap <= kEncoderGapUs || encoders_from_checkpoint_) && fastest < kMaxWheelRateRadps;
  }
  if (newest) {
    last_wheels_ = newest;
    encoders_from_checkpoint_ = false;
  }
  if (record.wheels) {
    record.steer_rad = last_wheels_->steer_angle_rad;
    record.wheel_motion = wheels_.motion(record.turned_rad, record.steer_rad);
    return;
  }
  record.turned_rad = {};
  const bool silent = to_seconds(record.end - wheels_newest_) > config_.wheel_silence_s;
  const bool seen = visual_newest_ != kNever && to_seconds(record.end - visual_newest_) < config_.nothing_lost_s;
  if (silent && seen) record.wheel_motion.head<2>() = visual_velocity_mps_.head<2>() * record.dt_s();
}

void Localization::gather_command(MotionRecord& record) const {
  if (!command_ || command_->valid_until_utime < record.end) return;
  std::array<double, 6> turned{};
  for (size_t i = 0; i < 6; ++i) turned[i] = command_->drive_rate_radps[i] * record.dt_s();
  record.commanded_path_m = wheels_.path_m(turned);
}

void Localization::judge_standing(MotionRecord& record) {
  if (!record.wheels || !record.gyro) return;
  for (size_t i = 0; i < 6; ++i) still_turned_rad_[i] += record.turned_rad[i];
  bool moved = std::any_of(still_turned_rad_.begin(), still_turned_rad_.end(),
                           [](double turned) { return std::abs(turned) > kStillRad; });
  // Wheels that steer on the spot turn the body a little, slower than the gyro's threshold.
  for (size_t i = 0; i < still_steer_rad_.size(); ++i)
    moved = moved || std::abs(wrap_angle(record.steer_rad[i] - still_steer_rad_[i])) > kStillRad;
  const Eigen::Vector3d rate = record.delta_angle_rad / record.dt_s() - tip_.gyro_bias_radps;
  if (moved || rate.norm() > config_.standing_rate_radps) {
    still_turned_rad_ = {};
    still_steer_rad_ = record.steer_rad;
    still_s_ = rest_s_ = 0.0;
    return;
  }
  still_s_ += record.dt_s();
  const bool turning = record.fog && std::abs(rate.z()) > config_.rest_rate_radps;
  rest_s_ = turning ? 0.0 : rest_s_ + record.dt_s();
  record.standing = still_s_ >= config_.standing_s;
  record.at_rest = record.standing && rest_s_ >= config_.at_rest_s;
}

void Localization::initialise(const MotionRecord& record) {
  if (config_.cameras_alone.enabled) {
    const Eigen::Matrix3d R = rotation_from_rpy(config_.cameras_alone.roll_rad, config_.cameras_alone.pitch_rad, 0.0);
    tip_ = latest_ = filter_.start(record.end, R, Eigen::Vector3d::Zero());
    initialised_utime_ = record.end;
    initialised_ = true;
    return;
  }
  const auto level = levelling_.add(record);
  if (!level) return;
  filter_.set_gravity(level->gravity_mps2);
  tip_ = latest_ = filter_.start(record.end, level->R_odom_body, level->gyro_bias_radps);
  initialised_utime_ = record.end;
  initialised_ = true;
}

void Localization::carry_on(const MotionRecord& record) {
  tip_ = filter_.advance(tip_, usable(record), grip(record));
  blind_m_ += grip(record) * record.wheel_motion.head<2>().norm();
}

double Localization::grip(const MotionRecord& record) const {
  return record.wheels ? slip_.grip() : 1.0;
}

MotionRecord Localization::usable(const MotionRecord& record) const {
  return gyro_suspect() ? without_gyro(record) : record;
}

FilterState Localization::carried(FilterState state, Utime to) const {
  for (const MotionRecord& record : history_.slice(state.utime, to))
    state = filter_.advance(state, usable(record), grip(record));
  return state;
}

// ---- visual odometry

std::string_view Localization::use_visual(const VisualMotion& motion) {
  if (motion.previous_utime < latest_.utime) return "begins before the newest motion used";
  if (!history_.covers(motion.previous_utime, motion.utime)) return "of a time that is forgotten or to come";
  if (!chain_.continues(motion)) chain_.restart(carried(latest_, motion.previous_utime), motion);
  VisualChain longer = chain_;
  longer.extend(motion);
  const auto fused = fuse(longer);
  if (!fused) return "contradicts the gyro";
  chain_ = longer;
  const auto records = history_.slice(motion.previous_utime, motion.utime);
  slip_.add_visual(records, planar_motion(motion.T_prev_cur));
  visual_velocity_mps_ = motion.T_prev_cur.translation() / to_seconds(motion.utime - motion.previous_utime);
  visual_newest_ = motion.utime;
  adopt(*fused);
  return {};
}

std::optional<FilterState> Localization::fuse(const VisualChain& chain) {
  auto records = history_.slice(chain.anchor().utime, chain.interval().to);
  if (auto fused = filter_.fuse_visual(chain.anchor(), records, chain.interval())) {
    conflicts_in_a_row_ = 0;
    return fused;
  }
  ++conflicts_;
  ++conflicts_in_a_row_;
  if (!gyro_suspect()) return std::nullopt;
  // Images disagree with the gyro again and again: one odd picture does not, so it is the gyro.
  for (MotionRecord& record : records) record = without_gyro(record);
  return filter_.fuse_visual(chain.anchor(), records, chain.interval());
}

void Localization::adopt(const FilterState& fused) {
  latest_ = fused;
  const Eigen::Isometry3d before = tip_.T_odom_body;
  tip_ = carried(latest_, history_.end());
  blind_m_ = 0.0;
  for (const MotionRecord& r : history_.slice(latest_.utime, history_.end()))
    blind_m_ += grip(r) * r.wheel_motion.head<2>().norm();
  offset_m_ += before.translation() - tip_.T_odom_body.translation();
  const Eigen::Matrix3d R_out = exp_so3(offset_rad_) * before.linear();
  offset_rad_ = log_so3(R_out * tip_.T_odom_body.linear().transpose());
}

// ---- output

void Localization::publish_pose(const MotionRecord& record) {
  const double fade = std::exp(-record.dt_s() / config_.smoothing_s);
  offset_m_ *= fade;
  offset_rad_ *= fade;
  const Eigen::Isometry3d T =
      make_pose(exp_so3(offset_rad_) * tip_.T_odom_body.linear(), tip_.T_odom_body.translation() + offset_m_);
  map_.step(record.dt_s(), T);
  const double chord = (T.translation() - last_vertex_m_).norm();
  if (chord > kVertexM) {
    travelled_m_ += chord;
    last_vertex_m_ = T.translation();
  }
  pose_.utime = record.end;
  pose_.T_odom_body = T;
  pose_.T_map_odom = map_.known() ? map_.T_map_odom() : nan_pose();
  pose_.cov = cov_map();
  const double g = grip(record) / record.dt_s();
  const double aside_mps = slip_.side_slip() * record.wheel_motion.head<2>().norm() / record.dt_s();
  pose_.velocity_body_mps = {g * record.wheel_motion.x(), g * record.wheel_motion.y() + aside_mps, 0.0};
  pose_.rate_body_radps.setZero();
  if (record.standing)
    pose_.velocity_body_mps.setZero();
  else if (usable(record).gyro)
    pose_.rate_body_radps = record.delta_angle_rad / record.dt_s() - tip_.gyro_bias_radps;
  else
    pose_.rate_body_radps.z() = record.wheel_motion.z() / record.dt_s();
  pose_.travelled_m = travelled_m_;
  pose_.last_vo_utime = visual_newest_;
  past_.push_back({record.end, T});
  while (past_.front().utime < record.end - to_utime(config_.history_s)) past_.pop_front();
}

Matrix6d Localization::cov_map() const {
  if (!map_.known()) return nan_cov();
  Matrix6d B = Matrix6d::Zero();
  B.topLeftCorner<3, 3>() = B.bottomRightCorner<3, 3>() = map_.T_map_odom().linear();
  return B * tip_.P.topLeftCorner<6, 6>() * B.transpose();
}

void Localization::judge(Utime now) {
  const auto set = [this](PoseStatus status, std::string_view reason) {
    pose_.status = status;
    pose_.reason = reason;
  };
  if (!initialised_) return set(PoseStatus::kUninitialised, "not level yet");
  if (!map_.known()) return set(PoseStatus::kUninitialised, "no start pose yet");
  const double visual_age = to_seconds(now - std::max(visual_newest_, initialised_utime_));
  const double wheels_age = to_seconds(now - wheels_newest_);
  if (config_.cameras_alone.enabled) {
    if (visual_age > config_.nothing_lost_s) return set(PoseStatus::kLost, "no visual odometry");
    if (blind_m_ > config_.blind_distance_m) return set(PoseStatus::kLost, "too far without visual odometry");
    return set(PoseStatus::kOk, {});
  }
  const bool imu_alive = imu_monitor_.alive(now);
  if (imu_alive) imu_alive_utime_ = now;
  if (to_seconds(now - imu_alive_utime_) > config_.imu_lost_s) return set(PoseStatus::kLost, "no IMU for too long");
  if (blind_m_ > config_.blind_distance_m) return set(PoseStatus::kLost, "too far without visual odometry");
  if (wheels_age > config_.wheel_silence_s && visual_age > config_.nothing_lost_s)
    return set(PoseStatus::kLost, "neither wheels nor visual odometry");
  if (!imu_alive) return set(PoseStatus::kDegraded, imu_monitor_.frozen() ? "IMU frozen" : "no IMU");
  if (gyro_suspect()) return set(PoseStatus::kDegraded, "gyro contradicts visual odometry");
  if (wheels_age > config_.wheel_silence_s) return set(PoseStatus::kDegraded, "no wheels");
  if (visual_age > config_.visual_degraded_s) return set(PoseStatus::kDegraded, "no visual odometry");
  set(PoseStatus::kOk, {});
}

std::optional<Eigen::Isometry3d> Localization::pose_at(Utime utime) const {
  if (past_.empty() || utime < past_.front().utime || utime > past_.back().utime) return std::nullopt;
  const auto after =
      std::lower_bound(past_.begin(), past_.end(), utime, [](const Past& p, Utime t) { return p.utime < t; });
  if (after->utime == utime) return after->T_odom_body;
  const auto before = std::prev(after);
  const double u = static_cast<double>(utime - before->utime) / static_cast<double>(after->utime - before->utime);
  return interpolate(before->T_odom_body, after->T_odom_body, u);
}

// ---- checkpoint

std::optional<Checkpoint> Localization::checkpoint() const {
  if (!initialised_ || pose_.utime == kNever) return std::nullopt;
  Checkpoint c;
  c.utime = record_end_;
  c.T_odom_body = pose_.T_odom_body;
  c.map_known = map_.known();
  c.T_map_odom = map_.T_map_odom();
  c.gyro_bias_radps = tip_.gyro_bias_radps;
  c.P = tip_.P;
  c.gravity_mps2 = filter_.gravity();
  c.travelled_m = travelled_m_;
  c.visual_newest = visual_newest_;
  c.drive_angle_rad.fill(kNaN);
  if (last_wheels_) c.drive_angle_rad = last_wheels_->drive_angle_rad;
  return c;
}

void Localization::restore(const Checkpoint& c) {
  filter_.set_gravity(c.gravity_mps2);
  latest_.utime = c.utime;
  latest_.T_odom_body = c.T_odom_body;
  latest_.gyro_bias_radps = c.gyro_bias_radps;
  latest_.P = c.P;
  tip_ = latest_;
  if (c.map_known) map_.restore(c.T_map_odom);
  travelled_m_ = c.travelled_m;
  visual_newest_ = c.visual_newest;  // odometry that was fresh is not stale for the want of the process
  last_vertex_m_ = c.T_odom_body.translation();
  record_end_ = initialised_utime_ = imu_alive_utime_ = wheels_newest_ = c.utime;
  initialised_ = true;
  if (!std::isfinite(c.drive_angle_rad[0])) return;
  last_wheels_ = WheelSample{};
  last_wheels_->utime = c.utime;
  last_wheels_->drive_angle_rad = c.drive_angle_rad;
  encoders_from_checkpoint_ = true;
}

}  // namespace rover::loc
