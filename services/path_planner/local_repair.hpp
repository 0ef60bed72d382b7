// Local path repair: a way from the rover around the known hazards back to the global path. Travel costs by fast
// marching from the poses at which the path may be joined (Azkarate et al. 2020), a way down that field for a vehicle
// that turns on arcs, smoothing, and the exact test of the swept rectangle.
#pragma once

#include <string>
#include <vector>

#include "path_planner/arc_search.hpp"
#include "path_planner/route.hpp"
#include "path_planner/smoother.hpp"

namespace rover::planning {

inline constexpr double kPoseStepM = 0.05;  // between the poses of a way that are tested

struct LocalRepairConfig {
  Footprint footprint;
  ViewArea view;
  double rejoin_within_m = 4.0;   // past the first place where the global path is clear; 0: as soon as possible
  double turn_extra_m = 0.04;     // of the margin, for point turns: the rover does not halt exactly
  double dead_end_reach_m = 0.8;  // around a place from which the rover had to go back ...
  double dead_end_cost = 4.0;     // ... ground costs that much more per metre
  double max_deviation_m = 4.0;   // from the global path
  double risk_distance_m = 1.0;   // clearance below which ground costs more
  double risk_cost = 1.5;         // per metre more, at the margin
  double unseen_cost = 0.6;       // per metre more
  ArcSearchConfig search;
  SmootherConfig smoother;
};

struct RepairRequest {
  const Terrain& terrain;
  const Route& global;  // in odom
  double from_m = 0.0;  // along it: where the rover is
  Pose2 start;          // where the rover will be when the path is released
  double start_curvature_per_m = 0.0;
  Pose2 stopped;  // ... and where it would come to rest
  double margin_m = 0.0;
  double sure_m = kInfinity;  // way that must lie over ground seen in time; further on it only costs more
  double goal_reach_m = 0.0;  // the way may end that far from the goal; what it misses it by costs
  std::vector<DeadEnd> dead_ends;
};

enum class RepairStatus { kFound, kNoTarget, kNoWay, kUnseen };

struct RepairResult {
  RepairStatus status = RepairStatus::kNoWay;
  std::vector<Pose2> poses;  // from the start, every 5 cm, to the global path or the goal
  double join_m = kNaN;      // along the global path
  bool turns_first = false;  // the path starts with a point turn
  int halts = 0;             // for point turns on the way
  bool smoothed = false;
  double clearance_m = kNaN;  // least distance of the rectangle to a hazard's cell
  int expansions = 0;
};

const char* text_of(RepairStatus status);

class LocalRepair {
 public:
  explicit LocalRepair(const LocalRepairConfig& config) : config_(config) {}
  RepairResult plan(const RepairRequest& request) const;

 private:
  std::vector<JoinTarget> join_targets(const RepairRequest& request, const FootprintCheck& check) const;
  MarchGrid travel_costs(const RepairRequest& request, const FootprintCheck& check) const;
  double ground_cost(const Terrain& terrain, int cell, double margin_m, bool near) const;
  std::vector<Pose2> best_poses(const RepairRequest& request, const FootprintCheck& check, const SearchResult& way,
                                bool& smoothed) const;

  std::vector<Pose2> smoothed_section(const RepairRequest& request, const WaySection& section,
                                      double curvature_per_m) const;

  LocalRepairConfig config_;
};

// Whether the rectangle stays clear along the poses and covers, for the first `sure_m`, no ground that would not have
// been seen before.
bool verified(const std::vector<Pose2>& poses, const FootprintCheck& check, const ViewArea& view, double sure_m);
// Way along the poses until ground is covered that would not have been seen before; infinity: none.
double seen_way_m(const std::vector<Pose2>& poses, const FootprintCheck& check, const ViewArea& view);

}  // namespace rover::planning
