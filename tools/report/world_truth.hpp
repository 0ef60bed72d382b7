// The true ground of a simulated run, made again from its scenario and seed.
#pragma once

#include <optional>
#include <string>

#include "common/geo/shaded_relief.hpp"
#include "tools/report/run_folder.hpp"

namespace rover::report {

// Empty where the folder has no scenario or no seed: a log of a real vehicle. Rocks within `around`.
std::optional<TrueWorld> load_true_world(const RunFolder& folder, const Box& around);

// Empty where the folder has no orbital map, or none with a georeference (a synthetic plane).
HeightRaster load_orbital_map(const RunFolder& folder);

}  // namespace rover::report
