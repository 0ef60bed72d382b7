// Tracks the keyframe's points in a later pair: coarse in the left image, over the pyramid, from a predicted motion;
// then fine at full resolution in both images, with patches warped by the coarse motion and the ground's slope.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "visual_odometry/image_pyramid.hpp"
#include "visual_odometry/keyframe.hpp"

namespace rover::vo {

struct TrackerConfig {
  double min_score_coarse = 0.60;
  double min_score_fine = 0.75;
  double max_shift_coarse_px = 5.0;  // on each pyramid level
  int search_px = 8;                 // half side of the search window in the smallest image
  int search_points = 100;
  double max_shift_fine_px = 3.0;  // from the prediction by the coarse motion
  double max_row_offset_px = 1.5;  // vertical, between left and right
};

struct Track {
  bool left = false;
  bool right = false;
  Eigen::Vector3d z = Eigen::Vector3d::Zero();  // u, v in the left image, u in the right
};

// One track for each keyframe point. `search`: without a motion prediction, a subset of the points is first searched
// in a wide window of the smallest image.
std::vector<Track> track_coarse(const Keyframe& key, const ImagePyramid& left, const Eigen::Isometry3d& T_cur_key,
                                const TrackerConfig& config, bool search);
std::vector<Track> track_fine(const Keyframe& key, const ImagePyramid& left, const ImagePyramid& right,
                              const Eigen::Isometry3d& T_cur_key, const TrackerConfig& config);

}  // namespace rover::vo
