// The local map as it is looked for in the orbital one: heights and gradients at the orbital map's resolution where the
// ground was seen, and how much they can tell.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/core/frames.hpp"
#include "global_localization/plane_field.hpp"

namespace rover::global {

// Shapes by which the local map is bent as odometry's height wanders along the way: offset, tilt and bow, each 1 at the
// template's radius. Taken as heights they would be shifts.
using Bend = Eigen::Matrix<double, 6, 1>;
using BendForm = Eigen::Matrix<double, 6, 6>;

struct BendConfig {
  double tilt_sigma_rad = to_rad(0.04);
  double bow_sigma_m = 0.01;
};

struct TerrainSample {
  Eigen::Vector2d p;         // from the template's centre, odom axes [m]
  double z = 0.0;            // over the mean height [m]
  Eigen::Vector2d g;         // gradient, odom axes
  Bend bend = Bend::Zero();  // here
};

struct TerrainTemplate {
  Eigen::Vector2d center_odom = Eigen::Vector2d::Zero();  // mean place of the samples
  std::vector<TerrainSample> samples;                     // about one each standard deviation of the Gaussian
  double sample_area_m2 = 0.0;                            // that each stands for
  double radius_m = 0.0;                                  // of the farthest sample
  Bend stiffness = Bend::Zero();  // what a bend costs, against the sum over the samples of squared heights

  double area_m2() const { return static_cast<double>(samples.size()) * sample_area_m2; }
};

TerrainTemplate terrain_template(const HeightGrid& local, const PlaneConfig& config);

// For a map with noise of that density [m^4].
Bend stiffness_of(const TerrainTemplate& terrain, const BendConfig& config, double noise_density);

// How well the ground tells its place: the covariance of the centre's x, y and of the turn (odom axes), for noise of
// density 1 m^2 m^2 in the map. From the sum over the seen area of the square of the height's change, less what a
// bend would explain. Even ground and ground of one slope tell next to nothing.
Eigen::Matrix3d covariance_by_relief(const TerrainTemplate& terrain);

}  // namespace rover::global
