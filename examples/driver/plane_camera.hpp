// In place of a stereo camera: pictures of a level plane that is painted at random, by one ray a pixel. A real driver
// grabs frames here.
#pragma once

#include <vector>

#include "common/core/camera_rig.hpp"
#include "common/core/frames.hpp"
#include "common/core/image.hpp"

namespace example {

struct StereoPair {
  rover::GrayImage left;
  rover::GrayImage right;
  float exposure_s = 0.0F;
};

class PlaneCamera {
 public:
  // The raw pictures of this rig, distortion included. `origin_height_m`: of the body origin above the plane.
  PlaneCamera(const rover::StereoRig& rig, double origin_height_m);

  // What the rig sees from there. `frame` is the seed of the noise. Thread safe.
  StereoPair expose(const rover::Pose2& pose, std::uint64_t frame) const;

 private:
  struct Eye {
    Eigen::Vector3d p_body = Eigen::Vector3d::Zero();
    std::vector<Eigen::Vector3f> rays_body;  // one a pixel, of unit depth
  };
  Eye eye(const rover::PinholeCamera& camera, const Eigen::Isometry3d& T_body_cam) const;
  rover::GrayImage picture(const Eye& eye, const rover::Pose2& pose, std::uint64_t seed) const;

  int width_;
  int height_;
  double origin_height_m_;
  Eye left_;
  Eye right_;
};

}  // namespace example
