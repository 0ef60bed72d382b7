// Analytic terrain, as an orbital map and as the rover's local elevation map.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <functional>

#include "common/core/frames.hpp"
#include "global_localization/global_localization.hpp"
#include "rover_simulator/world/noise.hpp"

namespace rover::global::test {

using Height = std::function<double(double x_m, double y_m)>;  // in map
using Seen = std::function<bool(int column, int row)>;         // of a view of 200 x 200 cells

constexpr double kSideM = 160.0;  // of the orbital map
constexpr double kCellM = 0.1;    // of the local one

// Fractal hills.
inline double hills(double x_m, double y_m) {
  double z = 0.0;
  for (double wave_m : {40.0, 20.0, 10.0, 5.0})
    z += 1.2 * std::pow(wave_m / 40.0, 0.9) * gradient_noise(77, x_m / wave_m, y_m / wave_m);
  return z;
}

// Ground without relief, and its brightness.
inline double level(double, double) {
  return 0.0;
}
inline double marks(double x_m, double y_m) {
  return 100.0 + 20.0 * gradient_noise(9, x_m / 3.0, y_m / 3.0) + 10.0 * gradient_noise(10, x_m / 1.2, y_m / 1.2);
}

inline HeightGrid orbital_of(const Height& height, double cell_m, double noise_m = 0.0) {
  HeightGrid grid;
  const int cells = static_cast<int>(kSideM / cell_m);
  grid.lattice = {cells, cells, cell_m, 0.0, 0.0};
  for (int row = 0; row < cells; ++row)
    for (int column = 0; column < cells; ++column) {
      const double noise = noise_m * gradient_noise(5, column / 3.0, row / 3.0);
      grid.z_m.push_back(
          static_cast<float>(height(grid.lattice.center_x_m(column), grid.lattice.center_y_m(row)) + noise));
      grid.weight.push_back(1.0f);
    }
  return grid;
}

inline Eigen::Vector2d transformed(const Pose2& T, const Eigen::Vector2d& p) {
  return Eigen::Vector2d(T.x_m, T.y_m) + Eigen::Rotation2Dd(T.yaw_rad) * p;
}

inline bool all_seen(int, int) {
  return true;
}

// 20 x 20 m around the rover, aligned with odom, 5 m above the map's heights because odom has its own datum.
inline ElevationView view_of(const Height& height, const Pose2& T_map_odom, const Eigen::Vector2d& p_odom_body,
                             const Seen& seen = all_seen) {
  ElevationView view;
  view.lattice = {200, 200, kCellM, std::round(p_odom_body.x() / kCellM) * kCellM - 10.0,
                  std::round(p_odom_body.y() / kCellM) * kCellM - 10.0};
  for (int row = 0; row < 200; ++row)
    for (int column = 0; column < 200; ++column) {
      const Eigen::Vector2d p =
          transformed(T_map_odom, {view.lattice.center_x_m(column), view.lattice.center_y_m(row)});
      const bool known = seen(column, row);
      view.z_m.push_back(static_cast<float>(known ? height(p.x(), p.y()) + 5.0 : kNaN));
      view.sigma_m.push_back(static_cast<float>(known ? 0.02 : kNaN));
    }
  return view;
}

// T_map_odom with an error at the rover: offset in map, and rotation about the rover.
inline Pose2 perturbed_transform(const Pose2& truth, const Eigen::Vector2d& p_odom_body, const Eigen::Vector2d& off_m,
                                 double turn_rad) {
  const double yaw = truth.yaw_rad + turn_rad;
  const Eigen::Vector2d t = transformed(truth, p_odom_body) + off_m - Eigen::Rotation2Dd(yaw) * p_odom_body;
  return {t.x(), t.y(), yaw};
}

inline Eigen::Matrix3d pose_cov() {
  return Eigen::Vector3d(16.0, 16.0, std::pow(to_rad(4.0), 2)).asDiagonal();
}

}  // namespace rover::global::test
