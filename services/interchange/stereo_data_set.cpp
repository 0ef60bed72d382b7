#include "interchange/stereo_data_set.hpp"

#include <filesystem>

#include "common/bus/config.hpp"
#include "common/core/frames.hpp"

namespace rover::interchange {

namespace fs = std::filesystem;

Eigen::Isometry3d T_body_left_camera() {
  return make_pose(camera_rotation(0.0), Eigen::Vector3d::Zero());
}

void level_body(StereoDataSet& set) {
  const auto& first = set.pairs.front().T_map_body;
  if (!first) return;
  const Eigen::Matrix3d R_level = rotation_from_rpy(0.0, 0.0, yaw_of(*first));
  const Eigen::Isometry3d T_body_level = make_pose(first->linear().transpose() * R_level, Eigen::Vector3d::Zero());
  set.rig.T_body_left = T_body_level.inverse() * set.rig.T_body_left;
  for (StereoPair& pair : set.pairs)
    if (pair.T_map_body) pair.T_map_body = *pair.T_map_body * T_body_level;
}

StereoDataSet read_stereo_data_set(const std::string& dir, const std::string& poses, double rate_hz) {
  const fs::path root(dir);
  if (!fs::is_directory(root)) throw ConfigError(dir + ": no such folder");
  StereoDataSet set;
  if (fs::exists(root / "calib.txt"))
    set = read_kitti(dir, poses, rate_hz);
  else if (fs::exists(root / "mav0") || fs::exists(root / "cam0"))
    set = read_euroc(dir);
  else
    throw ConfigError(dir + ": neither KITTI's layout (calib.txt, image_0, image_1) nor EuRoC's (mav0/cam0, cam1)");
  if (set.pairs.size() < 2) throw ConfigError(dir + ": holds no sequence of stereo pairs");
  level_body(set);
  return set;
}

}  // namespace rover::interchange
