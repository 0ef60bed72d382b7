#include "tools/truth_perception/true_terrain.hpp"

#include <cmath>
#include <limits>

namespace rover::truth {
namespace {

constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();

}  // namespace

TrueTerrain::TrueTerrain(int cells, double cell_m, std::shared_ptr<TrueSurface> surface)
    : surface_(std::move(surface)), top_m_(cells, cell_m, kUnseen) {}

void TrueTerrain::add(const View& view) {
  top_m_.move_to(view.T_map_cam.translation().x(), view.T_map_cam.translation().y());
  find_points_in_view(*surface_, view, in_view_);
  for (const SurfacePoint& point : in_view_) {
    const CellIndex i = top_m_.index_of(point.p_map.x(), point.p_map.y());
    if (!point.visible || !top_m_.contains(i) || !std::isnan(top_m_.at(i))) continue;
    const double cell_m = top_m_.cell_m();
    top_m_.at(i) = static_cast<float>(surface_->top_m(i.ix * cell_m, i.iy * cell_m, cell_m));
  }
}

trav::TerrainGrid TrueTerrain::grid(const trav::GridShape& shape, const Pose2& map, const Pose2& odom) const {
  const double c = std::cos(map.yaw_rad - odom.yaw_rad), s = std::sin(map.yaw_rad - odom.yaw_rad);
  trav::TerrainGrid grid{shape, {}, {}};
  grid.height_m.reserve(shape.size());
  grid.sigma_m.reserve(shape.size());
  for (int iy = 0; iy < shape.cells_y; ++iy)
    for (int ix = 0; ix < shape.cells_x; ++ix) {
      const double dx = shape.x_m(ix) - odom.x_m, dy = shape.y_m(iy) - odom.y_m;
      const float top_m = top_m_.get(top_m_.index_of(map.x_m + c * dx - s * dy, map.y_m + s * dx + c * dy));
      grid.height_m.push_back(top_m);
      grid.sigma_m.push_back(std::isnan(top_m) ? kUnseen : 0.0F);
    }
  return grid;
}

}  // namespace rover::truth
