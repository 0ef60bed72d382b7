#include "visual_odometry/odometry.hpp"

#include <algorithm>
#include <vector>

namespace rover::vo {

struct Odometry::Pair {
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

std::vector<Observation> observations_of(const Keyframe& key, const std::vector<Track>& tracks, double offset_px) {
  std::vector<Observation> observations;
  for (size_t i = 0; i < tracks.size(); ++i)
    if (tracks[i].left)
      observations.push_back({key.points[i].p_key, key.points[i].disparity_px,
                              tracks[i].z - Eigen::Vector3d(0.0, 0.0, offset_px), tracks[i].right});
  return observations;
}

double position_sigma(const Matrix6d& cov) {
  return std::sqrt(cov.topLeftCorner<3, 3>().trace());
}

// Covariance of (translation, rotation) under a change of axes: small motions of frame b, seen in frame a.
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

Odometry::Odometry(const OdometryConfig& config) : config_(config), offset_(config.offset) {}

std::optional<OdometryResult> Odometry::step(const StereoFrame& frame) {
  ROVER_CHECK(frame.utime > newest_utime_, frame.utime, newest_utime_);
  newest_utime_ = frame.utime;
  const Pair pair{build_pyramid(frame.left, config_.pyramid_levels),
                  build_pyramid(frame.right, config_.pyramid_levels)};
  if (!key_) {
    if (start_from(frame, pair)) return std::nullopt;
    return lost(frame, {});
  }
  const Registration registration =
      same_camera(key_->camera, frame.camera) ? register_pair(frame, pair) : Registration{};
  if (!trustworthy(registration)) {
    const OdometryResult result = lost(frame, registration);
    if (++lost_in_a_row_ >= config_.lost_until_restart) start_from(frame, pair);
    return result;
  }
  const OdometryResult result = accept(frame, registration);
  const int wanted =
      std::max(config_.keep_inliers, static_cast<int>(config_.keep_share * static_cast<double>(key_->points.size())));
  const double used_px = key_offset_px_;
  if (registration.motion.inliers < wanted && start_from(frame, pair)) offset_.add(registration.motion.offset, used_px);
  return result;
}

bool Odometry::start_from(const StereoFrame& frame, const Pair& pair) {
  Keyframe key = make_keyframe(pair.left, pair.right, frame.disparity ? &*frame.disparity : nullptr, frame.camera,
                               config_.corners, config_.stereo, offset_.px());
  if (static_cast<int>(key.points.size()) < config_.min_keyframe_points) return false;
  key_ = std::move(key);
  key_offset_px_ = offset_.px();
  key_utime_ = frame.utime;
  T_key_prev_ = Eigen::Isometry3d::Identity();
  if (previous_utime_ != frame.utime) {
    last_motion_ = Eigen::Isometry3d::Identity();
    last_motion_s_ = 0.0;
  }
  previous_utime_ = frame.utime;
  lost_in_a_row_ = 0;
  return true;
}

Odometry::Registration Odometry::register_pair(const StereoFrame& frame, const Pair& pair) const {
  const double ratio = last_motion_s_ > 0.0 ? to_seconds(frame.utime - previous_utime_) / last_motion_s_ : 0.0;
  const Eigen::Isometry3d steady =
      make_pose(exp_so3(ratio * log_so3(last_motion_.linear())), ratio * last_motion_.translation());
  struct Guess {
    Eigen::Isometry3d T_prev_cur;
    bool search;
  };
  std::vector<Guess> guesses;
  if (frame.R_prev_cur) guesses.push_back({make_pose(*frame.R_prev_cur, steady.translation()), false});
  guesses.push_back({steady, false});
  guesses.push_back({Eigen::Isometry3d::Identity(), true});
  Registration best;
  for (const Guess& guess : guesses) {
    Registration candidate = attempt(frame, pair, guess.T_prev_cur, guess.search);
    if (candidate.motion.inliers > best.motion.inliers) best = std::move(candidate);
    if (trustworthy(best) && best.motion.inliers >= config_.ok_inliers) break;
  }
  return best;
}

Odometry::Registration Odometry::attempt(const StereoFrame& frame, const Pair& pair,
                                         const Eigen::Isometry3d& T_prev_cur_body, bool search) const {
  const Eigen::Isometry3d& T_body_cam = frame.camera.T_body_cam;
  const Eigen::Isometry3d T_prev_cur = T_body_cam.inverse() * T_prev_cur_body * T_body_cam;
  const Eigen::Isometry3d T_guess = (T_key_prev_ * T_prev_cur).inverse();
  const auto coarse =
      observations_of(*key_, track_coarse(*key_, pair.left, T_guess, config_.tracker, search), key_offset_px_);
  if (static_cast<int>(coarse.size()) < config_.min_inliers) return {};
  const std::uint64_t seed = config_.seed ^ static_cast<std::uint64_t>(frame.utime);
  const RansacResult start = ransac(coarse, key_->camera, T_guess, config_.motion, seed);
  if (start.inliers < config_.min_inliers) return {};
  const auto fine = observations_of(*key_, track_fine(*key_, pair.left, pair.right, start.T_cur_key, config_.tracker),
                                    key_offset_px_);
  if (static_cast<int>(fine.size()) < config_.min_inliers) return {};
  return {refine(fine, key_->camera, start.T_cur_key, config_.motion), static_cast<int>(fine.size())};
}

bool Odometry::trustworthy(const Registration& registration) const {
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
  result.keyframe_utime = key_utime_;
  result.T_prev_cur = T_body_cam * T_key_prev_.inverse() * T_key_cur * T_body_cam.inverse();
  // A small motion on the left of T_cur_key is one of the current camera; seen in the current, then in the previous
  // body's axes.
  const Matrix6d Ad = adjoint(T_body_cam);
  result.cov = rotated(Ad * registration.motion.cov * Ad.transpose(), result.T_prev_cur.linear());
  result.features = registration.tracked;
  result.inliers = registration.motion.inliers;
  result.rms_px = registration.motion.rms_px;
  result.status = judge(frame, result);
  T_key_prev_ = T_key_cur;
  last_motion_ = result.T_prev_cur;
  last_motion_s_ = to_seconds(frame.utime - previous_utime_);
  previous_utime_ = frame.utime;
  lost_in_a_row_ = 0;
  return result;
}

Status Odometry::judge(const StereoFrame& frame, const OdometryResult& result) const {
  if (result.inliers < config_.ok_inliers || result.inliers < config_.ok_share * result.features)
    return Status::kDegraded;
  if (!frame.R_prev_cur) return Status::kOk;
  const double apart = log_so3(frame.R_prev_cur->transpose() * result.T_prev_cur.linear()).norm();
  return apart > config_.gyro_tolerance_rad ? Status::kDegraded : Status::kOk;
}

OdometryResult Odometry::lost(const StereoFrame& frame, const Registration& registration) const {
  OdometryResult result;
  result.previous_utime = previous_utime_ == kNever ? frame.utime : previous_utime_;
  result.utime = frame.utime;
  result.keyframe_utime = key_utime_;
  result.features = registration.tracked;
  result.inliers = registration.motion.inliers;
  return result;
}

}  // namespace rover::vo
