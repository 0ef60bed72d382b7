// Horizon mapping (Max 1988) for the sun's azimuth.
#include "rover_simulator/camera/sun_horizon.hpp"

#include <algorithm>
#include <cmath>

namespace rover {
namespace {

constexpr float kMargin = 0.2F;  // larger margins do not affect shading, so the march stops there

// Heights of the tile and its neighbours towards the sun, mirrored so that the sun is at positive i and j.
struct Patch {
  int cells = 0;
  int side = 0;
  float highest = 0.0F;
  std::vector<float> height;

  float between(float i, float j) const {
    const int i0 = static_cast<int>(i);
    const int j0 = static_cast<int>(j);
    const float fi = i - static_cast<float>(i0);
    const float fj = j - static_cast<float>(j0);
    const float* a = &height[static_cast<size_t>(j0) * side + i0];
    const float* b = a + side;
    const float low = a[0] + fi * (a[1] - a[0]);
    return low + fj * (b[0] + fi * (b[1] - b[0]) - low);
  }
};

Patch assemble(const GroundTile::Heights& heights, const Eigen::Vector2i& side) {
  Patch patch;
  patch.cells = kLevels[heights.self->key.level].cells;
  patch.side = 2 * patch.cells + 1;
  patch.height.resize(static_cast<size_t>(patch.side) * patch.side);
  for (int j = 0; j < patch.side; ++j) {
    for (int i = 0; i < patch.side; ++i) {
      const bool over_x = i > patch.cells;
      const bool over_y = j > patch.cells;
      const HeightTile& tile =
          over_x ? (over_y ? *heights.next_xy : *heights.next_x) : (over_y ? *heights.next_y : *heights.self);
      const int a = over_x ? i - patch.cells : i;
      const int b = over_y ? j - patch.cells : j;
      const float value = tile.at(side.x() > 0 ? a : patch.cells - a, side.y() > 0 ? b : patch.cells - b);
      patch.height[static_cast<size_t>(j) * patch.side + i] =
          value + static_cast<float>(tile.base_m - heights.self->base_m);
    }
  }
  patch.highest = *std::max_element(patch.height.begin(), patch.height.end());
  return patch;
}

// March distances in cells, with increasing step size.
std::vector<float> march_distances(int cells) {
  std::vector<float> distances;
  for (float s = 1.0F; s < static_cast<float>(cells); s += std::max(1.0F, 0.04F * s)) distances.push_back(s);
  return distances;
}

}  // namespace

std::vector<float> sun_margins(const GroundTile::Heights& heights, const GroundAppearanceConfig& sun) {
  const Eigen::Vector2i side = sun_side(sun);
  const Patch patch = assemble(heights, side);
  const std::vector<float> distances = march_distances(patch.cells);
  const auto di = static_cast<float>(std::abs(std::cos(sun.sun_azimuth_rad)));
  const auto dj = static_cast<float>(std::abs(std::sin(sun.sun_azimuth_rad)));
  const auto tangent = static_cast<float>(std::tan(sun.sun_elevation_rad));
  const auto spacing = static_cast<float>(kLevels[heights.self->key.level].spacing_m);
  const int n = patch.cells + 1;
  std::vector<float> margins(static_cast<size_t>(n) * n);
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const float z = patch.height[static_cast<size_t>(j) * patch.side + i];
      float horizon = -1.0F;
      for (float s : distances) {
        const float run = s * spacing;
        if (z + run * tangent > patch.highest + run * kMargin) break;
        horizon = std::max(horizon,
                           (patch.between(static_cast<float>(i) + s * di, static_cast<float>(j) + s * dj) - z) / run);
      }
      const int a = side.x() > 0 ? i : patch.cells - i;
      const int b = side.y() > 0 ? j : patch.cells - j;
      margins[static_cast<size_t>(b) * n + a] = std::clamp(tangent - horizon, -kMargin, kMargin);
    }
  }
  return margins;
}

}  // namespace rover
