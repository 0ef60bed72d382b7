// Template of the local map: heights and gradients, or a picture's edges, at the orbital resolution, and the accuracy
// they allow.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/core/frames.hpp"
#include "global_localization/plane_field.hpp"

namespace rover::global {

// Height drift of odometry deforms the local map and would bias the position. Modelled as a quadratic polynomial with
// offset, tilt and curvature, each 1 at the template's radius.
using DriftBasis = Eigen::Matrix<double, 6, 1>;
using DriftMatrix = Eigen::Matrix<double, 6, 6>;

struct DriftConfig {
  double tilt_sigma_rad = to_rad(0.04);
  double curvature_sigma_m = 0.01;
};

// What is compared.
enum class Layer {
  kHeight,   // z and its gradient
  kPicture,  // the edges of edge_field(): z is unused
};

struct TerrainSample {
  Eigen::Vector2d p;                            // relative to the template's centre, odom axes [m]
  double z = 0.0;                               // relative to the mean height [m]
  Eigen::Vector2d g;                            // gradient or edge, odom axes
  DriftBasis drift_basis = DriftBasis::Zero();  // drift polynomial basis at p
};

struct TerrainTemplate {
  Layer layer = Layer::kHeight;
  Eigen::Vector2d center_odom = Eigen::Vector2d::Zero();  // mean sample position
  std::vector<TerrainSample> samples;                     // spaced about one Gaussian standard deviation
  double sample_area_m2 = 0.0;                            // area per sample
  double radius_m = 0.0;                                  // distance of the farthest sample
  DriftBasis drift_information =
      DriftBasis::Zero();  // diagonal prior information of the drift, in units of height noise variance

  double area_m2() const { return static_cast<double>(samples.size()) * sample_area_m2; }
};

// What is compared, of a grid of heights or of brightness.
PlaneField field_of(Layer layer, const HeightGrid& grid, const PlaneConfig& config);

TerrainTemplate terrain_template(const HeightGrid& local, const PlaneConfig& config, Layer layer = Layer::kHeight);

// For a map with this noise power density [m^4].
DriftBasis drift_information(const TerrainTemplate& terrain, const DriftConfig& config, double noise_density);

// Expected covariance of the centre's x, y and yaw (odom axes) at a map noise density of 1 m^4: inverse Fisher
// information of the relief, with the drift marginalised. Flat and evenly sloping terrain is unobservable.
Eigen::Matrix3d expected_covariance(const TerrainTemplate& terrain);

// Covariance of the centre's x, y and yaw of a match on a distorted map: each sample is displaced by `sigma_m` along
// each axis, with the correlation exp(-d^2 / 2 length_m^2), and the match is the rigid motion that fits
// the displacements best.
Eigen::Matrix3d distortion_covariance(const TerrainTemplate& terrain, double sigma_m, double length_m);

}  // namespace rover::global
