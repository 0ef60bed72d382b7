// Cause of each hazard stop and replan: true or false detection, unseen ground, old and new path.
#pragma once

#include <string>
#include <vector>

#include "tools/report/rock_evaluation.hpp"

namespace rover::report {

constexpr double kRealRockM = 0.12;    // minimum height of a rock that justifies a stop
constexpr double kRealRadiusM = 0.35;  // maximum distance from a cell that caused the stop to the rim of that rock
constexpr double kRealReliefM = 0.12;  // minimum step or hole that justifies a stop

struct Incident {
  double t_s = 0.0;
  bool stopped = false;  // HAZARD_STOP; else the path was repaired while driving
  bool replanned = false;
  bool unseen = false;          // blocked by unobserved ground, not by a hazard
  bool real = false;            // a rock, step or hole exists
  double tallest_rock_m = 0.0;  // near the cells
  Points cells;                 // true centres of the hazard cells that caused it
  Points old_path;              // path followed before, at its true position
  Points new_path;              // empty: none
  bool is_false() const { return !real && !unseen; }
};

// At this change of state; a change of the level within a stop is not a second one.
bool hazard_stop_begins(const RunRecord& run, size_t change);

std::vector<Incident> evaluate_stops(const RunRecord& run, const TrueTrack& truth, const Window& window,
                                     const Footprint& footprint, const TrueWorld& world);

// Path followed at t at its true position (paths are in the rover's frames, which have errors).
Points followed_path(const RunRecord& run, const TrueTrack& truth, double t_s);
// The given path at its true position for the rover at t.
Points path_in_truth(const RunRecord& run, const TrueTrack& truth, const PathRecord& path, double t_s);

}  // namespace rover::report
