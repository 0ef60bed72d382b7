// The ground around the rover at one moment, prepared for planning: hazards as points with distances to them, unknown
// ground, and what a metre costs. Immutable.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "common/core/zones.hpp"
#include "path_planner/geometry.hpp"
#include "path_planner/map/belief_map.hpp"

namespace rover::planning {

// What a costmap is for. Backing up, where the footprint was it fits again, also a little beside; after a fault only
// there.
enum class CostmapUse : std::uint8_t { kGoingOn, kBackingUp, kBackingUpOnTrack };

struct CostmapConfig {
  CostmapUse use = CostmapUse::kGoingOn;
  double hazard_probability = 0.5;  // from here on a cell is a hazard; below, its probability costs
  double hazard_cost = 4.0;         // relative to driving, at probability 1: the expected detour
  double difficulty_cost = 1.5;     // the same, at ground that is just traversable
  double unknown_cost = 0.6;        // the same, on unknown ground
  double wheel_reach_m = 0.45;      // the costliest cell this near to the body origin counts: wheels pass there
};

struct Hazard {
  Point2 p;          // centre of a cell
  bool low = false;  // the body passes over it, the wheels do not
};

class Costmap {
 public:
  // A square window of the map around the rover. The borders of the zones, in odom, are walls.
  Costmap(const CostmapConfig& config, const BeliefMap& belief, Point2 rover, double side_m,
          const std::vector<Zone>& zones = {});

  int cells() const { return cells_; }
  double cell_m() const { return cell_m_; }
  bool contains(Point2 p) const { return inside_m(p) > 0.0; }
  // Distance of the point to the border, negative outside.
  double inside_m(Point2 p) const {
    const double x = p.x_m - corner_.x_m;
    const double y = p.y_m - corner_.y_m;
    return std::min(std::min(x, side_m_ - x), std::min(y, side_m_ - y));
  }
  // The point must lie inside.
  int cell_of(Point2 p) const {
    const int ix = std::clamp(static_cast<int>((p.x_m - corner_.x_m) / cell_m_), 0, cells_ - 1);
    const int iy = std::clamp(static_cast<int>((p.y_m - corner_.y_m) / cell_m_), 0, cells_ - 1);
    return iy * cells_ + ix;
  }
  Point2 center_of(int cell) const {
    return {corner_.x_m + (cell % cells_ + 0.5) * cell_m_, corner_.y_m + (cell / cells_ + 0.5) * cell_m_};
  }

  // Row by row.
  const std::vector<Hazard>& hazards() const { return hazards_; }
  // Those whose y lies within `reach_m` of that of the point, and a few more.
  std::span<const Hazard> hazards_near(Point2 p, double reach_m) const;
  // To the nearest centre of a hazard cell, by the cell; infinity outside.
  double hazard_distance_m(Point2 p) const { return contains(p) ? hazard_distance_[cell_of(p)] : kInfinity; }
  bool unknown(Point2 p) const { return !contains(p) || unknown_[cell_of(p)] != 0; }
  bool unknown(int cell) const { return unknown_[cell] != 0; }
  // Whether the footprint was over it.
  bool passed(Point2 p) const { return contains(p) && passed_[cell_of(p)] != 0; }
  bool backing_up() const { return config_.use != CostmapUse::kGoingOn; }
  bool has_heights() const { return !height_m_.empty(); }
  // Of the ground, in odom, between the centres of cells; NaN: not known. The map must have heights.
  double height_m(Point2 p) const;
  double unknown_distance_m(Point2 p) const { return contains(p) ? unknown_distance_[cell_of(p)] : 0.0; }
  // Of a metre with the body origin in each cell, relative to a metre on easy ground: at least 1.
  std::vector<float> costs() const;

 private:
  using Cells = std::vector<const CellBelief*>;
  void set_unknown(const Cells& cells, const std::vector<std::uint8_t>& unmeasurable);
  void set_hazards(const Cells& cells, const BeliefMap& belief, const std::vector<std::uint8_t>& unmeasurable,
                   const std::vector<std::uint8_t>& walls);
  void know_track();
  std::pair<double, double> within(const Eigen::Vector2d& a, const Eigen::Vector2d& along) const;
  std::vector<std::uint8_t> walls_of(const std::vector<Zone>& zones) const;

  CostmapConfig config_;
  int cells_;
  double cell_m_;
  double side_m_;
  Point2 corner_;
  std::vector<std::uint8_t> unknown_;
  std::vector<std::uint8_t> passed_;
  std::vector<float> height_m_;  // empty: none is known
  std::vector<float> own_cost_;  // beside the metre itself, of the ground in each cell
  std::vector<Hazard> hazards_;
  std::vector<size_t> row_begin_;  // in hazards_, one more than there are rows
  std::vector<double> hazard_distance_;
  std::vector<double> unknown_distance_;
};

}  // namespace rover::planning
