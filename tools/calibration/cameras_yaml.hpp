// Writes cameras.yaml with one camera's section replaced.
#pragma once

#include <string>

#include "tools/calibration/mount.hpp"
#include "tools/calibration/stereo_calibration.hpp"

namespace rover::calibration {

// File text: other cameras unchanged from `file`; the header names the source of the new values.
std::string cameras_yaml(const std::string& file, const std::string& camera, const StereoCalibration& calibration,
                         const Mount& mount, const std::string& source);

}  // namespace rover::calibration
