// Where no way leads on: stern first to the nearest place from which one does, to and fro where there is no room for
// that. Dijkstra over arcs in both directions (Reeds and Shepp, Pacific J. Math. 1990); the field over places and
// headings tells from where a way leads on.
#pragma once

#include <vector>

#include "path_planner/heading_field.hpp"

namespace rover::planning {

struct BackOutConfig {
  double most_way_m = 6.0;     // on ground that is known
  double way_cost = 2.0;       // per metre of it, against what then is left
  double change_cost_m = 1.0;  // of each change of direction
  int most_expansions = 20'000;
};

struct BackOutProblem {
  const HeadingField& headings;  // of ways that surely are ways, with nothing spared about the rover
  const FootprintCheck& check;
  Pose2 rover;
  double least_way_m = 0.0;
  double max_curvature_per_m = 0.0;
};

struct BackOut {
  std::vector<Point2> way;  // in odom, the rover's place first, up to the first change of direction
  bool ahead = false;       // bow first
};

// An empty way: nothing within reach leads on.
BackOut back_out(const BackOutConfig& config, const BackOutProblem& problem);

}  // namespace rover::planning
