// Reads the images of given exposures from a log.
#pragma once

#include <optional>
#include <vector>

#include "common/bus/log_runs.hpp"
#include "tools/report/camera_picture.hpp"

namespace rover::report {

// One per exposure, in order: the rectified left image, else the raw one; empty if not in the log (e.g. a reduced log).
std::vector<std::optional<CameraPicture>> read_camera_pictures(const LogRun& run,
                                                               const std::vector<double>& exposures_s);

}  // namespace rover::report
