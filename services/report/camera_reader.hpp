// Takes the pictures of chosen exposures out of a log.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/camera_picture.hpp"

namespace rover::report {

// One for each exposure, in their order: the rectified left image, else the raw one; empty where the log holds none of
// it, as a reduced one may.
std::vector<std::optional<CameraPicture>> read_camera_pictures(const std::string& log,
                                                               const std::vector<double>& exposures_s);

}  // namespace rover::report
