// Stereo sequence of another project: images, calibration, ground truth.
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
  std::string left;  // file names
  std::string right;
  std::optional<Eigen::Isometry3d> T_map_body;  // ground truth; body origin: left camera
};

// In body axes; the sample holds from the one before it on.
struct ImuReading {
  Utime since_first = 0;  // negative before the first pair
  Eigen::Vector3d rate_radps;
  Eigen::Vector3d force_mps2;  // specific force
};

struct StereoDataSet {
  std::string layout;  // "KITTI", "EuRoC"
  std::string name;
  StereoRig rig;  // width and height 0 if not in the calibration
  std::vector<StereoPair> pairs;
  std::vector<ImuReading> imu;         // empty: none
  std::map<std::string, int> skipped;  // reason and count
  std::vector<std::string> notes;      // further information for the user
};

inline constexpr const char* kWithoutPartner = "pictures without a partner";
inline constexpr const char* kNoNumbers = "rows of the ground truth that are not a number";

// Body axes at the left camera: x along the optical axis, y left, z up in the image.
Eigen::Isometry3d T_body_left_camera();
// Starts at the first pair with ground truth and makes the body level there, by a camera mount. Truth must have z up or
// start level.
void start_at_truth(StereoDataSet& set);

// KITTI odometry: image_0, image_1 (or image_l, image_r), calib.txt, times.txt (else `rate_hz`), `poses` (default:
// poses.txt, or poses/NN.txt beside the folder sequences).
StereoDataSet read_kitti(const std::string& dir, const std::string& poses, double rate_hz);
// EuRoC MAV: cam0, cam1, state_groundtruth_estimate0, imu0, each with data.csv and sensor.yaml; in the folder or in
// mav0.
StereoDataSet read_euroc(const std::string& dir);
// Detects the layout. All of these throw ConfigError. Reads text and file names only, no images.
StereoDataSet read_stereo_data_set(const std::string& dir, const std::string& poses, double rate_hz);

}  // namespace rover::interchange
