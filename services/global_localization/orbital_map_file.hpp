// Loads the orbital map of a run.
#pragma once

#include <string>

#include "global_localization/height_grid.hpp"

namespace rover::global {

// Reads orbital_map.tif from the run's folder; cells without data get weight 0.
// Throws DtmError with one line if the file is missing, has no metric georeference or no data.
HeightGrid load_orbital_map(const std::string& run_dir);

}  // namespace rover::global
