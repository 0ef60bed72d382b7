// Renders grids as PNG with alpha channel. Image row 0 is the largest y.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rover::mission {

using Png = std::vector<std::uint8_t>;

// Cells of hazards_t; unseen cells are transparent.
Png hazards_png(const std::vector<std::uint8_t>& cells, int cells_x, int cells_y);
// Costs of traversability_t, green to red.
Png traversability_png(const std::vector<std::uint8_t>& costs, int cells_x, int cells_y);
// Heights from the lowest (dark) to the highest (light), shaded by their slope; NaN is transparent.
Png elevation_png(const std::vector<float>& heights_m, int cells_x, int cells_y, double cell_m);

}  // namespace rover::mission
