#include "global_localization/terrain_template.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace rover::global {
namespace {

constexpr double kLeastForm = 1e-9;  // of ground that tells nothing, so that it can be inverted

Bend bend_at(const Eigen::Vector2d& p) {
  Bend bend;
  bend << 1.0, p.x(), p.y(), p.x() * p.x(), p.x() * p.y(), p.y() * p.y();
  return bend;
}

void centre(TerrainTemplate& terrain) {
  const auto count = static_cast<double>(terrain.samples.size());
  double mean_z = 0.0;
  for (const TerrainSample& sample : terrain.samples) {
    terrain.center_odom += sample.p / count;
    mean_z += sample.z / count;
  }
  for (TerrainSample& sample : terrain.samples) {
    sample.p -= terrain.center_odom;
    sample.z -= mean_z;
    terrain.radius_m = std::max(terrain.radius_m, sample.p.norm());
  }
  for (TerrainSample& sample : terrain.samples) sample.bend = bend_at(sample.p / terrain.radius_m);
}

}  // namespace

TerrainTemplate terrain_template(const HeightGrid& local, const PlaneConfig& config) {
  const PlaneField field = plane_field(local, config);
  const Lattice& lattice = field.lattice;
  const int step = std::max(1, static_cast<int>(std::lround(config.sigma_cells)));
  TerrainTemplate out;
  out.sample_area_m2 = step * step * lattice.cell_m * lattice.cell_m;
  for (int row = 0; row < lattice.rows; row += step)
    for (int column = 0; column < lattice.columns; column += step) {
      const size_t i = lattice.index(column, row);
      if (field.known[i] == 0) continue;
      out.samples.push_back({{lattice.center_x_m(column), lattice.center_y_m(row)},
                             field.z[i],
                             {field.gx[i], field.gy[i]},
                             Bend::Zero()});
    }
  centre(out);
  return out;
}

Bend stiffness_of(const TerrainTemplate& terrain, const BendConfig& config, double noise_density) {
  const double tilt_m = config.tilt_sigma_rad * terrain.radius_m;
  const double tilt = 1.0 / (tilt_m * tilt_m), bow = 1.0 / (config.bow_sigma_m * config.bow_sigma_m);
  Bend out;
  out << 0.0, tilt, tilt, bow, bow, bow;
  return noise_density / terrain.sample_area_m2 * out;
}

Eigen::Matrix3d covariance_by_relief(const TerrainTemplate& terrain) {
  // Change of height for a shift along x, y and a turn, and what of it a bend would explain.
  Eigen::Matrix3d form = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 6> shared = Eigen::Matrix<double, 3, 6>::Zero();
  BendForm shapes = kLeastForm * BendForm::Identity();
  shapes.diagonal() += terrain.stiffness;
  for (const TerrainSample& s : terrain.samples) {
    const Eigen::Vector3d change(s.g.x(), s.g.y(), s.g.y() * s.p.x() - s.g.x() * s.p.y());
    form += change * change.transpose();
    shared += change * s.bend.transpose();
    shapes += s.bend * s.bend.transpose();
  }
  form = terrain.sample_area_m2 * (form - shared * shapes.ldlt().solve(shared.transpose()));
  return (form + kLeastForm * Eigen::Matrix3d::Identity()).inverse();
}

}  // namespace rover::global
