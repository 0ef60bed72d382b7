#include "driver/plane_camera.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>

namespace example {
namespace {

using rover::GrayImage;

constexpr float kExposureS = 0.005F;
constexpr std::uint8_t kSky = 170;
constexpr float kMeanGrey = 115.0F;
constexpr float kNoiseGrey = 1.5F;

// Patches of random grey, from boulders' size down to grains.
struct Layer {
  float cell_m;
  float grey;
};
constexpr std::array kLayers = {Layer{0.35F, 26.0F}, Layer{0.11F, 26.0F}, Layer{0.037F, 30.0F}, Layer{0.013F, 30.0F}};

// Mixes bits well enough for a picture (splitmix64).
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

// In [-1, 1].
float random_at(std::uint64_t key) {
  return static_cast<float>(mixed(key) >> 40) * (2.0F / 16777216.0F) - 1.0F;
}

float lattice(int x, int y, std::uint64_t layer) {
  return random_at((static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32) ^ static_cast<std::uint32_t>(y) ^
                   (layer << 60));
}

// Bilinear between lattice points.
float painted(float x, float y, std::uint64_t layer) {
  const float x0 = std::floor(x);
  const float y0 = std::floor(y);
  const auto i = static_cast<int>(x0);
  const auto j = static_cast<int>(y0);
  const float u = x - x0;
  const float v = y - y0;
  const float below = lattice(i, j, layer) * (1.0F - u) + lattice(i + 1, j, layer) * u;
  const float above = lattice(i, j + 1, layer) * (1.0F - u) + lattice(i + 1, j + 1, layer) * u;
  return below * (1.0F - v) + above * v;
}

// `pixel_m`: what one pixel covers there; finer layers are not to be seen.
float ground_grey(float x_m, float y_m, float pixel_m) {
  float grey = kMeanGrey;
  for (size_t i = 0; i < kLayers.size(); ++i) {
    const float seen = std::clamp(kLayers[i].cell_m / pixel_m - 1.0F, 0.0F, 1.0F);
    if (seen > 0.0F) grey += seen * kLayers[i].grey * painted(x_m / kLayers[i].cell_m, y_m / kLayers[i].cell_m, i);
  }
  return grey;
}

}  // namespace

PlaneCamera::PlaneCamera(const rover::StereoRig& rig, double origin_height_m)
    : width_(rig.width),
      height_(rig.height),
      origin_height_m_(origin_height_m),
      left_(eye(rig.left, rig.T_body_left)),
      right_(eye(rig.right, rig.T_body_left * rig.T_left_right)) {}

PlaneCamera::Eye PlaneCamera::eye(const rover::PinholeCamera& camera, const Eigen::Isometry3d& T_body_cam) const {
  std::vector<cv::Point2d> pixels;
  for (int v = 0; v < height_; ++v)
    for (int u = 0; u < width_; ++u) pixels.emplace_back(u, v);
  const cv::Matx33d K(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
  std::vector<cv::Point2d> ideal;
  const bool fisheye = camera.model == rover::DistortionModel::kEquidistant;
  const std::vector<double> D(camera.distortion.begin(), camera.distortion.begin() + (fisheye ? 4 : 5));
  if (fisheye)
    cv::fisheye::undistortPoints(pixels, ideal, K, D);
  else
    cv::undistortPoints(pixels, ideal, K, D);
  Eye out;
  out.p_body = T_body_cam.translation();
  for (const cv::Point2d& p : ideal)
    out.rays_body.emplace_back((T_body_cam.linear() * Eigen::Vector3d(p.x, p.y, 1.0)).cast<float>());
  return out;
}

GrayImage PlaneCamera::picture(const Eye& eye, const rover::Pose2& pose, std::uint64_t seed) const {
  const auto c = static_cast<float>(std::cos(pose.yaw_rad));
  const auto s = static_cast<float>(std::sin(pose.yaw_rad));
  const Eigen::Vector3f from = eye.p_body.cast<float>();
  const auto height_m = static_cast<float>(origin_height_m_ + eye.p_body.z());
  GrayImage image(width_, height_, kSky);
  for (size_t i = 0; i < image.data.size(); ++i) {
    const Eigen::Vector3f& ray = eye.rays_body[i];
    if (ray.z() > -0.02F) continue;
    const float along = height_m / -ray.z();
    const float forward = from.x() + along * ray.x();
    const float left = from.y() + along * ray.y();
    const float x_m = static_cast<float>(pose.x_m) + c * forward - s * left;
    const float y_m = static_cast<float>(pose.y_m) + s * forward + c * left;
    const float pixel_m = 2.0F * along / static_cast<float>(width_);
    const float grey = ground_grey(x_m, y_m, pixel_m) + kNoiseGrey * random_at(seed ^ (i << 1));
    image.data[i] = static_cast<std::uint8_t>(std::clamp(grey, 1.0F, 254.0F));
  }
  return image;
}

StereoPair PlaneCamera::expose(const rover::Pose2& pose, std::uint64_t frame) const {
  return {picture(left_, pose, mixed(2 * frame)), picture(right_, pose, mixed(2 * frame + 1)), kExposureS};
}

}  // namespace example
