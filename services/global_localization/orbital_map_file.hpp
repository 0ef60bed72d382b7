// The orbital map of a run, and its orbital picture.
#pragma once

#include <optional>
#include <string>

#include "global_localization/orbital_map.hpp"

namespace rover::global {

// Opens orbital_map.tif in the run's folder; cells without data get weight 0. Throws DtmError with one line if the file
// is missing or has no metric georeference; reading a part does, if the file is damaged there.
OrbitalMap open_orbital_map(const std::string& run_dir);

// orbital_picture.tif, placed by its georeference; empty without the file. Throws like open_orbital_map.
std::optional<OrbitalMap> open_orbital_picture(const std::string& run_dir);

}  // namespace rover::global
