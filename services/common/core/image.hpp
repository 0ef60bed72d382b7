// Images, disparity images and the rectified stereo camera.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "common/core/check.hpp"

namespace rover {

// Rows from the top, 8 bit grey.
struct GrayImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> data;

  GrayImage() = default;
  GrayImage(int w, int h, std::uint8_t value = 0) : width(w), height(h), data(static_cast<size_t>(w) * h, value) {}
  std::uint8_t& at(int x, int y) { return data[static_cast<size_t>(y) * width + x]; }
  std::uint8_t at(int x, int y) const { return data[static_cast<size_t>(y) * width + x]; }
};

// Of the left, rectified image, in 1/16 px; kInvalid without a match.
struct Disparity {
  static constexpr std::int16_t kInvalid = -1;
  int width = 0;
  int height = 0;
  std::vector<std::int16_t> px16;

  Disparity() = default;
  Disparity(int w, int h, std::int16_t value = kInvalid)
      : width(w), height(h), px16(static_cast<size_t>(w) * h, value) {}
  std::int16_t& at(int x, int y) { return px16[static_cast<size_t>(y) * width + x]; }
  std::int16_t at(int x, int y) const { return px16[static_cast<size_t>(y) * width + x]; }
  bool valid(int x, int y) const { return at(x, y) > 0; }
  double px(int x, int y) const { return at(x, y) / 16.0; }
};

// Rectified stereo pair: same focal length and principal point in both images, right camera at +x by the baseline.
struct StereoCamera {
  int width = 0;
  int height = 0;
  double focal_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
  double baseline_m = 0.0;
  Eigen::Isometry3d T_body_cam = Eigen::Isometry3d::Identity();

  // Equal intrinsics and baseline; the mount may differ.
  bool same_optics(const StereoCamera& other) const {
    return width == other.width && height == other.height && focal_px == other.focal_px && cx_px == other.cx_px &&
           cy_px == other.cy_px && baseline_m == other.baseline_m;
  }
  double depth_m(double disparity_px) const { return focal_px * baseline_m / disparity_px; }
  // Point in camera axes of pixel (u, v) with the disparity.
  Eigen::Vector3d point(double u, double v, double disparity_px) const {
    const double z = depth_m(disparity_px);
    return {(u - cx_px) / focal_px * z, (v - cy_px) / focal_px * z, z};
  }
};

}  // namespace rover
