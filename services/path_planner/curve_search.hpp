// Search for a continuous plan: best-first over place, heading and curvature (hybrid A*, Dolgov et al., IJRR 2010)
// along pieces whose curvature changes as fast as the steering turns at speed, so that the rover drives a plan without
// slowing down for it; point turns and ways stern first, over ground that was seen, at what they cost. The travel field
// is the estimate of what is left.
#pragma once

#include <deque>
#include <vector>

#include "path_planner/arc_search.hpp"
#include "path_planner/heading_field.hpp"

namespace rover::planning {

struct CurveSearchConfig : DrivingPrices {
  double step_m = 0.3;
  double bend_cost_m = 0.4;       // for a change by the largest curvature in one piece; less, the square of it
  double turn_bend_cost_m = 1.0;  // of a point turn more, where the wheels come from the largest curvature
  double greed = 1.1;
  double hasty_greed = 3.0;  // of a last try, where max_expansions did not do: the lattice leads almost straight down
  int max_expansions = 4000;
};

struct CurveProblem {
  const GoalField& field;
  const HeadingField& headings;
  const FootprintCheck& roomy;
  const FootprintCheck& tight;
  const FootprintCheck& squeeze;
  const FootprintCheck& turn;  // for point turns: the rover does not halt exactly
  ViewArea view;
  Pose2 start;
  double start_curvature_per_m = 0.0;
  double sure_m = 0.0;           // way within which all ground must be seen before the rover reaches it
  Pose2 stopped;                 // where the rover stands if it brakes now: point turns start there
  double most_cost = kInfinity;  // dearer plans are of no use
  bool may_back = true;
};

struct CurvePlan {
  bool found = false;
  bool unseen_in_the_way = false;  // ways were dropped because their ground would not be seen in time
  std::vector<Pose2> poses;        // every 5 cm; two in one place: a point turn
  bool backs_first = false;        // starts stern first
  std::vector<size_t> reversals;   // poses at which the rover changes from ahead to astern, or back
  double cost = kInfinity;
  int halts = 0;
  int expansions = 0;
};

// What a plan drives ahead, or astern, without a change between the two.
struct CurveLeg {
  std::vector<Pose2> poses;
  bool backwards = false;
};

std::deque<CurveLeg> legs_of(const CurvePlan& plan);

CurvePlan search_curves(const CurveSearchConfig& config, const CurveProblem& problem);

// Cost of a metre at a pose: the ground's, more where only the tight margin is kept or the least, infinity where none
// is.
double pose_cost_per_m(const CurveProblem& problem, const DrivingPrices& prices, const Pose2& pose);

}  // namespace rover::planning
