#include "global_localization/refinement.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <nlopt.hpp>
#include <vector>

#include "common/core/frames.hpp"

namespace rover::global {
namespace {

// Of x, y and the way of the farthest sample in a turn, all in metres.
struct Objective {
  const OrbitalPart& orbital;
  const TerrainTemplate& terrain;
  Placement start;
  int least;
  double radius_m;

  Placement at(const double* x) const {
    return {start.center_map + Eigen::Vector2d(x[0], x[1]), start.yaw_rad + x[2] / radius_m};
  }
  double operator()(const Eigen::Vector3d& x) const { return orbital.mean_square(terrain, at(x.data()), least); }
};

Objective objective_at(const OrbitalPart& orbital, const TerrainTemplate& terrain, const Placement& start, int least) {
  return {orbital, terrain, start, least, std::max(terrain.radius_m, orbital.field().lattice.cell_m)};
}

double evaluated(unsigned, const double* x, double*, void* data) {
  const auto& f = *static_cast<const Objective*>(data);
  // BOBYQA's model bears no infinity.
  return std::min(f(Eigen::Vector3d(x[0], x[1], x[2])), 1e6);
}

Eigen::Matrix3d second_derivative(const Objective& f, double step) {
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

Match refined(const OrbitalPart& orbital, const TerrainTemplate& terrain, const Placement& start, int least,
              const RefinementConfig& config) {
  Objective f = objective_at(orbital, terrain, start, least);
  const double cell_m = orbital.field().lattice.cell_m;
  const double reach_m = config.reach_cells * cell_m, turn_m = config.reach_rad * f.radius_m;
  nlopt::opt optimiser(nlopt::LN_BOBYQA, 3);
  optimiser.set_min_objective(&evaluated, &f);
  optimiser.set_lower_bounds({-reach_m, -reach_m, -turn_m});
  optimiser.set_upper_bounds({reach_m, reach_m, turn_m});
  optimiser.set_initial_step(0.5 * std::min(cell_m, turn_m));
  optimiser.set_xtol_abs(1e-3 * cell_m);
  optimiser.set_maxeval(config.most_evaluations);
  std::vector<double> x = {0.0, 0.0, 0.0};
  double least_square = 0.0;
  try {
    optimiser.optimize(x, least_square);
  } catch (const nlopt::roundoff_limited&) {  // as near as numbers go
  }
  return {f.at(x.data()), orbital.fit(terrain, f.at(x.data()))};
}

Eigen::Matrix3d covariance_of(const OrbitalPart& orbital, const TerrainTemplate& terrain, const Match& match,
                              double independent_samples) {
  const Objective f = objective_at(orbital, terrain, match.placement, match.fit.compared / 2);
  const double square = std::max(match.fit.residual_m * match.fit.residual_m, 1e-8);
  const Eigen::Matrix3d H = second_derivative(f, orbital.field().lattice.cell_m);
  const Eigen::LLT<Eigen::Matrix3d> information(0.5 * independent_samples / square * H);
  if (!H.allFinite() || information.info() != Eigen::Success) return Eigen::Matrix3d::Constant(kNaN);
  const Eigen::Vector3d scale(1.0, 1.0, 1.0 / f.radius_m);
  return scale.asDiagonal() * information.solve(Eigen::Matrix3d::Identity()) * scale.asDiagonal();
}

}  // namespace rover::global
