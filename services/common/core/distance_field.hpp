// Exact Euclidean distance transform in two linear passes (Felzenszwalb and Huttenlocher, Theory of Computing 2012).
#pragma once

#include <cstdint>
#include <vector>

namespace rover {

// From each cell's centre to the nearest centre of a marked cell [m]; infinity if none is marked. Row-major.
std::vector<double> distance_field(const std::vector<std::uint8_t>& marked, int width, int height, double cell_m);

}  // namespace rover
