// What the rover has seen around it: a grid in odom that moves with the rover. Obstacles are counted over frames; what
// leaves the field of view is kept, what leaves the grid is forgotten.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "common/core/grid_map.hpp"
#include "common/core/time.hpp"
#include "path_planner/geometry.hpp"

namespace rover::planning {

struct HazardMemoryConfig {
  int cells = 160;
  double cell_m = 0.1;
  int confirm_hits = 2;  // frames that saw an obstacle in the cell
  int possible_clear =
      2;  // frames in a row that saw it free end a possible hazard, or make the next hit a doubtful one
  int confirmed_clear = 5;     // ... from close by a confirmed one
  double clear_range_m = 2.0;  // what counts as close by, from the body origin
  int sure_free = 3;           // frames in a row that saw it free, from as near as that: nothing stands there,
  double sure_range_m = 2.5;   // whatever the NavCam's map says
  ViewArea view;
  int blind_looks = 6;  // frames in a row that should have seen a cell close by and did not: it is a hazard
};

// HAZARDS as the detector sends it, in the body frame of the exposure.
struct HazardGrid {
  enum Cell : std::uint8_t { kUnseen = 0, kFree = 1, kObstacle = 2, kHole = 3, kMargin = 4 };
  Utime utime = kNever;
  double cell_m = 0.0;
  double origin_x_m = 0.0;
  double origin_y_m = 0.0;
  int cells_x = 0;
  int cells_y = 0;
  std::vector<std::uint8_t> cells;  // iy * cells_x + ix

  static constexpr int kOutside = -1;
  // The value at a point in body axes.
  int at(double x_m, double y_m) const;
  // Why the grid is not usable; empty where it is.
  std::string fault() const;
};

struct GroundCell {
  bool seen = false;
  std::uint8_t hits = 0;       // frames that saw an obstacle here
  std::uint8_t contrary = 0;   // frames in a row that saw it free since the last hit
  std::uint8_t near_free = 0;  // frames in a row that saw it free from sure_range_m or nearer
  std::uint8_t relapses = 0;   // obstacles seen where it had been told free: each doubles the frames that tell so again
  std::uint8_t looks = 0;   // frames in a row that looked at it from close by in vain: no texture, no light, or a drop
  float vain_m = 0.0F;      // the nearest of these looks, from the body origin
  std::uint16_t frame = 0;  // the last that counted as a hit: two grid cells may fall into one cell here
  bool driven = false;      // the vehicle stood on it: no map makes it impassable
};

class HazardMemory {
 public:
  explicit HazardMemory(const HazardMemoryConfig& config) : config_(config), map_(config.cells, config.cell_m) {}

  void move_to(Point2 rover) { map_.move_to(rover.x_m, rover.y_m); }
  void clear() { map_.clear(); }
  // One frame. The ground lies `ground_z_m` above (negative: below) the body origin.
  void add(const HazardGrid& grid, const Eigen::Isometry3d& T_odom_body, double ground_z_m);
  // The ground under the vehicle carries it, whatever was thought of it.
  void mark_driven(const Pose2& pose, const Footprint& footprint);
  // Ground that the operator certifies.
  void mark_seen(Point2 center, double radius_m);

  bool confirmed(const GroundCell& cell) const { return cell.hits >= config_.confirm_hits; }
  // Looked at again and again from close by in vain: no longer ground that another view will show. Smooth dust is seen
  // from afar, where the picture is coarse, and not from near: a look from further off than those in vain does not
  // change it. One that did let the rover back off from dust, see it from 1.8 m, and come back, five times.
  bool blind(const GroundCell& cell) const { return cell.looks >= config_.blind_looks; }
  // Seen free again and again by the LocCam, whose picture of near ground is the sharper one.
  bool surely_free(const GroundCell& cell) const { return cell.near_free >= frames(config_.sure_free, cell); }
  // Whatever the NavCam's map says of the cell, nothing stands there.
  bool refutes(const GroundCell& cell) const { return cell.driven || surely_free(cell); }
  const GridMap<GroundCell>& map() const { return map_; }
  GridMap<GroundCell>& map() { return map_; }

 private:
  void note_obstacle(CellIndex index);
  void note_free(GroundCell& cell, double range_m) const;
  void note_seen(GroundCell& cell, double range_m) const;
  // So many, twice that after each relapse; what the cell's counters hold at most.
  static int frames(int first, const GroundCell& cell) { return std::min(first << cell.relapses, 255); }
  void note_unseen(GroundCell& cell, const HazardGrid& grid, Point2 in_body) const;

  HazardMemoryConfig config_;
  GridMap<GroundCell> map_;
  std::uint16_t frame_ = 0;
};

}  // namespace rover::planning
