// Reads config/vehicle.yaml and config/cameras.yaml.
#pragma once

#include <string>

#include "common/bus/config.hpp"
#include "common/core/camera_rig.hpp"
#include "common/core/vehicle.hpp"

namespace rover {

Vehicle load_vehicle(const std::string& config_dir);
// `camera`: "loccam" or "navcam".
StereoRig load_stereo_rig(const std::string& config_dir, const std::string& camera);
// The same of what is in cameras.yaml.
StereoRig read_stereo_rig(const Config& config, const std::string& camera);

// As cameras.yaml has it: "radtan", "equidistant".
const char* name_of(DistortionModel model);
// What cannot be, wherever the calibration is from: baseline in other units, left and right exchanged. Empty: nothing.
std::string problem_of_pair(const Eigen::Isometry3d& T_left_right);

}  // namespace rover
