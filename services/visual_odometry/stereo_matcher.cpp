#include "visual_odometry/stereo_matcher.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "visual_odometry/patch_aligner.hpp"

namespace rover::vo {
namespace {

constexpr int kSearchLevel = 2;
constexpr int kGradientReachPx = 8;
// Steeper gradients are edges between two surfaces.
constexpr double kMaxGradient = 0.5;

std::optional<double> disparity_at(const Disparity& seed, int x, int y) {
  if (x < 0 || y < 0 || x >= seed.width || y >= seed.height || !seed.valid(x, y)) return std::nullopt;
  return seed.px(x, y);
}

// Central difference over `dx`, `dy`; 0 if a side is missing or at a depth discontinuity.
double disparity_gradient(const Disparity& seed, int x, int y, int dx, int dy) {
  const auto a = disparity_at(seed, x - dx, y - dy);
  const auto b = disparity_at(seed, x + dx, y + dy);
  const auto m = disparity_at(seed, x, y);
  if (!a || !b || !m) return 0.0;
  const double gradient = (*b - *a) / (2.0 * (dx + dy));
  const double curvature = std::abs(0.5 * (*a + *b) - *m);
  return std::abs(gradient) < kMaxGradient && curvature < 1.0 ? gradient : 0.0;
}

std::optional<StereoMatch> from_seed(const Disparity& seed, const Eigen::Vector2f& corner) {
  const int x = static_cast<int>(std::lround(corner.x()));
  const int y = static_cast<int>(std::lround(corner.y()));
  const auto d = disparity_at(seed, x, y);
  if (!d) return std::nullopt;
  return StereoMatch{
      *d,
      0.0,
      {disparity_gradient(seed, x, y, kGradientReachPx, 0), disparity_gradient(seed, x, y, 0, kGradientReachPx)}};
}

// Disparity of best correlation along the row of a small image, in full-resolution pixels.
std::optional<double> search_coarse_row(const Patch& patch, const cv::Mat& right, const Eigen::Vector2f& p, float scale,
                                        const StereoMatchConfig& config) {
  const int first = static_cast<int>(std::floor(config.min_disparity_px / scale));
  const int last = static_cast<int>(std::ceil(config.max_disparity_px / scale));
  double best_score = config.min_score - 0.1;
  std::optional<double> best;
  for (int d = first; d <= last; ++d) {
    const double score = correlation(patch, right, p - Eigen::Vector2f(static_cast<float>(d), 0.0F));
    if (score <= best_score) continue;
    best_score = score;
    best = static_cast<float>(d) * scale;
  }
  return best;
}

std::optional<StereoMatch> search_row(const ImagePyramid& left, const ImagePyramid& right,
                                      const Eigen::Vector2f& corner, const StereoMatchConfig& config) {
  const int top = std::min(kSearchLevel, left.count() - 1);
  Patch patch;
  Eigen::Vector2f shift = Eigen::Vector2f::Zero();
  for (int level = top; level >= 1; --level) {
    const auto scale = static_cast<float>(1 << level);
    const Eigen::Vector2f p = corner / scale;
    if (!make_patch(left.levels[level], p, Eigen::Matrix2f::Identity(), patch)) return std::nullopt;
    if (level == top) {
      const auto d = search_coarse_row(patch, right.levels[level], p, scale, config);
      if (!d) return std::nullopt;
      shift.x() = static_cast<float>(-*d);
    }
    const Alignment a = align(patch, right.levels[level], p + shift / scale, 3.0F);
    if (!a.ok) return std::nullopt;
    shift = (a.position - p) * scale;
  }
  return StereoMatch{-static_cast<double>(shift.x())};
}

}  // namespace

std::optional<StereoMatch> match_corner(const ImagePyramid& left, const ImagePyramid& right, const Disparity* seed,
                                        const Eigen::Vector2f& corner, const StereoMatchConfig& config) {
  std::optional<StereoMatch> match;
  if (seed) match = from_seed(*seed, corner);
  if (!match && config.search_without_seed) match = search_row(left, right, corner, config);
  if (!match) return std::nullopt;
  Eigen::Matrix2f A_right_left;
  A_right_left << static_cast<float>(1.0 - match->gradient.x()), static_cast<float>(-match->gradient.y()), 0.0F, 1.0F;
  Patch patch;
  if (!make_patch(left.base(), corner, A_right_left.inverse(), patch)) return std::nullopt;
  const Eigen::Vector2f guess = corner - Eigen::Vector2f(static_cast<float>(match->disparity_px), 0.0F);
  const Alignment a = align(patch, right.base(), guess, static_cast<float>(config.max_seed_offset_px));
  if (!a.ok || a.score < config.min_score) return std::nullopt;
  match->disparity_px = corner.x() - a.position.x();
  match->row_offset_px = a.position.y() - corner.y();
  if (std::abs(match->row_offset_px) > config.max_row_offset_px) return std::nullopt;
  if (match->disparity_px < config.min_disparity_px || match->disparity_px > config.max_disparity_px)
    return std::nullopt;
  return match;
}

}  // namespace rover::vo
