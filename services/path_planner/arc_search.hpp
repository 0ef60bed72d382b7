// Descent of the fast-marching field by a vehicle that turns on arcs: best-first search over poses joined by short
// arcs, with the field as the estimate of what is left (hybrid A*, Dolgov et al., IJRR 2010). From each pose an
// arc-line-arc path is tried to the poses at which the global path may be joined.
//
// Plain gradient descent, as in the paper, knows no heading: near the rover it asks for steps to the side. Here every
// path starts along the rover's heading (or after a point turn, at its price), keeps the curvature bound and is tested
// with the exact rectangle.
#pragma once

#include <optional>
#include <vector>

#include "common/core/fast_marching.hpp"
#include "path_planner/dubins.hpp"
#include "path_planner/terrain.hpp"

namespace rover::planning {

struct ArcSearchConfig {
  double step_m = 0.3;
  double max_curvature_per_m = 0.8;  // radius 1.25 m: preferred over the least radius of 1.0 m
  double curvature_cost = 0.3;       // per metre, at the largest curvature
  double bend_cost_m = 0.15;         // for a change of curvature by the largest
  double turn_cost_m = 3.0;          // a point turn takes about 15 s, in which the rover could drive 3 m
  double turn_cost_per_rad_m = 1.0;
  double turn_bend_cost_m = 1.0;  // more, where the wheels come from or go to the largest curvature: 5 s of steering
  double unseen_way_cost = 2.0;   // per metre beyond sure_m over ground that would not be seen in time
  double greed = 1.3;             // weight of what is left against what was done
  int max_expansions = 2500;
  int further_expansions = 60;  // after the first way has been found, for a better one
};

// A pose at which a way may end, with what the rest of the way costs from there.
struct JoinTarget {
  Pose2 pose;
  double way_m = 0.0;  // along the global path
  double travel_cost = 0.0;
};

struct SearchProblem {
  const FootprintCheck& check;
  const FootprintCheck& turn_check;  // for point turns: the rover does not halt exactly
  const MarchGrid& cost;
  const std::vector<double>& travel;  // the fast-marching field of `cost` from the targets
  ViewArea view;
  const std::vector<JoinTarget>& targets;  // ordered along the global path
  std::optional<Point2> goal;              // any heading will do within goal_reach_m of it
  double goal_reach_m = 0.0;
  double goal_miss_cost = 0.0;  // per metre off the goal
  Pose2 start;
  double start_curvature_per_m = 0.0;
  double sure_m = kInfinity;  // way within which all ground must be seen before the rover reaches it
  Pose2 stopped;              // where the rover stands if it brakes now: point turns start there
};

// Arcs without a halt between them.
struct WaySection {
  Pose2 start;
  std::vector<ArcSegment> segments;
};

struct SearchResult {
  bool found = false;
  bool unseen_in_the_way = false;    // ways were dropped because their ground would not be seen in time
  bool turns_first = false;          // starts with a point turn
  std::vector<WaySection> sections;  // a point turn between each two
  int target = -1;                   // -1: ends near the goal
  double cost = kInfinity;
  int expansions = 0;
};

SearchResult search_arcs(const ArcSearchConfig& config, const SearchProblem& problem);

// Whether each point that a footprint covers was seen before: in the map, or from a pose passed earlier on the way.
class SeenOnTheWay {
 public:
  SeenOnTheWay(const FootprintCheck& check, const ViewArea& view) : check_(check), view_(view) {}
  void passed(const Pose2& pose) { views_.push_back({position(pose), std::cos(pose.yaw_rad), std::sin(pose.yaw_rad)}); }
  void clear() { views_.clear(); }
  // The bare rectangle, without margin.
  bool covers(const Pose2& pose) const;

 private:
  struct View {
    Point2 from;
    double cos_yaw;
    double sin_yaw;
  };
  const FootprintCheck& check_;
  ViewArea view_;
  std::vector<View> views_;
};

}  // namespace rover::planning
