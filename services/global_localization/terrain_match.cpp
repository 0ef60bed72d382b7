#include "global_localization/terrain_match.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "global_localization/edge_field.hpp"

namespace rover::global {
namespace {

constexpr double kMinEnergy = 1e-20;

std::array<double, 4> cubic_weights(double t) {
  const double t2 = t * t, t3 = t2 * t;
  return {0.5 * (-t3 + 2 * t2 - t), 0.5 * (3 * t3 - 5 * t2 + 2), 0.5 * (-3 * t3 + 4 * t2 + t), 0.5 * (t3 - t2)};
}

bool all_known(const PlaneField& field, int column, int row) {
  for (int j = -1; j <= 2; ++j)
    for (int i = -1; i <= 2; ++i)
      if (!field.lattice.contains(column + i, row + j) || field.known[field.lattice.index(column + i, row + j)] == 0)
        return false;
  return true;
}

// Fraction of the variance that a correlation leaves; all of it for an opposite one.
double unexplained(double correlation) {
  return correlation > 0.0 ? 1.0 - correlation * correlation : 1.0;
}

// Height differences after least-squares removal of the local map's drift.
class HeightResiduals {
 public:
  explicit HeightResiduals(const DriftBasis& drift_information) : normal_matrix_(drift_information.asDiagonal()) {}

  void add(const TerrainSample& sample, double difference) {
    ++count_;
    sum_squared_ += difference * difference;
    cross_ += difference * sample.drift_basis;
    normal_matrix_.noalias() += sample.drift_basis * sample.drift_basis.transpose();
  }
  int count() const { return count_; }
  double mean_square() const {
    if (count_ <= DriftBasis::RowsAtCompileTime) return std::numeric_limits<double>::infinity();  // drift fits exactly
    return std::max(0.0, (sum_squared_ - cross_.dot(normal_matrix_.ldlt().solve(cross_))) / count_);
  }

 private:
  int count_ = 0;
  double sum_squared_ = 0.0;
  DriftBasis cross_ = DriftBasis::Zero();
  DriftMatrix normal_matrix_;
};

}  // namespace

Eigen::Rotation2Dd turn_of(Layer layer, double yaw_rad) {
  return Eigen::Rotation2Dd(layer == Layer::kPicture ? kEdgeTurns * yaw_rad : yaw_rad);
}

double CorrelationSums::correlation() const {
  if (count == 0) return 0.0;
  const double energy = (tt - (tx * tx + ty * ty) / count) * (mm - (mx * mx + my * my) / count);
  return energy > kMinEnergy ? (tm - (tx * mx + ty * my) / count) / std::sqrt(energy) : 0.0;
}

struct OrbitalSection::Stencil {
  size_t first, row_step;
  std::array<double, 4> u, v;

  double value(const std::vector<float>& cells) const {
    double sum = 0.0;
    for (size_t j = 0; j < 4; ++j) {
      const float* line = cells.data() + first + j * row_step;
      sum += v[j] * (u[0] * line[0] + u[1] * line[1] + u[2] * line[2] + u[3] * line[3]);
    }
    return sum;
  }
};

OrbitalSection::OrbitalSection(PlaneField field) : field_(std::move(field)) {
  for (int row = 0; row < field_.lattice.rows; ++row)
    for (int column = 0; column < field_.lattice.columns; ++column)
      stencil_known_.push_back(all_known(field_, column, row) ? 1 : 0);
}

// False if a cell of the stencil is unknown.
bool OrbitalSection::find_stencil(const Eigen::Vector2d& p_map, Stencil& stencil) const {
  const Lattice& lattice = field_.lattice;
  const double u = (p_map.x() - lattice.x0_m) / lattice.cell_m - 0.5;
  const double v = (p_map.y() - lattice.y0_m) / lattice.cell_m - 0.5;
  if (!(u >= 0.0 && v >= 0.0 && u < lattice.columns && v < lattice.rows)) return false;
  const int column = static_cast<int>(u), row = static_cast<int>(v);
  if (stencil_known_[lattice.index(column, row)] == 0) return false;
  stencil = {lattice.index(column - 1, row - 1), static_cast<size_t>(lattice.columns), cubic_weights(u - column),
             cubic_weights(v - row)};
  return true;
}

Fit OrbitalSection::fit(const TerrainTemplate& terrain, const CandidatePose& pose) const {
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(pose.yaw_rad).toRotationMatrix();
  const Eigen::Matrix2d turn = turn_of(terrain.layer, pose.yaw_rad).toRotationMatrix();
  CorrelationSums gradients;
  HeightResiduals heights(terrain.drift_information);
  Stencil stencil{};
  for (const TerrainSample& sample : terrain.samples) {
    if (!find_stencil(pose.center_map + R * sample.p, stencil)) continue;
    const Eigen::Vector2d rotated = turn * sample.g;
    gradients.add(rotated.x(), rotated.y(), stencil.value(field_.gx), stencil.value(field_.gy));
    if (terrain.layer == Layer::kHeight) heights.add(sample, stencil.value(field_.z) - sample.z);
  }
  const double correlation = gradients.correlation();
  const double mean_square = terrain.layer == Layer::kHeight ? heights.mean_square() : unexplained(correlation);
  return {gradients.count, correlation, std::sqrt(mean_square)};
}

double OrbitalSection::mean_square(const TerrainTemplate& terrain, const CandidatePose& pose, int min_compared) const {
  if (terrain.layer == Layer::kPicture) {
    const Fit edges = fit(terrain, pose);
    return edges.compared >= std::max(min_compared, 1) ? edges.residual * edges.residual
                                                       : std::numeric_limits<double>::infinity();
  }
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(pose.yaw_rad).toRotationMatrix();
  HeightResiduals heights(terrain.drift_information);
  Stencil stencil{};
  for (const TerrainSample& sample : terrain.samples)
    if (find_stencil(pose.center_map + R * sample.p, stencil)) heights.add(sample, stencil.value(field_.z) - sample.z);
  return heights.count() >= std::max(min_compared, 1) ? heights.mean_square() : std::numeric_limits<double>::infinity();
}

}  // namespace rover::global
