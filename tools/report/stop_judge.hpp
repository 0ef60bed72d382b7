// Each hazard stop and each replan: what was seen, whether it was really there, and how the path changed.
#pragma once

#include <string>
#include <vector>

#include "tools/report/rock_judge.hpp"

namespace rover::report {

constexpr double kRealRockM = 0.12;    // a stop for a rock this tall is not a false one
constexpr double kRealReachM = 0.35;   // from a cell that caused the stop to the rock's rim
constexpr double kRealReliefM = 0.12;  // as much step or hole in the ground is a cause as well

struct Incident {
  double t_s = 0.0;
  bool stopped = false;  // HAZARD_STOP, else the path was repaired under way
  bool replanned = false;
  bool unseen = false;          // ground that was never seen stood in the way, no hazard
  bool real = false;            // there was a rock, a step or a hole
  double tallest_rock_m = 0.0;  // of those that the cells stand for
  Points cells;                 // middles of the hazard cells that caused it, where they truly are
  Points old_path;              // followed before, where it truly lies
  Points new_path;              // empty where none came
  bool is_false() const { return !real && !unseen; }
};

std::vector<Incident> judge_stops(const RunRecord& run, const TrueTrack& truth, const Window& window,
                                  const Footprint& footprint, const TrueWorld& world);

// Path followed at t, where it truly lies: paths are in the rover's frames, and those are off by its errors.
Points followed_path(const RunRecord& run, const TrueTrack& truth, double t_s);
// Path as given, where it truly lies for the rover at t.
Points path_in_truth(const RunRecord& run, const TrueTrack& truth, const PathRecord& path, double t_s);

}  // namespace rover::report
