#include "path_planner/hazard_memory.hpp"

#include <array>

namespace rover::planning {
namespace {

constexpr int kMostHits = 10;
constexpr int kMostRelapses = 4;
constexpr double kViewRimM = 0.15;  // of the view, where pitch and roll decide whether ground is in the picture
constexpr int kMostCells = 1 << 20;

// Cells of the map whose centres lie in the box.
template <class F>
void for_cells_in(GridMap<GroundCell>& map, Point2 low, Point2 high, F&& f) {
  const CellIndex a = map.index_of(low.x_m, low.y_m);
  const CellIndex b = map.index_of(high.x_m, high.y_m);
  const CellIndex o = map.origin();
  for (int iy = std::max(a.iy, o.iy); iy <= std::min(b.iy, o.iy + map.cells() - 1); ++iy)
    for (int ix = std::max(a.ix, o.ix); ix <= std::min(b.ix, o.ix + map.cells() - 1); ++ix) {
      const CellIndex i{ix, iy};
      f(map.at(i), Point2{map.center_x_m(i), map.center_y_m(i)});
    }
}

// Body ground plane to odom, seen from above: an affine map.
struct PlaneMap {
  Eigen::Matrix2d A;
  Eigen::Vector2d b;
  PlaneMap(const Eigen::Isometry3d& T, double z_m)
      : A(T.linear().topLeftCorner<2, 2>()), b((T * Eigen::Vector3d(0.0, 0.0, z_m)).head<2>()) {}
  Eigen::Vector2d operator()(double x_m, double y_m) const { return A * Eigen::Vector2d(x_m, y_m) + b; }
};

// The part of the view that is in the picture at any attitude the vehicle may have.
bool surely_in_view(const ViewArea& view, double range_m, Point2 in_body) {
  return in_body.x_m <= range_m && view.sees({in_body.x_m - kViewRimM, in_body.y_m}) &&
         view.sees({in_body.x_m, std::abs(in_body.y_m) + kViewRimM});
}

// Whether an obstacle of the frame stands between the camera and the point.
bool hidden(const HazardGrid& grid, Point2 camera, Point2 in_body) {
  const double length = distance(camera, in_body);
  const int steps = static_cast<int>(length / (0.5 * grid.cell_m));
  for (int i = 1; i < steps; ++i) {
    const double u = static_cast<double>(i) / steps;
    const int value = grid.at(camera.x_m + u * (in_body.x_m - camera.x_m), camera.y_m + u * (in_body.y_m - camera.y_m));
    if (value == HazardGrid::kObstacle || value == HazardGrid::kHole) return true;
  }
  return false;
}

}  // namespace

int HazardGrid::at(double x_m, double y_m) const {
  const int ix = static_cast<int>(std::floor((x_m - origin_x_m) / cell_m));
  const int iy = static_cast<int>(std::floor((y_m - origin_y_m) / cell_m));
  if (ix < 0 || iy < 0 || ix >= cells_x || iy >= cells_y) return kOutside;
  return cells[static_cast<size_t>(iy) * cells_x + ix];
}

std::string HazardGrid::fault() const {
  if (cells_x <= 0 || cells_y <= 0 || cells_x > kMostCells / cells_y) return "grid size out of range";
  if (cells.size() != static_cast<size_t>(cells_x) * static_cast<size_t>(cells_y))
    return "grid size does not match its cells";
  if (!(cell_m >= 0.01 && cell_m <= 1.0)) return "cell size out of range";
  if (!std::isfinite(origin_x_m) || !std::isfinite(origin_y_m)) return "grid origin is not finite";
  if (std::any_of(cells.begin(), cells.end(), [](std::uint8_t c) { return c > kMargin; })) return "unknown cell value";
  return "";
}

void HazardMemory::add(const HazardGrid& grid, const Eigen::Isometry3d& T_odom_body, double ground_z_m) {
  frame_ = static_cast<std::uint16_t>(frame_ == 0xffff ? 1 : frame_ + 1);
  const PlaneMap to_odom(T_odom_body, ground_z_m);
  const Eigen::Matrix2d to_grid = to_odom.A.inverse();
  const double far_x = grid.origin_x_m + grid.cells_x * grid.cell_m;
  const double far_y = grid.origin_y_m + grid.cells_y * grid.cell_m;
  Eigen::AlignedBox2d box;
  for (const double x : {grid.origin_x_m, far_x})
    for (const double y : {grid.origin_y_m, far_y}) box.extend(to_odom(x, y));

  for_cells_in(map_, {box.min().x(), box.min().y()}, {box.max().x(), box.max().y()}, [&](GroundCell& cell, Point2 p) {
    const Eigen::Vector2d in_body = to_grid * (Eigen::Vector2d(p.x_m, p.y_m) - to_odom.b);
    const int value = grid.at(in_body.x(), in_body.y());
    if (value == HazardGrid::kUnseen) note_unseen(cell, grid, {in_body.x(), in_body.y()});
    if (value == HazardGrid::kFree) note_free(cell, in_body.norm());
    // The margin about a hazard is ground that was seen; this service keeps margins of its own.
    if (value == HazardGrid::kMargin) note_seen(cell, in_body.norm());
  });
  // From the obstacle's side, so that none falls between the cells of the turned grid.
  for (int iy = 0; iy < grid.cells_y; ++iy)
    for (int ix = 0; ix < grid.cells_x; ++ix) {
      const std::uint8_t value = grid.cells[static_cast<size_t>(iy) * grid.cells_x + ix];
      if (value != HazardGrid::kObstacle && value != HazardGrid::kHole) continue;
      const Eigen::Vector2d p =
          to_odom(grid.origin_x_m + (ix + 0.5) * grid.cell_m, grid.origin_y_m + (iy + 0.5) * grid.cell_m);
      note_obstacle(map_.index_of(p.x(), p.y()));
    }
}

void HazardMemory::note_obstacle(CellIndex index) {
  if (!map_.contains(index)) return;
  GroundCell& cell = map_.at(index);
  if (cell.frame == frame_) return;
  cell.frame = frame_;
  cell.seen = true;
  if (surely_free(cell) && cell.relapses < kMostRelapses) ++cell.relapses;
  cell.looks = cell.near_free = 0;
  const bool doubtful = cell.hits == 0 && cell.contrary >= config_.possible_clear;
  cell.contrary = 0;
  if (!doubtful && cell.hits < kMostHits) ++cell.hits;
}

void HazardMemory::note_free(GroundCell& cell, double range_m) const {
  const bool close = range_m <= config_.clear_range_m;
  note_seen(cell, range_m);
  if (range_m <= config_.sure_range_m && !surely_free(cell)) ++cell.near_free;
  if (confirmed(cell) && !close) return;
  const int enough = confirmed(cell) ? frames(config_.confirmed_clear, cell) : config_.possible_clear;
  if (cell.contrary < enough) ++cell.contrary;
  if (cell.contrary >= enough) cell.hits = 0;
}

void HazardMemory::note_seen(GroundCell& cell, double range_m) const {
  cell.seen = true;
  const auto near_m = blind(cell) ? cell.vain_m : static_cast<float>(config_.clear_range_m);
  if (static_cast<float>(range_m) <= near_m) cell.looks = 0;
}

void HazardMemory::note_unseen(GroundCell& cell, const HazardGrid& grid, Point2 in_body) const {
  if (!surely_in_view(config_.view, config_.clear_range_m, in_body) || hidden(grid, config_.view.camera, in_body))
    return;
  const auto range_m = static_cast<float>(std::hypot(in_body.x_m, in_body.y_m));
  cell.vain_m = cell.looks == 0 ? range_m : std::min(cell.vain_m, range_m);
  if (!blind(cell)) ++cell.looks;
}

void HazardMemory::mark_driven(const Pose2& pose, const Footprint& footprint) {
  const double rim = 0.5 * std::numbers::sqrt2 * config_.cell_m;  // cells that the rectangle's edge passes through
  const double r = footprint.radius_m() + rim;
  for_cells_in(map_, {pose.x_m - r, pose.y_m - r}, {pose.x_m + r, pose.y_m + r}, [&](GroundCell& cell, Point2 p) {
    const double d = footprint.distance_m(pose, p);
    if (d <= 0.0) cell = GroundCell{.driven = true};
    if (d <= rim) cell.seen = true, cell.looks = 0;
  });
}

void HazardMemory::mark_seen(Point2 center, double radius_m) {
  for_cells_in(map_, {center.x_m - radius_m, center.y_m - radius_m}, {center.x_m + radius_m, center.y_m + radius_m},
               [&](GroundCell& cell, Point2 p) { cell.seen = cell.seen || distance(p, center) <= radius_m; });
}

}  // namespace rover::planning
