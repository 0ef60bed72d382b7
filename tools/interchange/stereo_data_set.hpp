// A recorded stereo sequence of other projects: pictures, calibration, ground truth.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/core/camera_rig.hpp"
#include "common/core/time.hpp"

namespace rover::interchange {

struct StereoPair {
  Utime since_first = 0;
  std::string left;  // files
  std::string right;
  std::optional<Eigen::Isometry3d> T_map_body;  // ground truth; body: where the left camera is
};

struct StereoDataSet {
  std::string layout;  // "KITTI", "EuRoC"
  std::string name;
  StereoRig rig;  // width and height 0 where the calibration does not tell
  std::vector<StereoPair> pairs;
  std::map<std::string, int> left_out;  // what, and how many
  std::vector<std::string> notes;       // what else the user should know
};

inline constexpr const char* kWithoutPartner = "pictures without a partner";
inline constexpr const char* kNoNumbers = "rows of the ground truth that are not a number";

// A rover's axes at the left camera: x where it looks, y left, z up in the picture.
Eigen::Isometry3d T_body_left_camera();
// Lets the drive begin at the first pair with ground truth, where there is any: its place is where the rover starts.
// Turns the body so that it is level there, as a rover's is: the camera is mounted with what is left. Ground truth has
// to have its z up, or to begin level.
void begin_at_truth(StereoDataSet& set);

// KITTI odometry: image_0, image_1 (or image_l, image_r), calib.txt, and where there are times.txt and poses.txt, whose
// rows are those of the pictures' numbers.
// `poses`: the file with the poses, empty: poses.txt in the folder. `rate_hz` counts where there is no times.txt.
StereoDataSet read_kitti(const std::string& dir, const std::string& poses, double rate_hz);
// EuRoC MAV: cam0, cam1, state_groundtruth_estimate0, each with data.csv and sensor.yaml; in the folder or its mav0.
StereoDataSet read_euroc(const std::string& dir);
// Looks at the folder. All of these throw ConfigError with one line. Nothing but text and names is read, no picture.
StereoDataSet read_stereo_data_set(const std::string& dir, const std::string& poses, double rate_hz);

}  // namespace rover::interchange
