// Slope map in colour classes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/geo/shaded_relief.hpp"

namespace rover::report {

struct SlopeClass {
  double to_deg;  // upper limit; the last class has none
  const char* colour;
};
inline constexpr std::array<SlopeClass, 5> kSlopeClasses = {
    {{5.0, "#e8f1dc"}, {10.0, "#cfe09a"}, {15.0, "#f3cf5e"}, {20.0, "#ee8f3b"}, {90.0, "#d23b2f"}}};

std::vector<std::uint8_t> slope_jpeg(const HeightRaster& raster, const Box& box, int width_px, int height_px);

}  // namespace rover::report
