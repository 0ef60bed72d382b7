// The ground around the rover at one moment, made ready for planning: hazards as points, distances to them, and what
// was never seen. The exact test of the vehicle's rectangle against both.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "path_planner/geometry.hpp"
#include "path_planner/ground_map.hpp"
#include "path_planner/hazard_memory.hpp"

namespace rover::planning {

struct HazardSpot {
  Point2 p;                // a cell's centre
  bool confirmed = false;  // or blind ground; else a possible one: a single hit
};

class Terrain {
 public:
  enum class Reach { kMemory, kGround };  // of which of the two grids

  // Small impassable spots of the map that the rover has not been near, and that the LocCam has not confirmed: as often
  // as not a stone that may be driven over. Taken for dear ground, they leave ways that the LocCam will confirm or
  // close.
  struct Doubt {
    Point2 rover;
    double from_m = 0.0;  // of the rover, now and ever
    int most_cells = 0;   // of a spot; 0: the map is not doubted
    // Only spots that the LocCam saw free from near at least once: the rover drives without looking there.
    bool if_seen_free = false;
  };

  explicit Terrain(const HazardMemory& memory) : Terrain(memory, nullptr, Reach::kMemory) {}
  // Also what the ground map knows: its impassable cells are hazards, and ground that it knows counts as seen. Null:
  // none. Both grids have cells of one size.
  Terrain(const HazardMemory& memory, const GroundMap* ground, Reach reach, const Doubt& doubt);
  Terrain(const HazardMemory& memory, const GroundMap* ground, Reach reach) : Terrain(memory, ground, reach, Doubt{}) {}

  int cells() const { return cells_; }
  double cell_m() const { return cell_m_; }
  bool contains(Point2 p) const { return inside_m(p) > 0.0; }
  // Distance of the point to the map's border, negative outside.
  double inside_m(Point2 p) const {
    const double x = p.x_m - corner_.x_m;
    const double y = p.y_m - corner_.y_m;
    return std::min(std::min(x, side_m_ - x), std::min(y, side_m_ - y));
  }
  // The point must lie inside.
  int cell_of(Point2 p) const {
    const int ix = std::clamp(static_cast<int>((p.x_m - corner_.x_m) * cells_per_m_), 0, cells_ - 1);
    const int iy = std::clamp(static_cast<int>((p.y_m - corner_.y_m) * cells_per_m_), 0, cells_ - 1);
    return iy * cells_ + ix;
  }
  Point2 center_of(int cell) const;

  // Row by row, so that those near a point stand together.
  const std::vector<HazardSpot>& hazards() const { return hazards_; }
  // Hazards whose y lies within `reach_m` of that of the point, and some more.
  std::span<const HazardSpot> hazards_about(Point2 p, double reach_m) const;
  bool unseen(Point2 p) const { return !contains(p) || unseen_[cell_of(p)] != 0; }
  // To the nearest hazard's centre, by the cell; infinity outside.
  double hazard_distance_m(Point2 p) const { return contains(p) ? hazard_distance_[cell_of(p)] : kInfinity; }
  double hazard_distance_m(int cell) const { return hazard_distance_[cell]; }
  bool unseen(int cell) const { return unseen_[cell] != 0; }
  // What the map says of the worst ground under the wheels of a rover whose centre is there, 0 easy .. 1 impassable; 0
  // where it says nothing.
  double difficulty(int cell) const { return difficulty_.empty() ? 0.0 : difficulty_[cell]; }
  double unseen_distance_m(Point2 p) const { return contains(p) ? unseen_distance_[cell_of(p)] : 0.0; }
  // Bilinear, with the gradient; far from hazards the value saturates.
  double hazard_distance_smooth(Point2 p, Eigen::Vector2d& gradient) const;

 private:
  int cells_;
  double cell_m_;
  double cells_per_m_;
  double side_m_;
  Point2 corner_;
  // Lays what the map knows over the masks.
  std::vector<std::uint8_t> lay_ground(const HazardMemory& memory, const GroundMap& ground, CellIndex origin);
  // Takes the doubtful spots out of the mask. `sure`: cells that the LocCam confirms.
  void drop_doubtful(const Doubt& doubt, const std::vector<std::uint8_t>& sure, std::vector<std::uint8_t>& mask) const;

  std::vector<std::uint8_t> unseen_;
  std::vector<float> difficulty_;  // empty: no map
  std::vector<HazardSpot> hazards_;
  std::vector<size_t> row_begin_;  // in hazards_, one more than there are rows
  std::vector<double> hazard_distance_;
  std::vector<double> unseen_distance_;
};

// Keeps the rectangle clear of hazards by a margin. A hazard that is nearer already at the start cannot be undone: the
// rover may leave it, but not come closer.
class FootprintCheck {
 public:
  // `seen_margin_m`: how far around the rectangle ground must have been seen.
  FootprintCheck(const Terrain& terrain, const Footprint& footprint, double margin_m, double seen_margin_m,
                 const Pose2& start);

  bool clear(const Pose2& pose) const;
  // Only hazards of which `confirmed` is as asked.
  bool clear_of(const Pose2& pose, bool confirmed) const;
  // From the rectangle to the nearest hazard's centre; `most` where there is none as near.
  double clearance_m(const Pose2& pose, double most) const;
  // Calls f(point) for each unseen point under the rectangle's rim until it returns false; false then. Whatever ground
  // a moving rectangle comes to cover, its rim has passed.
  template <class F>
  bool all_unseen(const Pose2& pose, F&& f) const;

  double margin_m() const { return margin_m_; }
  const Footprint& footprint() const { return footprint_; }
  const Terrain& terrain() const { return terrain_; }

 private:
  static constexpr double kCellDiagonals = 1.5;  // cells by which a distance between cells may be too large

  bool violates(const Pose2& pose, Point2 hazard) const;

  const Terrain& terrain_;
  Footprint footprint_;
  double margin_m_;
  Pose2 start_;
  std::vector<Point2> rim_;  // around the rectangle's edge, the front first
};

template <class F>
bool FootprintCheck::all_unseen(const Pose2& pose, F&& f) const {
  if (terrain_.unseen_distance_m(position(pose)) > footprint_.radius_m() + terrain_.cell_m()) return true;
  const double c = std::cos(pose.yaw_rad);
  const double s = std::sin(pose.yaw_rad);
  for (size_t i = 0; i < rim_.size();) {
    const Point2 p{pose.x_m + c * rim_[i].x_m - s * rim_[i].y_m, pose.y_m + s * rim_[i].x_m + c * rim_[i].y_m};
    if (terrain_.unseen(p) && !f(p)) return false;
    // Neighbours on the rim are a cell apart at most: none nearer than unseen ground or the map's border needs a look.
    const double seen_m = std::min(terrain_.unseen_distance_m(p), terrain_.inside_m(p));
    i += 1 + static_cast<size_t>(std::max(0.0, seen_m / terrain_.cell_m() - kCellDiagonals));
  }
  return true;
}

}  // namespace rover::planning
