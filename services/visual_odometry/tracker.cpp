#include "visual_odometry/tracker.hpp"

#include <Eigen/LU>
#include <cmath>
#include <optional>

#include "visual_odometry/patch_aligner.hpp"
#include "visual_odometry/projection.hpp"

namespace rover::vo {
namespace {

// Predicted pixel of a keyframe point and the affine warp of its patch there.
struct Prediction {
  Eigen::Vector3d z;
  Eigen::Matrix2f A_key_left;
  Eigen::Matrix2f A_key_right;
};

constexpr double kStencilPx = 4.0;
// Patches stretched further do not correlate.
constexpr float kMaxStretch = 4.0F;

std::optional<Eigen::Vector3d> predict_pixel(const Keyframe& key, const KeyPoint& point, const Eigen::Vector2d& offset,
                                             const Eigen::Isometry3d& T_cur_key) {
  const double d = point.disparity_px + point.disparity_gradient.dot(offset);
  if (d <= 0.0) return std::nullopt;
  const Eigen::Vector3d p = T_cur_key * key.camera.point(point.pixel.x() + offset.x(), point.pixel.y() + offset.y(), d);
  if (p.z() < kMinDepthM) return std::nullopt;
  return project(key.camera, p);
}

bool is_usable(const Eigen::Matrix2f& A) {
  const float det = A.determinant();
  return det > 1.0F / (kMaxStretch * kMaxStretch) && A.norm() < 2.0F * kMaxStretch && det < kMaxStretch * kMaxStretch;
}

std::optional<Prediction> predict(const Keyframe& key, const KeyPoint& point, const Eigen::Isometry3d& T_cur_key) {
  const auto z = predict_pixel(key, point, {0.0, 0.0}, T_cur_key);
  const auto zx = predict_pixel(key, point, {kStencilPx, 0.0}, T_cur_key);
  const auto zy = predict_pixel(key, point, {0.0, kStencilPx}, T_cur_key);
  if (!z || !zx || !zy) return std::nullopt;
  Eigen::Matrix<double, 3, 2> A;
  A << (*zx - *z) / kStencilPx, (*zy - *z) / kStencilPx;
  const Eigen::Matrix2f A_left_key = A.topRows<2>().cast<float>();
  Eigen::Matrix2f A_right_key;
  A_right_key << A.row(2).cast<float>(), A.row(1).cast<float>();
  if (!is_usable(A_left_key) || !is_usable(A_right_key)) return std::nullopt;
  return Prediction{*z, A_left_key.inverse(), A_right_key.inverse()};
}

// The pixel of best correlation in the window, or the guess if none exceeds the minimum.
Eigen::Vector2f search_window(const Patch& patch, const cv::Mat& image, const Eigen::Vector2f& guess,
                              const TrackerConfig& config) {
  auto best_score = static_cast<float>(config.min_score_coarse);
  Eigen::Vector2f best = guess;
  for (int dy = -config.search_px; dy <= config.search_px; ++dy)
    for (int dx = -config.search_px; dx <= config.search_px; ++dx) {
      const Eigen::Vector2f p = guess + Eigen::Vector2f(static_cast<float>(dx), static_cast<float>(dy));
      const float score = correlation(patch, image, p);
      if (score <= best_score) continue;
      best_score = score;
      best = p;
    }
  return best;
}

Track coarse(const Keyframe& key, const KeyPoint& point, const ImagePyramid& left, const Prediction& prediction,
             const TrackerConfig& config, bool search) {
  Track track;
  Eigen::Vector2f p = prediction.z.head<2>().cast<float>();
  Patch patch;
  const int last = std::min(1, left.count() - 1);
  for (int level = left.count() - 1; level >= last; --level) {
    const auto scale = static_cast<float>(1 << level);
    // A patch that leaves a small image may fit in the larger ones.
    if (!make_patch(key.left.levels[level], point.pixel / scale, prediction.A_key_left, patch)) continue;
    if (search && level == left.count() - 1) p = search_window(patch, left.levels[level], p / scale, config) * scale;
    const Alignment a = align(patch, left.levels[level], p / scale, static_cast<float>(config.max_shift_coarse_px));
    if (a.ok) p = a.position * scale;
    if (level == last) track.left = a.ok && a.score > config.min_score_coarse;
  }
  track.z.head<2>() = p.cast<double>();
  return track;
}

Track fine(const Keyframe& key, const KeyPoint& point, const ImagePyramid& left, const ImagePyramid& right,
           const Prediction& prediction, const TrackerConfig& config) {
  Track track;
  const auto max_shift = static_cast<float>(config.max_shift_fine_px);
  Patch patch;
  if (!make_patch(key.left.base(), point.pixel, prediction.A_key_left, patch)) return track;
  const Alignment l = align(patch, left.base(), prediction.z.head<2>().cast<float>(), max_shift);
  track.left = l.ok && l.score > config.min_score_fine;
  if (!track.left) return track;
  track.z.head<2>() = l.position.cast<double>();
  const double disparity = prediction.z.x() - prediction.z.z();
  const Eigen::Vector2f guess = l.position - Eigen::Vector2f(static_cast<float>(disparity), 0.0F);
  if (!make_patch(key.left.base(), point.pixel, prediction.A_key_right, patch)) return track;
  const Alignment r = align(patch, right.base(), guess, max_shift);
  track.right = r.ok && r.score > config.min_score_fine &&
                std::abs(r.position.y() - l.position.y()) < static_cast<float>(config.max_row_offset_px);
  track.z.z() = r.position.x();
  return track;
}

}  // namespace

std::vector<Track> track_coarse(const Keyframe& key, const ImagePyramid& left, const Eigen::Isometry3d& T_cur_key,
                                const TrackerConfig& config, bool search) {
  std::vector<Track> tracks(key.points.size());
  const size_t step = search ? 1 + tracks.size() / static_cast<size_t>(config.search_points) : 1;
  for (size_t i = 0; i < tracks.size(); i += step)
    if (const auto prediction = predict(key, key.points[i], T_cur_key))
      tracks[i] = coarse(key, key.points[i], left, *prediction, config, search);
  return tracks;
}

std::vector<Track> track_fine(const Keyframe& key, const ImagePyramid& left, const ImagePyramid& right,
                              const Eigen::Isometry3d& T_cur_key, const TrackerConfig& config) {
  std::vector<Track> tracks(key.points.size());
  for (size_t i = 0; i < tracks.size(); ++i)
    if (const auto prediction = predict(key, key.points[i], T_cur_key))
      tracks[i] = fine(key, key.points[i], left, right, *prediction, config);
  return tracks;
}

}  // namespace rover::vo
