#include "trajectory_control/path_smoother.hpp"

#include <Eigen/Sparse>
#include <cmath>

namespace rover::control {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Points2 = Eigen::Matrix<double, Eigen::Dynamic, 2>;

constexpr double kEndWeight = 1e4;
constexpr double kMaxGrowth = 16.0;  // of one weight per iteration

// Third-difference operator, scaled so that a feature of the smoothing length costs as much as its distance.
Sparse third_differences(Eigen::Index count, double scale) {
  Sparse D(count - 3, count);
  D.reserve(Eigen::VectorXi::Constant(static_cast<int>(count), 4));
  for (Eigen::Index i = 0; i + 3 < count; ++i) {
    D.insert(i, i) = -scale;
    D.insert(i, i + 1) = 3.0 * scale;
    D.insert(i, i + 2) = -3.0 * scale;
    D.insert(i, i + 3) = scale;
  }
  return D;
}

Sparse diagonal(const Eigen::VectorXd& values) {
  Sparse out(values.size(), values.size());
  out.reserve(Eigen::VectorXi::Constant(static_cast<int>(values.size()), 1));
  for (Eigen::Index i = 0; i < values.size(); ++i) out.insert(i, i) = values(i);
  return out;
}

}  // namespace

std::vector<Eigen::Vector2d> smooth(const std::vector<Eigen::Vector2d>& points, double step_m,
                                    const SmootherConfig& config) {
  const Eigen::Index count = static_cast<Eigen::Index>(points.size());
  if (count < 5 || config.max_distance_m <= 0.0) return points;
  Points2 path(count, 2);
  for (Eigen::Index i = 0; i < count; ++i) path.row(i) = points[static_cast<size_t>(i)];
  const Sparse D = third_differences(count, std::pow(config.length_m / step_m, 3));
  const Sparse roughness = D.transpose() * D;
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(count);
  weights(0) = weights(count - 1) = kEndWeight;

  Points2 curve = path;
  Eigen::SimplicialLDLT<Sparse> solver;
  solver.analyzePattern(roughness + diagonal(weights));
  for (int n = 0; n < config.iterations; ++n) {
    solver.factorize(roughness + diagonal(weights));
    curve = solver.solve(weights.asDiagonal() * path);
    const Eigen::VectorXd excess = (curve - path).rowwise().norm() / config.max_distance_m;
    if (excess.maxCoeff() <= 1.0) break;
    for (Eigen::Index i = 0; i < count; ++i)
      if (excess(i) > 1.0) weights(i) *= std::min(std::pow(excess(i), 3), kMaxGrowth);
  }
  std::vector<Eigen::Vector2d> out(points.size());
  for (Eigen::Index i = 0; i < count; ++i) out[static_cast<size_t>(i)] = curve.row(i);
  out.front() = points.front();
  out.back() = points.back();
  return out;
}

}  // namespace rover::control
