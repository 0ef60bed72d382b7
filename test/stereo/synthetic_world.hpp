// Analytic test scenes: ground, rocks (half ellipsoids and boxes) and pits, in body axes at the exposure. Ray casting
// gives textured image pairs or exact disparities.
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

// Exact disparity [px] per pixel of the rectified left camera; 0 without a hit or without texture.
std::vector<float> exact_disparity(const World& world, const StereoCamera& camera);
// Adds Gaussian noise and rounds to 1/16 px; `drop` is the fraction of invalid pixels.
Disparity noisy_disparity(const std::vector<float>& exact, const StereoCamera& camera, double sigma_px, double drop,
                          std::mt19937_64& random);

// Raw (distorted) images of the rig, with noise of sigma_grey.
struct RawPair {
  GrayImage left;
  GrayImage right;
};
RawPair render(const World& world, const StereoRig& rig, double sigma_grey, std::uint64_t seed);

// The LocCam of config/cameras.yaml, and its ideal rectified camera.
StereoRig loccam_rig();
StereoCamera loccam_camera();

}  // namespace rover::synthetic
