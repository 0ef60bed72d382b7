// Takes the pictures of chosen exposures out of a log.
#pragma once

#include <optional>
#include <vector>

#include "common/bus/log_runs.hpp"
#include "tools/report/camera_picture.hpp"

namespace rover::report {

// One for each exposure, in their order: the rectified left image, else the raw one; empty where the log holds none of
// it, as a reduced one may.
std::vector<std::optional<CameraPicture>> read_camera_pictures(const LogRun& run,
                                                               const std::vector<double>& exposures_s);

}  // namespace rover::report
