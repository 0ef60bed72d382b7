// True terrain of a simulated run, regenerated from its scenario and seed.
#pragma once

#include <optional>
#include <string>

#include "common/geo/shaded_relief.hpp"
#include "tools/report/run_folder.hpp"

namespace rover::report {

// Empty without scenario or seed (real vehicle). Rocks within `around`.
std::optional<TrueWorld> load_true_world(const RunFolder& folder, const Box& around);

// Empty without an orbital map, or if it has no georeference (synthetic plane).
HeightRaster load_orbital_map(const RunFolder& folder);

}  // namespace rover::report
