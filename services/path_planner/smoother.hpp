// Smooths a way by its curvature: knots of a piecewise linear curvature and the length are the unknowns, the start pose
// is fixed, the end pose an equality constraint, the least clearance an inequality, the curvature bound a box (after
// Kelly and Nagy, IJRR 2003). NLopt's SLSQP with a fixed number of evaluations: no clock, no chance.
#pragma once

#include <optional>
#include <vector>

#include "path_planner/dubins.hpp"
#include "path_planner/terrain.hpp"

namespace rover::planning {

struct SmootherConfig {
  double knot_m = 0.45;
  int max_knots = 16;
  double max_curvature_per_m = 0.85;
  double curvature_weight = 0.25;  // per squared curvature and metre, against 1 per metre of length
  double bend_weight = 0.25;       // per squared curvature rate and metre: the steering takes time
  double clearance_weight = 2.0;   // per squared metre below the risk distance and metre
  double risk_m = 0.35;            // clearance beyond the margin that is still worth a detour
  double end_tolerance_m = 0.01;
  double end_tolerance_rad = 0.01;
  int max_evaluations = 40;
};

struct SmoothProblem {
  const Terrain& terrain;
  Footprint footprint;
  double margin_m = 0.0;
  Pose2 start;
  double start_curvature_per_m = 0.0;
  std::vector<ArcSegment> segments;  // the way to be smoothed
};

// Poses every `step_m` or a little less, first and last included; nothing where the end is not met.
std::optional<std::vector<Pose2>> smooth(const SmootherConfig& config, const SmoothProblem& problem, double step_m);

// Poses along arcs, likewise.
std::vector<Pose2> sample(const Pose2& start, const std::vector<ArcSegment>& segments, double step_m);

}  // namespace rover::planning
