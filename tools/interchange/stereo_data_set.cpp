#include "tools/interchange/stereo_data_set.hpp"

#include <algorithm>
#include <filesystem>

#include "common/bus/config.hpp"
#include "common/bus/user_files.hpp"
#include "common/core/frames.hpp"

namespace rover::interchange {

namespace fs = std::filesystem;

Eigen::Isometry3d T_body_left_camera() {
  return make_pose(camera_rotation(0.0), Eigen::Vector3d::Zero());
}

void start_at_truth(StereoDataSet& set) {
  const auto begin = std::find_if(set.pairs.begin(), set.pairs.end(),
                                  [](const StereoPair& pair) { return pair.T_map_body.has_value(); });
  if (begin == set.pairs.end()) return;
  if (begin != set.pairs.begin())
    set.skipped["pairs before the ground truth begins"] = static_cast<int>(begin - set.pairs.begin());
  const Utime first_time = begin->since_first;
  set.pairs.erase(set.pairs.begin(), begin);
  for (StereoPair& pair : set.pairs) pair.since_first -= first_time;
  for (ImuReading& reading : set.imu) reading.since_first -= first_time;
  const auto first = set.pairs.front().T_map_body;
  const Eigen::Matrix3d R_level = rotation_from_rpy(0.0, 0.0, yaw_of(*first));
  const Eigen::Isometry3d T_body_level = make_pose(first->linear().transpose() * R_level, Eigen::Vector3d::Zero());
  set.rig.T_body_left = T_body_level.inverse() * set.rig.T_body_left;
  for (StereoPair& pair : set.pairs)
    if (pair.T_map_body) pair.T_map_body = *pair.T_map_body * T_body_level;
  const Eigen::Matrix3d R_level_body = T_body_level.linear().transpose();
  for (ImuReading& reading : set.imu) {
    reading.rate_radps = R_level_body * reading.rate_radps;
    reading.force_mps2 = R_level_body * reading.force_mps2;
  }
}

namespace {

[[noreturn]] void fail_unknown(const fs::path& root) {
  const char* kittis = "KITTI's odometry layout (calib.txt, image_0, image_1)";
  for (const char* name : {"image_00", "image_02", "calib_cam_to_cam.txt"})
    if (fs::exists(root / name))
      throw ConfigError(root.string() + ": KITTI's raw layout (" + name + "), which is not read; " + kittis +
                        " is expected");
  throw ConfigError(root.string() + ": neither " + kittis + " nor EuRoC's (mav0/cam0, cam1)");
}

std::string counts(const StereoDataSet& set) {
  std::string text;
  for (const auto& [what, count] : set.skipped)
    if (count > 0) text += (text.empty() ? "; skipped: " : ", ") + std::to_string(count) + " " + what;
  return text;
}

StereoDataSet read_layout(const fs::path& root, const std::string& poses, double rate_hz) {
  try {
    if (fs::exists(root / "calib.txt")) return read_kitti(root.string(), poses, rate_hz);
    if (fs::exists(root / "mav0") || fs::exists(root / "cam0")) return read_euroc(root.string());
  } catch (const fs::filesystem_error& failure) {  // name too long, or no permission
    throw ConfigError(failure.path1().string() + ": " + failure.code().message());
  }
  fail_unknown(root);
}

}  // namespace

StereoDataSet read_stereo_data_set(const std::string& dir, const std::string& poses, double rate_hz) {
  const fs::path root(dir);
  if (const std::string problem = folder_problem(dir); !problem.empty()) throw ConfigError(dir + ": " + problem);
  StereoDataSet set = read_layout(root, poses, rate_hz);
  start_at_truth(set);
  if (set.pairs.size() < 2)
    throw ConfigError(dir + ": no sequence of stereo pairs: " + std::to_string(set.pairs.size()) +
                      (set.pairs.size() == 1 ? " pair" : " pairs") + counts(set));
  return set;
}

}  // namespace rover::interchange
