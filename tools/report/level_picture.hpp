// Level of autonomy along the track, reasons of its changes, effective speed and hazards.
#pragma once

#include <string>

#include "tools/report/scene.hpp"

namespace rover::report {

// SVG document; empty if the run never used nor requested the Full level.
std::string draw_levels(const Scene& scene);
// "EFFICIENT to FULL: slow_progress, effective_speed_mps 0.05, threshold 0.06"
std::string switch_text(const LevelSwitch& change);

}  // namespace rover::report
