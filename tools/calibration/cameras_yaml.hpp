// cameras.yaml with one camera's section made anew.
#pragma once

#include <string>

#include "tools/calibration/mount.hpp"
#include "tools/calibration/stereo_calibration.hpp"

namespace rover::calibration {

// The text of the file, other cameras as they stand in `file`; a header says where the new figures are from.
std::string cameras_yaml(const std::string& file, const std::string& camera, const StereoCalibration& calibration,
                         const Mount& mount, const std::string& source);

}  // namespace rover::calibration
