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

}  // namespace rover
