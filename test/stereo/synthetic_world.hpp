// Known worlds for tests: a ground plane or a smooth ground, rocks (half ellipsoids and boxes) and pits, in body axes
// at the exposure. Rays are cast against the surfaces themselves; pairs of textured images or exact disparities follow.
#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "common/core/camera_rig.hpp"
#include "common/core/image.hpp"

namespace rover::synthetic {

struct Rock {
  double x_m = 0.0;
  double y_m = 0.0;
  double half_width_m = 0.0;
  double height_m = 0.0;
  bool box = false;
  bool textureless = false;
};

struct Pit {
  double x_m = 0.0;
  double y_m = 0.0;
  double half_width_m = 0.0;
  double depth_m = 0.0;
};

struct World {
  // z = z0 + slope_x x + slope_y y (+ relief).
  double z0_m = -0.62;
  double slope_x = 0.0;
  double slope_y = 0.0;
  std::function<double(double, double)> relief;  // smooth, small against the range; empty: none
  std::vector<Rock> rocks;
  std::vector<Pit> pits;

  double plane_m(double x, double y) const { return z0_m + slope_x * x + slope_y * y; }
  double ground_m(double x, double y) const { return plane_m(x, y) + (relief ? relief(x, y) : 0.0); }
};

struct Hit {
  double t = 0.0;  // multiple of the ray's direction, infinity: nothing
  int rock = -1;   // index, -1: ground
};

Hit cast(const World& world, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction);

// Exact disparity [px] of each pixel of the rectified left camera; 0 where nothing is hit or the surface is
// textureless.
std::vector<float> exact_disparity(const World& world, const StereoCamera& camera);
// Rounded to 1/16 px after Gaussian noise; `drop` is the share of pixels that stereo does not find.
Disparity noisy_disparity(const std::vector<float>& exact, const StereoCamera& camera, double sigma_px, double drop,
                          std::mt19937_64& random);

// Raw (distorted) images of the rig, with noise of sigma_grey.
struct RawPair {
  GrayImage left;
  GrayImage right;
};
RawPair render(const World& world, const StereoRig& rig, double sigma_grey, std::uint64_t seed);

// The LocCam as config/cameras.yaml gives it, and an ideal rectified camera like it.
StereoRig loccam_rig();
StereoCamera loccam_camera();

}  // namespace rover::synthetic
