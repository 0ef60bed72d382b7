// OpenCV's stereo matcher on rendered pairs, against the ray-traced ranges.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "camera_test_world.hpp"
#include "rover_simulator/camera/stereo_camera_sim.hpp"

namespace rover {
namespace {

cv::Matx33d matrix_of(const PinholeCamera& camera) {
  return {camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1};
}

cv::Mat view_of(GrayImage& image) {
  return {image.height, image.width, CV_8U, image.data.data()};
}

struct Rectified {
  cv::Mat left, right;
  Eigen::Matrix3d R_rect_left;
  double focal_px, cx_px, cy_px, baseline_m;
};

Rectified rectify(const StereoRig& rig, StereoCameraSim::Pair& pair) {
  const Eigen::Isometry3d T_right_left = rig.T_left_right.inverse();
  cv::Matx33d R;
  cv::Vec3d t;
  for (int i = 0; i < 3; ++i) {
    t[i] = T_right_left.translation()[i];
    for (int j = 0; j < 3; ++j) R(i, j) = T_right_left.linear()(i, j);
  }
  cv::Matx33d R1, R2;
  cv::Matx34d P1, P2;
  cv::Mat Q;
  const cv::Size size(rig.width, rig.height);
  cv::stereoRectify(matrix_of(rig.left), rig.left.distortion, matrix_of(rig.right), rig.right.distortion, size, R, t,
                    R1, R2, P1, P2, Q, cv::CALIB_ZERO_DISPARITY, 0);
  Rectified out;
  cv::Mat map_x, map_y;
  cv::initUndistortRectifyMap(matrix_of(rig.left), rig.left.distortion, R1, P1, size, CV_32F, map_x, map_y);
  cv::remap(view_of(pair.left), out.left, map_x, map_y, cv::INTER_LINEAR);
  cv::initUndistortRectifyMap(matrix_of(rig.right), rig.right.distortion, R2, P2, size, CV_32F, map_x, map_y);
  cv::remap(view_of(pair.right), out.right, map_x, map_y, cv::INTER_LINEAR);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out.R_rect_left(i, j) = R1(i, j);
  out.focal_px = P1(0, 0);
  out.cx_px = P1(0, 2);
  out.cy_px = P1(1, 2);
  out.baseline_m = -P2(0, 3) / P2(0, 0);
  return out;
}

struct StereoScore {
  double dense = 0.0;
  double median_error_px = 0.0;
  double bias_px = 0.0;
};

StereoScore score(StereoCameraSim& camera, const Eigen::Isometry3d& T_map_body) {
  const StereoRig& rig = camera.true_rig();
  StereoCameraSim::Pair pair = camera.render(T_map_body, 0);
  const std::vector<float> ranges = camera.left_ranges_m(T_map_body * rig.T_body_left);
  const Rectified rectified = rectify(rig, pair);
  cv::Mat disparity;
  cv::StereoSGBM::create(0, 96, 7, 8 * 49, 32 * 49, 1, 63, 10, 100, 2, cv::StereoSGBM::MODE_SGBM)
      ->compute(rectified.left, rectified.right, disparity);
  std::vector<double> errors;
  double sum = 0.0;
  int count = 0;
  for (int v = 20; v < 364; v += 2) {
    for (int u = 110; u < 500; u += 2) {
      const Eigen::Vector3d p =
          rectified.R_rect_left * (ray_of_pixel(rig.left, {u, v}).normalized() * ranges[v * 512 + u]);
      const int ru = static_cast<int>(std::lround(rectified.focal_px * p.x() / p.z() + rectified.cx_px));
      const int rv = static_cast<int>(std::lround(rectified.focal_px * p.y() / p.z() + rectified.cy_px));
      if (ru < 100 || rv < 8 || ru >= 504 || rv >= 376) continue;
      ++count;
      const std::int16_t found = disparity.at<std::int16_t>(rv, ru);
      if (found <= 0) continue;
      const double error = found / 16.0 - rectified.focal_px * rectified.baseline_m / p.z();
      errors.push_back(std::abs(error));
      if (std::abs(error) < 1.0) sum += error;
    }
  }
  StereoScore result;
  result.dense = static_cast<double>(errors.size()) / count;
  result.bias_px = sum / static_cast<double>(errors.size());
  std::nth_element(errors.begin(), errors.begin() + static_cast<long>(errors.size() / 2), errors.end());
  result.median_error_px = errors[errors.size() / 2];
  return result;
}

TEST(StereoOnRenderedImages, IsDenseAndAccurateOnNormalGround) {
  cv::setNumThreads(1);
  const test::RockySurface surface;
  for (double elevation_deg : {15.0, 35.0, 60.0}) {
    CameraSimConfig config;
    config.scene = test::small_scene();
    config.calibration_error_px = 0.0;
    config.scene.appearance.textureless_fraction = 0.0;
    config.scene.appearance.sun_elevation_rad = to_rad(elevation_deg);
    StereoCameraSim camera(test::loccam_rig(), config, surface, 1);
    const StereoScore found = score(camera, test::body_at(surface, 50.0, 60.0, 0.5));
    EXPECT_GT(found.dense, 0.9) << elevation_deg;
    EXPECT_LT(found.median_error_px, 0.25) << elevation_deg;
    EXPECT_LT(std::abs(found.bias_px), 0.1) << elevation_deg;
    RecordProperty("sun_" + std::to_string(static_cast<int>(elevation_deg)),
                   std::to_string(found.dense) + " dense, median error " + std::to_string(found.median_error_px) +
                       " px, bias " + std::to_string(found.bias_px) + " px");
  }
}

double bilinear(const GrayImage& image, const Eigen::Vector2d& at) {
  const int u = static_cast<int>(at.x());
  const int v = static_cast<int>(at.y());
  const double fu = at.x() - u;
  const double fv = at.y() - v;
  return (1 - fv) * ((1 - fu) * image.at(u, v) + fu * image.at(u + 1, v)) +
         fv * ((1 - fu) * image.at(u, v + 1) + fu * image.at(u + 1, v + 1));
}

TEST(StereoOnRenderedImages, TextureIsFixedToGroundBetweenFrames) {
  const test::RockySurface surface;
  CameraSimConfig config;
  config.scene = test::small_scene();
  config.calibration_error_px = 0.0;
  config.imager.full_well_e = 1e12;
  config.imager.read_noise_e = 0.0;
  config.imager.vignetting = 0.0;
  config.imager.exposure_gain = 0.0;
  StereoCameraSim camera(test::loccam_rig(), config, surface, 1);
  const StereoRig& rig = camera.true_rig();
  const Eigen::Isometry3d T_map_a = test::body_at(surface, 50.0, 60.0, 0.5) * rig.T_body_left;
  const Eigen::Isometry3d T_map_b = test::body_at(surface, 50.03, 60.05, 0.52) * rig.T_body_left;
  const StereoCameraSim::Pair a = camera.render_from(T_map_a, 0);
  const StereoCameraSim::Pair b = camera.render_from(T_map_b, 1);
  const std::vector<float> ranges = camera.left_ranges_m(T_map_a);
  double ab = 0.0, aa = 0.0, bb = 0.0, sum_a = 0.0, sum_b = 0.0, n = 0.0;
  for (int v = 100; v < 380; v += 3) {
    for (int u = 60; u < 450; u += 3) {
      const Eigen::Vector3d p =
          T_map_a * Eigen::Vector3d(ray_of_pixel(rig.left, {u, v}).normalized() * ranges[v * 512 + u]);
      const Eigen::Vector2d at = project(rig.left, T_map_b.inverse() * p);
      if (at.x() < 1 || at.y() < 1 || at.x() > 509 || at.y() > 381) continue;
      const double there = bilinear(b.left, at);
      const double here = a.left.at(u, v);
      ab += here * there, aa += here * here, bb += there * there, sum_a += here, sum_b += there, n += 1.0;
    }
  }
  const double correlation = (ab - sum_a * sum_b / n) / std::sqrt((aa - sum_a * sum_a / n) * (bb - sum_b * sum_b / n));
  EXPECT_GT(correlation, 0.9);
}

// Mean squared difference between left and right image at the projected points of an area of the left image, displaced
// by `shift`.
double mismatch(StereoCameraSim& camera, const StereoCameraSim::Pair& pair, const std::vector<float>& ranges,
                const cv::Rect& area, const Eigen::Vector2d& shift) {
  const StereoRig& rig = camera.true_rig();
  const Eigen::Isometry3d T_right_left = rig.T_left_right.inverse();
  double sum = 0.0;
  int count = 0;
  for (int v = area.y; v < area.br().y; v += 2) {
    for (int u = area.x; u < area.br().x; u += 2) {
      const Eigen::Vector3d p = ray_of_pixel(rig.left, {u, v}).normalized() * ranges[v * rig.width + u];
      const Eigen::Vector2d at = project(rig.right, T_right_left * p) + shift;
      if (at.x() < 1 || at.y() < 1 || at.x() > rig.width - 3 || at.y() > rig.height - 3) continue;
      const double difference = bilinear(pair.right, at) - pair.left.at(u, v);
      if (std::abs(difference) > 25.0) continue;  // hidden from one of the cameras
      sum += difference * difference;
      ++count;
    }
  }
  return sum / count;
}

// Where along an image axis the mismatch has its minimum: 0 if the images match the geometry.
double displacement_px(StereoCameraSim& camera, const StereoCameraSim::Pair& pair, const std::vector<float>& ranges,
                       const cv::Rect& area, int axis) {
  const Eigen::Vector2d step = 0.3 * Eigen::Vector2d::Unit(axis);
  const double here = mismatch(camera, pair, ranges, area, Eigen::Vector2d::Zero());
  const double before = mismatch(camera, pair, ranges, area, -step);
  const double after = mismatch(camera, pair, ranges, area, step);
  EXPECT_GT(std::min(before, after), here);
  return 0.5 * 0.3 * (before - after) / (before - 2.0 * here + after);
}

TEST(StereoOnRenderedImages, ImagesMatchGeometryWithinHundredthsOfPixel) {
  const test::RockySurface surface;
  CameraSimConfig config;
  config.scene = test::small_scene();
  StereoCameraSim camera(test::loccam_rig(), config, surface, 3);
  const Eigen::Isometry3d T_map_body = test::body_at(surface, 50.0, 60.0, 0.5);
  const StereoCameraSim::Pair pair = camera.render(T_map_body, 0);
  const std::vector<float> ranges = camera.left_ranges_m(T_map_body * camera.true_rig().T_body_left);
  for (int axis = 0; axis < 2; ++axis)
    EXPECT_LT(std::abs(displacement_px(camera, pair, ranges, {120, 20, 370, 344}, axis)), 0.03) << axis;
}

// Ground 6 to 20 m away, seen at a grazing angle: texture that the pixels do not resolve must not alias, because its
// phase differs between the two images.
TEST(StereoOnRenderedImages, GrazingGroundMatchesGeometryToo) {
  const test::PlaneSurface surface;
  StereoCameraSim camera(test::navcam_rig(), {}, surface, 1);
  for (const cv::Rect& area : {cv::Rect(60, 50, 180, 80), cv::Rect(230, 50, 180, 80), cv::Rect(400, 50, 180, 80)}) {
    double sum_px = 0.0;
    constexpr int kPoses = 6;
    for (int i = 0; i < kPoses; ++i) {
      const Eigen::Isometry3d T_map_body = test::body_at(surface, 3.0 * i, 0.0, 0.25 * i);
      const StereoCameraSim::Pair pair = camera.render(T_map_body, i);
      const std::vector<float> ranges = camera.left_ranges_m(T_map_body * camera.true_rig().T_body_left);
      sum_px += displacement_px(camera, pair, ranges, area, 0);
    }
    EXPECT_LT(std::abs(sum_px / kPoses), 0.1) << area;
    RecordProperty("bias_px_" + std::to_string(area.x), std::to_string(sum_px / kPoses));
  }
}

}  // namespace
}  // namespace rover
