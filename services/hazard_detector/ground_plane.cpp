#include "hazard_detector/ground_plane.hpp"

#include <algorithm>
#include <cmath>

namespace rover::hazard {
namespace {

constexpr int kPitchSteps = 12;        // hypotheses on each side of zero, steps of 1 deg
constexpr int kRollSteps = 6;          // steps of 2 deg
constexpr double kBinM = 0.02;         // bin width of the offset histogram
constexpr double kBelowPenalty = 0.5;  // score penalty per cell below the plane
constexpr int kIrlsIterations = 4;
constexpr size_t kSearchPoints = 250;  // subsample for the search; the refinement uses all points

struct WeightedPoint {
  float x_m, y_m, z_m, weight;
};

double distance_weight(const GroundPoint& p, const PlanePrior& prior) {
  const double ahead = std::max(0.0, p.x_m - prior.front_axle_x_m) / prior.half_weight_m;
  return 1.0 / (1.0 + ahead * ahead);
}

// Histogram of point offsets for given slopes, slightly wider than the offset bounds (Hough-like vote).
class OffsetHistogram {
 public:
  explicit OffsetHistogram(const PlanePrior& prior)
      : range_(prior.max_offset_m + 3.0 * prior.inlier_m),
        bins_(static_cast<size_t>(std::ceil(2.0 * range_ / kBinM))) {}

  void fill(const std::vector<WeightedPoint>& points, const PlanePrior& prior, double slope_x, double slope_y) {
    std::fill(bins_.begin(), bins_.end(), 0.0f);
    below_ = 0.0f;
    const float sx = static_cast<float>(slope_x), sy = static_cast<float>(slope_y);
    const float shift = static_cast<float>(range_ + slope_x * prior.front_axle_x_m);
    const float per_bin = static_cast<float>(1.0 / kBinM);
    for (const WeightedPoint& p : points) {
      const float bin = (p.z_m - sx * p.x_m - sy * p.y_m + shift) * per_bin;
      if (bin < 0.0f)
        below_ += p.weight;
      else if (bin < static_cast<float>(bins_.size()))
        bins_[static_cast<size_t>(bin)] += p.weight;
    }
  }

  // Returns the best score and its offset.
  std::pair<double, double> best(const PlanePrior& prior) const {
    const int half = std::max(1, static_cast<int>(std::lround(prior.inlier_m / kBinM)));
    std::pair<double, double> best{-1e9, 0.0};
    double below = below_, inside = 0.0;
    for (int i = 0; i < std::min<int>(2 * half, static_cast<int>(bins_.size())); ++i)
      inside += bins_[static_cast<size_t>(i)];
    for (int centre = half; centre + half < static_cast<int>(bins_.size()); ++centre) {
      const double offset = centre * kBinM - range_;
      const double score = inside - kBelowPenalty * below;
      if (std::abs(offset) <= prior.max_offset_m && score > best.first) best = {score, offset};
      inside += bins_[static_cast<size_t>(centre + half)] - bins_[static_cast<size_t>(centre - half)];
      below += bins_[static_cast<size_t>(centre - half)];
    }
    return best;
  }

 private:
  double range_;
  std::vector<float> bins_;  // sums of weights
  float below_ = 0.0f;
};

std::vector<WeightedPoint> subsample(const GroundPoints& points, const PlanePrior& prior) {
  const size_t step = std::max<size_t>(1, points.size() / kSearchPoints);
  std::vector<WeightedPoint> out;
  for (size_t i = 0; i < points.size(); i += step) {
    const GroundPoint& p = points[i];
    out.push_back({p.x_m, p.y_m, p.z_m, static_cast<float>(distance_weight(p, prior))});
  }
  return out;
}

GroundPlane grid_search(const std::vector<WeightedPoint>& points, const PlanePrior& prior) {
  OffsetHistogram histogram(prior);
  GroundPlane plane;
  double best = -1e9;
  for (int i = -kPitchSteps; i <= kPitchSteps; ++i)
    for (int j = -kRollSteps; j <= kRollSteps; ++j) {
      const double slope_x = std::tan(prior.max_slope_rad * i / kPitchSteps);
      const double slope_y = std::tan(prior.max_slope_rad * j / kRollSteps);
      histogram.fill(points, prior, slope_x, slope_y);
      const auto [raw_score, offset] = histogram.best(prior);
      // Tie-break: prefer the plane closest to the one under the rover.
      const double score = raw_score - 1e-3 * (std::abs(i) + std::abs(j)) - 1e-2 * std::abs(offset);
      if (score > best) {
        best = score;
        plane = {offset, slope_x, slope_y, true};
      }
    }
  return plane;
}

// One step of iteratively reweighted least squares with Tukey weights.
void irls_step(const GroundPoints& points, const PlanePrior& prior, GroundPlane& plane) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Identity() * 1e-3;
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const GroundPoint& p : points) {
    const Eigen::Vector3d a(1.0, p.x_m - prior.front_axle_x_m, p.y_m);
    const double residual = p.z_m - a.dot(Eigen::Vector3d(plane.offset_m, plane.slope_x, plane.slope_y));
    const double s = residual / prior.tukey_m;
    if (std::abs(s) >= 1.0) continue;
    const double weight = distance_weight(p, prior) * (1.0 - s * s) * (1.0 - s * s);
    A += weight * a * a.transpose();
    b += weight * a * residual;
  }
  const Eigen::Vector3d step = A.ldlt().solve(b);
  const double max_slope = std::tan(prior.max_slope_rad);
  plane.offset_m = std::clamp(plane.offset_m + step[0], -prior.max_offset_m, prior.max_offset_m);
  plane.slope_x = std::clamp(plane.slope_x + step[1], -max_slope, max_slope);
  plane.slope_y = std::clamp(plane.slope_y + step[2], -max_slope, max_slope);
}

}  // namespace

GroundPlane fit_ground_plane(const GroundPoints& points, const PlanePrior& prior) {
  if (static_cast<int>(points.size()) < prior.min_cells) return {};
  GroundPlane plane = grid_search(subsample(points, prior), prior);
  for (int i = 0; i < kIrlsIterations; ++i) irls_step(points, prior, plane);
  return plane;
}

}  // namespace rover::hazard
