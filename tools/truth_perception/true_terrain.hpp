// Elevation map of the true surface: the cells that the NavCam has seen since they entered the map, each with its
// highest point. The cells keep their place in the world.
#pragma once

#include <memory>

#include "common/core/frames.hpp"
#include "common/core/grid_map.hpp"
#include "tools/truth_perception/line_of_sight.hpp"
#include "traversability/terrain_grid.hpp"

namespace rover::truth {

class TrueTerrain {
 public:
  TrueTerrain(int cells, double cell_m, std::shared_ptr<TrueSurface> surface);

  // Centres the map on the camera and adds the cells that it sees.
  void add(const View& view);
  // In the axes of `shape` (odom): nearest cells, as slam publishes them. `map` and `odom`: the body's pose in each.
  trav::TerrainGrid grid(const trav::GridShape& shape, const Pose2& map, const Pose2& odom) const;

 private:
  std::shared_ptr<TrueSurface> surface_;
  GridMap<float> top_m_;  // NaN: not seen
  std::vector<SurfacePoint> in_view_;
};

}  // namespace rover::truth
