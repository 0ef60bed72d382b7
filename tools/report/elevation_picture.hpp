// The ground that the Full level has mapped, in colours over the orbital map, with the tracks and the corrections.
#pragma once

#include <string>

#include "tools/report/scene.hpp"

namespace rover::report {

// An SVG document; empty where the run has no elevation map.
std::string draw_elevation(const Scene& scene);

}  // namespace rover::report
