// The ground around the rover at one moment, made ready for planning: hazards as points, distances to them, and what
// was never seen. The exact test of the vehicle's rectangle against both.
#pragma once

#include <cstdint>
#include <vector>

#include "path_planner/geometry.hpp"
#include "path_planner/hazard_memory.hpp"

namespace rover::planning {

struct HazardSpot {
  Point2 p;                // a cell's centre
  bool confirmed = false;  // or blind ground; else a possible one: a single hit
};

class Terrain {
 public:
  explicit Terrain(const HazardMemory& memory);

  int cells() const { return cells_; }
  double cell_m() const { return cell_m_; }
  bool contains(Point2 p) const;
  // Distance of the point to the map's border, negative outside.
  double inside_m(Point2 p) const;
  int cell_of(Point2 p) const;  // the point must lie inside
  Point2 center_of(int cell) const;

  const std::vector<HazardSpot>& hazards() const { return hazards_; }
  bool unseen(Point2 p) const { return !contains(p) || unseen_[cell_of(p)] != 0; }
  // To the nearest hazard's centre, by the cell; infinity outside.
  double hazard_distance_m(Point2 p) const { return contains(p) ? hazard_distance_[cell_of(p)] : kInfinity; }
  double hazard_distance_m(int cell) const { return hazard_distance_[cell]; }
  bool unseen(int cell) const { return unseen_[cell] != 0; }
  double unseen_distance_m(Point2 p) const { return contains(p) ? unseen_distance_[cell_of(p)] : 0.0; }
  // Bilinear, with the gradient; far from hazards the value saturates.
  double hazard_distance_smooth(Point2 p, Eigen::Vector2d& gradient) const;

 private:
  int cells_;
  double cell_m_;
  Point2 corner_;
  std::vector<std::uint8_t> unseen_;
  std::vector<HazardSpot> hazards_;
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
  bool violates(const Pose2& pose, Point2 hazard) const;

  const Terrain& terrain_;
  Footprint footprint_;
  double margin_m_;
  Pose2 start_;
  std::vector<Point2> rim_;  // points along the rectangle's edge, the front first
};

template <class F>
bool FootprintCheck::all_unseen(const Pose2& pose, F&& f) const {
  if (terrain_.unseen_distance_m(position(pose)) > footprint_.radius_m() + terrain_.cell_m()) return true;
  const double c = std::cos(pose.yaw_rad);
  const double s = std::sin(pose.yaw_rad);
  return std::all_of(rim_.begin(), rim_.end(), [&](Point2 r) {
    const Point2 p{pose.x_m + c * r.x_m - s * r.y_m, pose.y_m + s * r.x_m + c * r.y_m};
    return !terrain_.unseen(p) || f(p);
  });
}

}  // namespace rover::planning
