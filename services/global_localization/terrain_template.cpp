#include "global_localization/terrain_template.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace rover::global {
namespace {

constexpr double kLeastForm = 1e-9;  // of ground that tells nothing, so that it can be inverted

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
      out.samples.push_back(
          {{lattice.center_x_m(column), lattice.center_y_m(row)}, field.z[i], {field.gx[i], field.gy[i]}});
    }
  centre(out);
  return out;
}

Eigen::Matrix3d covariance_by_relief(const TerrainTemplate& terrain) {
  // Change of height for a shift along x, y and a turn; their form about the means takes the offset out.
  Eigen::Matrix3d form = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const TerrainSample& s : terrain.samples) {
    const Eigen::Vector3d change(s.g.x(), s.g.y(), s.g.y() * s.p.x() - s.g.x() * s.p.y());
    form += change * change.transpose();
    sum += change;
  }
  const double count = std::max<double>(1.0, static_cast<double>(terrain.samples.size()));
  form = terrain.sample_area_m2 * (form - sum * sum.transpose() / count);
  return (form + kLeastForm * Eigen::Matrix3d::Identity()).inverse();
}

}  // namespace rover::global
