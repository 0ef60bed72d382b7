#include "global_localization/refinement.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <nlopt.hpp>
#include <vector>

#include "common/core/frames.hpp"

namespace rover::global {
namespace {

// Mean square height residual over x, y and yaw; yaw is scaled to the arc at the template's radius, in metres.
struct Objective {
  const OrbitalSection& orbital;
  const TerrainTemplate& terrain;
  CandidatePose start;
  int min_compared;
  double radius_m;

  CandidatePose at(const double* x) const {
    return {start.center_map + Eigen::Vector2d(x[0], x[1]), start.yaw_rad + x[2] / radius_m};
  }
  double operator()(const Eigen::Vector3d& x) const { return orbital.mean_square(terrain, at(x.data()), min_compared); }
};

Objective objective_at(const OrbitalSection& orbital, const TerrainTemplate& terrain, const CandidatePose& start,
                       int min_compared) {
  return {orbital, terrain, start, min_compared, std::max(terrain.radius_m, orbital.field().lattice.cell_m)};
}

double evaluate_objective(unsigned, const double* x, double*, void* data) {
  const auto& f = *static_cast<const Objective*>(data);
  // BOBYQA needs finite values.
  return std::min(f(Eigen::Vector3d(x[0], x[1], x[2])), 1e6);
}

Eigen::Matrix3d hessian(const Objective& f, double step) {
  const Eigen::Matrix3d e = step * Eigen::Matrix3d::Identity();
  Eigen::Matrix3d H;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j)
      H(i, j) = H(j, i) =
          (f(e.col(i) + e.col(j)) - f(e.col(i) - e.col(j)) - f(e.col(j) - e.col(i)) + f(-e.col(i) - e.col(j))) /
          (4.0 * step * step);
  return H;
}

}  // namespace

Match refine(const OrbitalSection& orbital, const TerrainTemplate& terrain, const CandidatePose& start,
             int min_compared, const RefinementConfig& config) {
  Objective f = objective_at(orbital, terrain, start, min_compared);
  const double cell_m = orbital.field().lattice.cell_m;
  const double half_m = config.half_width_cells * cell_m, half_yaw_m = config.half_width_rad * f.radius_m;
  nlopt::opt optimiser(nlopt::LN_BOBYQA, 3);
  optimiser.set_min_objective(&evaluate_objective, &f);
  optimiser.set_lower_bounds({-half_m, -half_m, -half_yaw_m});
  optimiser.set_upper_bounds({half_m, half_m, half_yaw_m});
  optimiser.set_initial_step(0.5 * std::min(cell_m, half_yaw_m));
  optimiser.set_xtol_abs(1e-3 * cell_m);
  optimiser.set_maxeval(config.max_evaluations);
  std::vector<double> x = {0.0, 0.0, 0.0};
  double min_mean_square = 0.0;
  try {
    optimiser.optimize(x, min_mean_square);
  } catch (const nlopt::roundoff_limited&) {  // converged to machine precision
  }
  return {f.at(x.data()), orbital.fit(terrain, f.at(x.data()))};
}

Eigen::Matrix3d covariance_at_minimum(const OrbitalSection& orbital, const TerrainTemplate& terrain, const Match& match,
                                      double independent_samples, double max_sigma_m) {
  const Objective f = objective_at(orbital, terrain, match.pose, match.fit.compared / 2);
  const double mean_square = std::max(match.fit.residual * match.fit.residual, 1e-8);
  const Eigen::Matrix3d H = hessian(f, orbital.field().lattice.cell_m);
  if (!H.allFinite()) return Eigen::Matrix3d::Constant(kNaN);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(0.5 * independent_samples / mean_square * H);
  const Eigen::Vector3d variances = axes.eigenvalues().cwiseMax(1.0 / (max_sigma_m * max_sigma_m)).cwiseInverse();
  const Eigen::Vector3d scale(1.0, 1.0, 1.0 / f.radius_m);
  return scale.asDiagonal() * axes.eigenvectors() * variances.asDiagonal() * axes.eigenvectors().transpose() *
         scale.asDiagonal();
}

}  // namespace rover::global
