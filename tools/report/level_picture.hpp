// The level of autonomy along the track, why it changed, the effective speed and the hazards met.
#pragma once

#include <string>

#include "tools/report/scene.hpp"

namespace rover::report {

// An SVG document; empty where the run never was at the Full level and was not meant to be.
std::string draw_levels(const Scene& scene);
// "EFFICIENT to FULL: slow_progress, effective_speed_mps 0.05 against 0.06"
std::string switch_text(const LevelSwitch& change);

}  // namespace rover::report
