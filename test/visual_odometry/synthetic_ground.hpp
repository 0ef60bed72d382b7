// Synthetic stereo images of textured ground with blocks, from any body pose: seeded noise textures, warped by the
// homography of each plane.
#pragma once

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

#include "common/core/frames.hpp"
#include "common/core/image.hpp"
#include "visual_odometry/odometry.hpp"

namespace rover::vo {

inline StereoCamera loccam() {
  StereoCamera camera;
  camera.width = 512;
  camera.height = 384;
  camera.focal_px = 417.5;
  camera.cx_px = 256.0;
  camera.cy_px = 192.0;
  camera.baseline_m = 0.12;
  camera.T_body_cam = make_pose(camera_rotation(to_rad(33.0)), {0.527, 0.074, 0.059});
  return camera;
}

// Horizontal textured square. The first one is the ground, z = 0, whose texture repeats without end.
struct Plane {
  double z_m = 0.0;
  double x_m = 0.0;  // smallest corner
  double y_m = 0.0;
  double size_m = 0.0;
  cv::Mat texture;  // square, over the whole plane
};

class SyntheticGround {
 public:
  double noise_grey = 1.0;  // standard deviation
  double gain = 1.0;        // exposure
  double blur_px = 0.0;
  bool textureless = false;
  // Errors of the calibration of the right camera: horizontal offset, roll, ratio of focal lengths.
  double right_shift_px = 0.0;
  double right_roll_rad = 0.0;
  double right_focal_ratio = 1.0;
  StereoCamera camera = loccam();

  explicit SyntheticGround(std::uint64_t seed, bool rocks = true) : random_(seed), rng_(seed + 1) {
    planes_.push_back(make_plane(0.0, 0.0, 0.0, 4.0, 800));
    if (!rocks) return;
    std::uniform_real_distribution<double> place(-7.0, 7.0);
    for (int i = 0; i < 60; ++i)
      planes_.push_back(make_plane(0.05 + 0.1 * (i % 3), 4.0 + place(random_), place(random_), 0.25, 50));
  }

  // Body pose with the origin 0.62 m above the ground.
  static Eigen::Isometry3d over_ground(double x, double y, double yaw, double roll = 0.0, double pitch = 0.0) {
    return make_pose(rotation_from_rpy(roll, pitch, yaw), {x, y, 0.62});
  }

  StereoFrame frame(Utime utime, const Eigen::Isometry3d& T_world_body) {
    StereoFrame f;
    f.utime = utime;
    f.camera = camera;
    const Eigen::Isometry3d T_world_left = T_world_body * camera.T_body_cam;
    Eigen::Isometry3d T_world_right = T_world_left;
    T_world_right.translation() += T_world_left.linear().col(0) * camera.baseline_m;
    f.left = render(T_world_left);
    T_world_right.linear() *= exp_so3(Eigen::Vector3d(0.0, 0.0, right_roll_rad));
    const StereoCamera calibrated = camera;
    camera.cx_px += right_shift_px;
    camera.focal_px *= right_focal_ratio;
    f.right = render(T_world_right);
    camera = calibrated;
    return f;
  }

  // Disparity of the bare ground.
  Disparity ground_disparity(const Eigen::Isometry3d& T_world_body) const {
    Disparity d(camera.width, camera.height);
    const Eigen::Isometry3d T = T_world_body * camera.T_body_cam;
    for (int v = 0; v < camera.height; ++v)
      for (int u = 0; u < camera.width; ++u) {
        const Eigen::Vector3d ray = T.linear() * Eigen::Vector3d((u - camera.cx_px) / camera.focal_px,
                                                                 (v - camera.cy_px) / camera.focal_px, 1.0);
        if (ray.z() >= -0.05) continue;
        const double depth = -T.translation().z() / ray.z();
        d.at(u, v) = static_cast<std::int16_t>(std::lround(16.0 * camera.focal_px * camera.baseline_m / depth));
      }
    return d;
  }

 private:
  Plane make_plane(double z, double x, double y, double size, int texels) {
    cv::Mat texture(texels, texels, CV_8UC1, cv::Scalar(0));
    cv::Mat sum(texels, texels, CV_32FC1, cv::Scalar(110.0));
    for (int step = 1; step <= 16 && step < texels / 2; step *= 2) {
      cv::Mat layer(texels / step, texels / step, CV_32FC1);
      rng_.fill(layer, cv::RNG::NORMAL, 0.0, 12.0);
      cv::Mat large;
      cv::resize(layer, large, sum.size(), 0, 0, cv::INTER_CUBIC);
      sum += large;
    }
    sum.convertTo(texture, CV_8UC1);
    return {z, x, y, size, texture};
  }

  // From texture pixels of the plane to image pixels.
  cv::Matx33d homography(const Plane& plane, const Eigen::Isometry3d& T_world_cam) const {
    const Eigen::Isometry3d T_cam_world = T_world_cam.inverse();
    const double metre = plane.size_m / plane.texture.cols;
    Eigen::Matrix3d world_from_texture;
    world_from_texture << metre, 0, plane.x_m, 0, metre, plane.y_m, 0, 0, plane.z_m;
    Eigen::Matrix3d P = T_cam_world.linear() * world_from_texture;
    P.col(2) += T_cam_world.translation();
    Eigen::Matrix3d K;
    K << camera.focal_px, 0, camera.cx_px, 0, camera.focal_px, camera.cy_px, 0, 0, 1;
    const Eigen::Matrix3d H = K * P;
    return {H(0, 0), H(0, 1), H(0, 2), H(1, 0), H(1, 1), H(1, 2), H(2, 0), H(2, 1), H(2, 2)};
  }

  void draw_block(const Plane& plane, const Eigen::Isometry3d& T_world_cam, cv::Mat& view) const {
    std::vector<cv::Point2f> corners;
    for (const auto& [dx, dy] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {1.0, 1.0}}) {
      const Eigen::Vector3d p = T_world_cam.inverse() * Eigen::Vector3d(plane.x_m + dx * plane.size_m,
                                                                        plane.y_m + dy * plane.size_m, plane.z_m);
      if (p.z() < 0.2) return;
      corners.emplace_back(static_cast<float>(camera.cx_px + camera.focal_px * p.x() / p.z()),
                           static_cast<float>(camera.cy_px + camera.focal_px * p.y() / p.z()));
    }
    const cv::Rect box = cv::boundingRect(corners) & cv::Rect(0, 0, view.cols, view.rows);
    if (box.empty()) return;
    const cv::Matx33d shift(1, 0, -box.x, 0, 1, -box.y, 0, 0, 1);
    cv::Mat part = view(box);
    cv::warpPerspective(plane.texture, part, shift * homography(plane, T_world_cam), box.size(), cv::INTER_LINEAR,
                        cv::BORDER_TRANSPARENT);
  }

  GrayImage render(const Eigen::Isometry3d& T_world_cam) {
    cv::Mat view(camera.height, camera.width, CV_8UC1, cv::Scalar(110));
    if (!textureless) {
      cv::warpPerspective(planes_[0].texture, view, homography(planes_[0], T_world_cam), view.size(), cv::INTER_LINEAR,
                          cv::BORDER_WRAP);
      for (size_t i = 1; i < planes_.size(); ++i) draw_block(planes_[i], T_world_cam, view);
    }
    cv::Mat value;
    view.convertTo(value, CV_32FC1, gain);
    cv::GaussianBlur(value, value, {}, 0.6 + blur_px);
    cv::Mat noise(value.size(), CV_32FC1);
    rng_.fill(noise, cv::RNG::NORMAL, 0.0, noise_grey);
    value += noise;
    cv::Mat grey;
    value.convertTo(grey, CV_8UC1);
    GrayImage image(camera.width, camera.height);
    for (int y = 0; y < grey.rows; ++y)
      std::copy_n(grey.ptr<std::uint8_t>(y), grey.cols, &image.data[static_cast<size_t>(y) * grey.cols]);
    return image;
  }

  std::mt19937_64 random_;
  cv::RNG rng_;
  std::vector<Plane> planes_;
};

}  // namespace rover::vo
