// Hybrid A* (Dolgov et al., IJRR 29, 2010) over arcs ahead and in reverse and point turns.
#pragma once

#include <optional>

#include "tools/oracle/cost_to_go.hpp"

namespace rover::oracle {

struct SearchProblem {
  const Region& region;
  const FootprintCheck& check;
  const CostToGo& cost_to_go;
  double max_curvature_per_m = 1.0;
  Pose2 start;
  Eigen::Vector2d goal = Eigen::Vector2d::Zero();
  double tolerance_m = 0.5;
};

struct SearchResult {
  bool found = false;
  bool exhausted = false;  // no path in the region; neither: max_expansions reached
  Pieces path;             // of at most kStepM each
  int expansions = 0;

  static constexpr double kStepM = 0.3;
};

// `heuristic_weight` times the cost-to-go guides the search; above 1 it ends earlier, with a path that may be longer.
SearchResult search_poses(const SearchProblem& problem, double heuristic_weight, int max_expansions);

}  // namespace rover::oracle
