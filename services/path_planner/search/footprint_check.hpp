// Exact test of the footprint against hazards and unknown ground.
#pragma once

#include <vector>

#include "path_planner/map/costmap.hpp"

namespace rover::planning {

// Keeps the footprint clear of hazards by a margin, and on known ground. Of a hazard or unknown ground that is nearer
// at `start` the rover may come closer by `approach_m`, but not onto a hazard's cell. One whose cell its edge had
// reached at `planned_from`, when the path was planned, it may leave, or come onto by `approach_m`.
class FootprintCheck {
 public:
  // `known_margin_m`: how far around the footprint ground must be known.
  FootprintCheck(const Costmap& costmap, const Footprint& footprint, double margin_m, double approach_m,
                 double known_margin_m, const Pose2& start, const Pose2& planned_from);
  // Of a plan from there.
  FootprintCheck(const Costmap& costmap, const Footprint& footprint, double margin_m, double approach_m,
                 double known_margin_m, const Pose2& start)
      : FootprintCheck(costmap, footprint, margin_m, approach_m, known_margin_m, start, start) {}

  // On a side slope the rover slides, also towards hazards, until it has steered against it.
  void allow_slide(double slide_m) { slide_m_ = slide_m; }
  bool clear(const Pose2& pose) const;
  // From the footprint to the nearest centre of a hazard cell; `max` if none is as near.
  double clearance_m(const Pose2& pose, double max) const;
  // Calls f(point) for each unknown point that the edge of the footprint enters, until it returns false; false then. A
  // moving footprint covers only ground that its edge has passed.
  template <class F>
  bool all_unknown(const Pose2& pose, F&& f) const;
  bool known(const Pose2& pose) const {
    return all_unknown(pose, [](Point2) { return false; });
  }

 private:
  static constexpr double kCellDiagonals = 1.5;  // cells by which a distance between cells may be too large

  double distance_m(const Pose2& pose, const Hazard& hazard) const {
    return footprint_.hazard_distance_m(pose, hazard.p, hazard.low);
  }
  bool violates(const Pose2& pose, const Hazard& hazard) const;
  bool enters(const Pose2& pose, Point2 unknown) const;

  const Costmap& costmap_;
  Footprint footprint_;
  double margin_m_;
  double approach_m_;
  double slide_m_ = 0.0;
  Pose2 start_;
  Pose2 planned_from_;
  std::vector<Point2> edge_;  // points along the edge, the front first
};

template <class F>
bool FootprintCheck::all_unknown(const Pose2& pose, F&& f) const {
  if (costmap_.unknown_distance_m(position(pose)) > footprint_.radius_m() + costmap_.cell_m()) return true;
  const double c = std::cos(pose.yaw_rad);
  const double s = std::sin(pose.yaw_rad);
  for (size_t i = 0; i < edge_.size();) {
    const Point2 p{pose.x_m + c * edge_[i].x_m - s * edge_[i].y_m, pose.y_m + s * edge_[i].x_m + c * edge_[i].y_m};
    if (costmap_.unknown(p) && enters(pose, p) && !f(p)) return false;
    // Neighbours on the edge are at most a cell apart: skip those that unknown ground is farther from.
    const double known_m = std::min(costmap_.unknown_distance_m(p), costmap_.inside_m(p));
    i += 1 + static_cast<size_t>(std::max(0.0, known_m / costmap_.cell_m() - kCellDiagonals));
  }
  return true;
}

// Between the poses of a path from which the LocCam looks.
constexpr double kViewStepM = 0.3;
// Poses of a point turn from which the LocCam looks, the end among them.
std::vector<Pose2> turn_views(double from_yaw_rad, const Pose2& to);

// Whether the ground under a footprint is known, or comes into the LocCam's view on the path to it. A hazard hides the
// ground behind it.
class Visibility {
 public:
  Visibility(const Costmap& costmap, const FootprintCheck& check, const ViewArea& view)
      : costmap_(costmap), check_(check), view_(view) {}
  void add_view(const Pose2& from) {
    views_.push_back({position(from), std::cos(from.yaw_rad), std::sin(from.yaw_rad)});
  }
  void clear() { views_.clear(); }
  bool covers(const Pose2& pose) const;

 private:
  struct View {
    Point2 from;
    double cos_yaw;
    double sin_yaw;
  };
  bool sees(const View& view, Point2 p) const;

  const Costmap& costmap_;
  const FootprintCheck& check_;
  ViewArea view_;
  std::vector<View> views_;
};

}  // namespace rover::planning
