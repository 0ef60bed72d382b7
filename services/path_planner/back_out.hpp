// Where no way leads on: the way back, stern first, to the nearest place from which one does. Dijkstra over reverse
// arcs (as the forward pieces of hybrid A*); the field over places and headings tells from where a way leads on.
#pragma once

#include <vector>

#include "path_planner/heading_field.hpp"

namespace rover::planning {

struct BackOutConfig {
  double most_way_m = 6.0;  // stern first, on ground that is known
  double way_cost = 2.0;    // per metre of it, against what then is left forwards
};

struct BackOutProblem {
  const HeadingField& headings;  // of ways that surely are ways, with nothing spared about the rover
  const FootprintCheck& check;
  Pose2 rover;
  double least_way_m = 0.0;
  double max_curvature_per_m = 0.0;
};

// Places in odom, the rover's first; empty where nothing within reach leads on.
std::vector<Point2> back_out(const BackOutConfig& config, const BackOutProblem& problem);

}  // namespace rover::planning
