#include "global_localization/terrain_template.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "global_localization/edge_field.hpp"

namespace rover::global {
namespace {

constexpr size_t kDistortedSamples = 300;  // enough for a field that is smooth over many
constexpr double kRegularisation = 1e-9;   // regularisation, keeps the matrices of featureless terrain invertible

// Of the samples, in standard deviations of the filter. Denser edges double the time of a match and hardly help it.
double spacing_of(Layer layer) {
  return layer == Layer::kPicture ? 1.7 : 1.0;
}

DriftBasis drift_basis_at(const Eigen::Vector2d& p) {
  DriftBasis drift_basis;
  drift_basis << 1.0, p.x(), p.y(), p.x() * p.x(), p.x() * p.y(), p.y() * p.y();
  return drift_basis;
}

void centre_samples(TerrainTemplate& terrain) {
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
  for (TerrainSample& sample : terrain.samples) sample.drift_basis = drift_basis_at(sample.p / terrain.radius_m);
}

}  // namespace

PlaneField field_of(Layer layer, const HeightGrid& grid, const PlaneConfig& config) {
  PlaneField field = plane_field(grid, config);
  return layer == Layer::kPicture ? edge_field(std::move(field)) : field;
}

TerrainTemplate terrain_template(const HeightGrid& local, const PlaneConfig& config, Layer layer) {
  const PlaneField field = field_of(layer, local, config);
  const Lattice& lattice = field.lattice;
  const int step = std::max(1, static_cast<int>(std::lround(spacing_of(layer) * config.sigma_cells)));
  TerrainTemplate out;
  out.layer = layer;
  out.sample_area_m2 = step * step * lattice.cell_m * lattice.cell_m;
  for (int row = 0; row < lattice.rows; row += step)
    for (int column = 0; column < lattice.columns; column += step) {
      const size_t i = lattice.index(column, row);
      if (field.known[i] == 0) continue;
      out.samples.push_back({{lattice.center_x_m(column), lattice.center_y_m(row)},
                             field.z[i],
                             {field.gx[i], field.gy[i]},
                             DriftBasis::Zero()});
    }
  centre_samples(out);
  return out;
}

DriftBasis drift_information(const TerrainTemplate& terrain, const DriftConfig& config, double noise_density) {
  const double tilt_m = config.tilt_sigma_rad * terrain.radius_m;
  const double tilt = 1.0 / (tilt_m * tilt_m), curvature = 1.0 / (config.curvature_sigma_m * config.curvature_sigma_m);
  DriftBasis out;
  out << 0.0, tilt, tilt, curvature, curvature, curvature;
  return noise_density / terrain.sample_area_m2 * out;
}

Eigen::Matrix3d expected_covariance(const TerrainTemplate& terrain) {
  // Height change per shift in x, y and per yaw, and its cross terms with the drift (Schur complement).
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 6> cross = Eigen::Matrix<double, 3, 6>::Zero();
  DriftMatrix drift_matrix = kRegularisation * DriftMatrix::Identity();
  drift_matrix.diagonal() += terrain.drift_information;
  for (const TerrainSample& s : terrain.samples) {
    const Eigen::Vector3d change(s.g.x(), s.g.y(), s.g.y() * s.p.x() - s.g.x() * s.p.y());
    information += change * change.transpose();
    cross += change * s.drift_basis.transpose();
    drift_matrix += s.drift_basis * s.drift_basis.transpose();
  }
  information = terrain.sample_area_m2 * (information - cross * drift_matrix.ldlt().solve(cross.transpose()));
  return (information + kRegularisation * Eigen::Matrix3d::Identity()).inverse();
}

Eigen::Matrix3d distortion_covariance(const TerrainTemplate& terrain, double sigma_m, double length_m) {
  using Jacobian = Eigen::Matrix<double, 2, 3>;  // of a sample's displacement by the rigid motion
  const size_t step = 1 + terrain.samples.size() / kDistortedSamples;
  std::vector<Eigen::Vector2d> places;
  std::vector<Jacobian> jacobians;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero(), spread = Eigen::Matrix3d::Zero();
  for (size_t i = 0; i < terrain.samples.size(); i += step) {
    const Eigen::Vector2d& p = terrain.samples[i].p;
    Jacobian J;
    J << 1.0, 0.0, -p.y(), 0.0, 1.0, p.x();
    normal += J.transpose() * J;
    for (size_t j = 0; j < places.size(); ++j) {
      const double correlation = std::exp(-0.5 * (p - places[j]).squaredNorm() / (length_m * length_m));
      const Eigen::Matrix3d pair = correlation * J.transpose() * jacobians[j];
      spread += pair + pair.transpose();
    }
    spread += J.transpose() * J;
    places.push_back(p);
    jacobians.push_back(J);
  }
  const Eigen::Matrix3d inverse = (normal + kRegularisation * Eigen::Matrix3d::Identity()).inverse();
  return sigma_m * sigma_m * inverse * spread * inverse;
}

}  // namespace rover::global
