// Closest approach of the wheels to what a wheel may not climb.
#pragma once

#include "tools/report/rock_evaluation.hpp"

namespace rover::report {

// In plan view, from the boxes of the six wheels (at their steering angles) to the parts of rocks that rise 0.15 m or
// more over the ground; 0: a wheel was on one. NaN: none within 5 m, or the true surface is unknown.
double hazard_clearance_m(const RunRecord& run, const Window& window, const VehicleWheels& wheels,
                          double origin_height_m, const TrueWorld& world);

}  // namespace rover::report
