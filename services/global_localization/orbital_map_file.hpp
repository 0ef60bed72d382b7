// The orbital map of a run as the core takes it.
#pragma once

#include <string>

#include "global_localization/height_grid.hpp"

namespace rover::global {

// From the run's folder, where mission_control and the report find it too. Cells without data weigh nothing. Throws
// DtmError with one line: no map, none with georeference in metres, nothing on it.
HeightGrid load_orbital_map(const std::string& run_dir);

}  // namespace rover::global
