#include "visual_odometry/odometry.hpp"

#include <algorithm>
#include <vector>

namespace rover::vo {

struct Odometry::StereoPyramid {
  ImagePyramid left;
  ImagePyramid right;
};

struct Odometry::Registration {
  MotionEstimate motion;
  int tracked = 0;
};

namespace {

bool same_camera(const StereoCamera& a, const StereoCamera& b) {
  return a.width == b.width && a.height == b.height && a.focal_px == b.focal_px && a.cx_px == b.cx_px &&
         a.cy_px == b.cy_px && a.baseline_m == b.baseline_m && a.T_body_cam.isApprox(b.T_body_cam, 1e-12);
}

std::vector<Observation> observations_of(const Keyframe& key, const std::vector<Track>& tracks) {
  std::vector<Observation> observations;
  for (size_t i = 0; i < tracks.size(); ++i)
    if (tracks[i].left) {
      Eigen::Vector3d z = tracks[i].z;
      z.z() -= key.correction.px(key.camera, z.x(), z.y());
      observations.push_back({key.points[i].p_key, key.points[i].disparity_px, z, tracks[i].right});
    }
  return observations;
}

double position_sigma(const Matrix6d& cov) {
  return std::sqrt(cov.topLeftCorner<3, 3>().trace());
}

// Adjoint of SE(3) for (translation, rotation): maps small motions of frame b into frame a.
Matrix6d adjoint(const Eigen::Isometry3d& T_a_b) {
  Matrix6d Ad = Matrix6d::Zero();
  Ad.topLeftCorner<3, 3>() = T_a_b.linear();
  Ad.bottomRightCorner<3, 3>() = T_a_b.linear();
  Ad.topRightCorner<3, 3>() = skew(T_a_b.translation()) * T_a_b.linear();
  return Ad;
}

Matrix6d rotated(const Matrix6d& cov, const Eigen::Matrix3d& R) {
  Matrix6d B = Matrix6d::Zero();
  B.topLeftCorner<3, 3>() = R;
  B.bottomRightCorner<3, 3>() = R;
  return B * cov * B.transpose();
}

}  // namespace

Odometry::Odometry(const OdometryConfig& config)
    : config_(config), offset_(config.disparity_offset), epipolar_(config.disparity_offset) {}

std::optional<OdometryResult> Odometry::step(const StereoFrame& frame) {
  ROVER_CHECK(frame.utime > newest_utime_, frame.utime, newest_utime_);
  newest_utime_ = frame.utime;
  const StereoPyramid pyramids{build_pyramid(frame.left, config_.pyramid_levels),
                               build_pyramid(frame.right, config_.pyramid_levels)};
  if (!keyframe_) {
    if (start_keyframe(frame, pyramids)) return std::nullopt;
    return lost(frame, {});
  }
  const Registration registration =
      same_camera(keyframe_->camera, frame.camera) ? register_with_keyframe(frame, pyramids) : Registration{};
  if (!is_valid(registration)) {
    const OdometryResult result = lost(frame, registration);
    if (++consecutive_lost_ >= config_.lost_until_new_keyframe) start_keyframe(frame, pyramids);
    return result;
  }
  OdometryResult result = accept(frame, registration);
  const int needed_inliers =
      std::max(config_.keyframe_inliers,
               static_cast<int>(config_.keyframe_inlier_ratio * static_cast<double>(keyframe_->points.size())));
  const double applied_offset_px = keyframe_->correction.yaw_px;
  if (registration.motion.inliers < needed_inliers && start_keyframe(frame, pyramids))
    offset_.add(registration.motion.offset, applied_offset_px);
  if (offset_.displaced()) {
    result.status = Status::kDisplaced;
    result.T_prev_cur = nan_pose();
    result.cov = nan_cov();
  }
  return result;
}

bool Odometry::start_keyframe(const StereoFrame& frame, const StereoPyramid& pyramids) {
  Keyframe key = make_keyframe(pyramids.left, pyramids.right, frame.disparity ? &*frame.disparity : nullptr,
                               frame.camera, config_.corners, config_.stereo, correction());
  if (static_cast<int>(key.points.size()) < config_.min_keyframe_points) return false;
  keyframe_ = std::move(key);
  std::vector<RowOffset> rows;
  for (const KeyPoint& point : keyframe_->points)
    rows.push_back({image_position(frame.camera, point.pixel.x(), point.pixel.y()), point.row_offset_px});
  epipolar_.add(rows);
  keyframe_utime_ = frame.utime;
  T_key_prev_ = Eigen::Isometry3d::Identity();
  if (previous_utime_ != frame.utime) {
    last_motion_ = Eigen::Isometry3d::Identity();
    last_motion_s_ = 0.0;
  }
  previous_utime_ = frame.utime;
  consecutive_lost_ = 0;
  return true;
}

Odometry::Registration Odometry::register_with_keyframe(const StereoFrame& frame, const StereoPyramid& pyramids) const {
  const double ratio = last_motion_s_ > 0.0 ? to_seconds(frame.utime - previous_utime_) / last_motion_s_ : 0.0;
  const Eigen::Isometry3d constant_velocity =
      make_pose(exp_so3(ratio * log_so3(last_motion_.linear())), ratio * last_motion_.translation());
  struct Guess {
    Eigen::Isometry3d T_prev_cur;
    bool search;
  };
  std::vector<Guess> guesses;
  if (frame.R_prev_cur) guesses.push_back({make_pose(*frame.R_prev_cur, constant_velocity.translation()), false});
  guesses.push_back({constant_velocity, false});
  guesses.push_back({Eigen::Isometry3d::Identity(), true});
  Registration best;
  for (const Guess& guess : guesses) {
    Registration candidate = register_from_guess(frame, pyramids, guess.T_prev_cur, guess.search);
    if (candidate.motion.inliers > best.motion.inliers) best = std::move(candidate);
    if (is_valid(best) && best.motion.inliers >= config_.ok_inliers) break;
  }
  return best;
}

Odometry::Registration Odometry::register_from_guess(const StereoFrame& frame, const StereoPyramid& pyramids,
                                                     const Eigen::Isometry3d& T_prev_cur_body, bool search) const {
  const Eigen::Isometry3d& T_body_cam = frame.camera.T_body_cam;
  const Eigen::Isometry3d T_prev_cur = T_body_cam.inverse() * T_prev_cur_body * T_body_cam;
  const Eigen::Isometry3d T_guess = (T_key_prev_ * T_prev_cur).inverse();
  const auto coarse =
      observations_of(*keyframe_, track_coarse(*keyframe_, pyramids.left, T_guess, config_.tracker, search));
  if (static_cast<int>(coarse.size()) < config_.min_inliers) return {};
  const std::uint64_t seed = config_.seed ^ static_cast<std::uint64_t>(frame.utime);
  const RansacResult start = ransac(coarse, keyframe_->camera, T_guess, config_.motion, seed);
  if (start.inliers < config_.min_inliers) return {};
  const auto fine = observations_of(
      *keyframe_, track_fine(*keyframe_, pyramids.left, pyramids.right, start.T_cur_key, config_.tracker));
  if (static_cast<int>(fine.size()) < config_.min_inliers) return {};
  return {refine(fine, keyframe_->camera, start.T_cur_key, config_.motion), static_cast<int>(fine.size())};
}

bool Odometry::is_valid(const Registration& registration) const {
  const MotionEstimate& motion = registration.motion;
  return motion.inliers >= config_.min_inliers && is_finite(motion.T_cur_key) && motion.cov.allFinite() &&
         position_sigma(motion.cov) < config_.max_position_sigma_m;
}

OdometryResult Odometry::accept(const StereoFrame& frame, const Registration& registration) {
  const Eigen::Isometry3d T_key_cur = registration.motion.T_cur_key.inverse();
  const Eigen::Isometry3d& T_body_cam = frame.camera.T_body_cam;
  OdometryResult result;
  result.previous_utime = previous_utime_;
  result.utime = frame.utime;
  result.keyframe_utime = keyframe_utime_;
  result.T_prev_cur = T_body_cam * T_key_prev_.inverse() * T_key_cur * T_body_cam.inverse();
  // From current camera axes (left perturbation of T_cur_key) to current, then previous body axes.
  const Matrix6d Ad = adjoint(T_body_cam);
  result.cov = rotated(Ad * registration.motion.cov * Ad.transpose(), result.T_prev_cur.linear());
  result.features = registration.tracked;
  result.inliers = registration.motion.inliers;
  result.rms_px = registration.motion.rms_px;
  result.status = classify(frame, result);
  T_key_prev_ = T_key_cur;
  last_motion_ = result.T_prev_cur;
  last_motion_s_ = to_seconds(frame.utime - previous_utime_);
  previous_utime_ = frame.utime;
  consecutive_lost_ = 0;
  return result;
}

Status Odometry::classify(const StereoFrame& frame, const OdometryResult& result) const {
  if (result.inliers < config_.ok_inliers || result.inliers < config_.ok_inlier_ratio * result.features)
    return Status::kDegraded;
  if (!frame.R_prev_cur) return Status::kOk;
  const double gyro_difference = log_so3(frame.R_prev_cur->transpose() * result.T_prev_cur.linear()).norm();
  return gyro_difference > config_.gyro_tolerance_rad ? Status::kDegraded : Status::kOk;
}

OdometryResult Odometry::lost(const StereoFrame& frame, const Registration& registration) const {
  OdometryResult result;
  if (offset_.displaced()) result.status = Status::kDisplaced;
  result.previous_utime = previous_utime_ == kNever ? frame.utime : previous_utime_;
  result.utime = frame.utime;
  result.keyframe_utime = keyframe_utime_;
  result.features = registration.tracked;
  result.inliers = registration.motion.inliers;
  return result;
}

}  // namespace rover::vo
