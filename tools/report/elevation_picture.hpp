// Elevation mapped at the Full level, in colour over the orbital map, with tracks and corrections.
#pragma once

#include <string>

#include "tools/report/scene.hpp"

namespace rover::report {

// SVG document; empty if the run has no elevation map.
std::string draw_elevation(const Scene& scene);

}  // namespace rover::report
