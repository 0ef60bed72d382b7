// The local map as it is looked for in the orbital one: heights and gradients at the orbital map's resolution where the
// ground was seen, and how much they can tell.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "global_localization/plane_field.hpp"

namespace rover::global {

struct TerrainSample {
  Eigen::Vector2d p;  // from the template's centre, odom axes [m]
  double z = 0.0;     // over the mean height [m]
  Eigen::Vector2d g;  // gradient, odom axes
};

struct TerrainTemplate {
  Eigen::Vector2d center_odom = Eigen::Vector2d::Zero();  // mean place of the samples
  std::vector<TerrainSample> samples;                     // about one each standard deviation of the Gaussian
  double sample_area_m2 = 0.0;                            // that each stands for
  double radius_m = 0.0;                                  // of the farthest sample

  double area_m2() const { return static_cast<double>(samples.size()) * sample_area_m2; }
};

TerrainTemplate terrain_template(const HeightGrid& local, const PlaneConfig& config);

// How well the ground tells its place: the covariance of the centre's x, y and of the turn (odom axes), for noise of
// density 1 m^2 m^2 in the map. From the sum over the seen area of the square of the height's change, less what an
// offset in height would explain. Even ground and ground of one slope tell next to nothing.
Eigen::Matrix3d covariance_by_relief(const TerrainTemplate& terrain);

}  // namespace rover::global
