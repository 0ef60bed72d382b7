// Edges of a picture: the direction of the brightness gradient modulo half a turn, with a weight from 0 to 1. Under
// another sun their contrast and sign change, their directions remain.
#pragma once

#include "global_localization/plane_field.hpp"

namespace rover::global {

// When the ground turns by an angle, edges turn by twice as much.
inline constexpr double kEdgeTurns = 2.0;

// (gx, gy) of the result: direction of the brightness gradient, with its angle doubled, times g^2 / (g^2 + median g^2).
PlaneField edge_field(PlaneField brightness);

}  // namespace rover::global
