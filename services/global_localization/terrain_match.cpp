#include "global_localization/terrain_match.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace rover::global {
namespace {

constexpr double kLeastEnergy = 1e-20;

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

// Of heights, less the bend that fits them best.
class Differences {
 public:
  explicit Differences(const Bend& stiffness) : form_(stiffness.asDiagonal()) {}

  void add(const TerrainSample& sample, double difference) {
    ++count_;
    squares_ += difference * difference;
    share_ += difference * sample.bend;
    form_.noalias() += sample.bend * sample.bend.transpose();
  }
  int count() const { return count_; }
  double mean_square() const {
    if (count_ <= Bend::RowsAtCompileTime) return std::numeric_limits<double>::infinity();  // bends fit anything
    return std::max(0.0, (squares_ - share_.dot(form_.ldlt().solve(share_))) / count_);
  }

 private:
  int count_ = 0;
  double squares_ = 0.0;
  Bend share_ = Bend::Zero();
  BendForm form_;
};

}  // namespace

double CorrelationSums::correlation() const {
  if (count == 0) return 0.0;
  const double energy = (tt - (tx * tx + ty * ty) / count) * (mm - (mx * mx + my * my) / count);
  return energy > kLeastEnergy ? (tm - (tx * mx + ty * my) / count) / std::sqrt(energy) : 0.0;
}

struct OrbitalPart::Square {
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

OrbitalPart::OrbitalPart(PlaneField field) : field_(std::move(field)) {
  for (int row = 0; row < field_.lattice.rows; ++row)
    for (int column = 0; column < field_.lattice.columns; ++column)
      surrounded_.push_back(all_known(field_, column, row) ? 1 : 0);
}

// False where a cell around the place is not known.
bool OrbitalPart::find(const Eigen::Vector2d& p_map, Square& square) const {
  const Lattice& lattice = field_.lattice;
  const double u = (p_map.x() - lattice.x0_m) / lattice.cell_m - 0.5;
  const double v = (p_map.y() - lattice.y0_m) / lattice.cell_m - 0.5;
  if (!(u >= 0.0 && v >= 0.0 && u < lattice.columns && v < lattice.rows)) return false;
  const int column = static_cast<int>(u), row = static_cast<int>(v);
  if (surrounded_[lattice.index(column, row)] == 0) return false;
  square = {lattice.index(column - 1, row - 1), static_cast<size_t>(lattice.columns), cubic_weights(u - column),
            cubic_weights(v - row)};
  return true;
}

Fit OrbitalPart::fit(const TerrainTemplate& terrain, const Placement& placement) const {
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(placement.yaw_rad).toRotationMatrix();
  CorrelationSums gradients;
  Differences heights(terrain.stiffness);
  Square square{};
  for (const TerrainSample& sample : terrain.samples) {
    if (!find(placement.center_map + R * sample.p, square)) continue;
    const Eigen::Vector2d turned = R * sample.g;
    gradients.add(turned.x(), turned.y(), square.value(field_.gx), square.value(field_.gy));
    heights.add(sample, square.value(field_.z) - sample.z);
  }
  return {gradients.count, gradients.correlation(), std::sqrt(heights.mean_square())};
}

double OrbitalPart::mean_square(const TerrainTemplate& terrain, const Placement& placement, int least) const {
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(placement.yaw_rad).toRotationMatrix();
  Differences heights(terrain.stiffness);
  Square square{};
  for (const TerrainSample& sample : terrain.samples)
    if (find(placement.center_map + R * sample.p, square)) heights.add(sample, square.value(field_.z) - sample.z);
  return heights.count() >= std::max(least, 1) ? heights.mean_square() : std::numeric_limits<double>::infinity();
}

}  // namespace rover::global
