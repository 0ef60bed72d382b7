// Edges of a picture, which two pictures of the same ground share under different light. The contrast of an edge
// depends on the light and its sign on where the sun is, so an edge is its direction modulo half a turn, with a weight
// from 0 to 1.
#pragma once

#include "global_localization/plane_field.hpp"

namespace rover::global {

// When the ground turns by an angle, edges turn by twice as much.
inline constexpr double kEdgeTurns = 2.0;

// (gx, gy) of the result: direction of the brightness gradient, with its angle doubled, times g^2 / (g^2 + median g^2).
PlaneField edge_field(PlaneField brightness);

}  // namespace rover::global
