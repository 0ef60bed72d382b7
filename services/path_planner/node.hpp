// The path planner on the bus: GLOBAL_PATH, POSE, HAZARDS, the start pose, and for the Full level STATE and
// TRAVERSABILITY in; PATH and PLANNER_STATUS out.
#pragma once

#include <rover/fault_t.hpp>
#include <rover/ground_command_t.hpp>
#include <rover/hazards_t.hpp>
#include <rover/path_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/supervisor_state_t.hpp>
#include <rover/traversability_t.hpp>
#include <string>
#include <vector>

#include "common/bus/checkpoint_store.hpp"
#include "common/bus/dead_reckoned_distance.hpp"
#include "common/bus/node.hpp"
#include "path_planner/path_planner.hpp"

namespace rover::planning {

class PathPlannerNode {
 public:
  PathPlannerNode(Node& node, const PathPlannerConfig& config);

 private:
  void on_global_path(const path_t& message);
  void on_pose(const pose_t& message);
  void on_hazards(const hazards_t& message);
  void on_traversability(const traversability_t& message);
  void on_state(const supervisor_state_t& message);
  void on_fault(const fault_t& message);
  void on_ground_command(const ground_command_t& message);
  void step(Utime now);
  void tell_path(const LocalPath& path);
  void repeat_path(Utime now, bool at_once);
  void report(const PlannerStatus& status);

  Node& node_;
  CheckpointStore checkpoint_;
  Utime path_latency_;
  double origin_height_m_;
  DeadReckonedDistance dead_reckoned_;
  PathPlanner planner_;
  path_t path_{};  // the newest; no points: none
  Utime next_repeat_ = 0;
  Utime told_at_ = kNever;      // of the newest path
  Utime waits_since_ = kNever;  // in a state in which a fault may be waited out; kNever: the rover may go
  PlannerState state_ = PlannerState::kIdle;
  std::string text_;
};

}  // namespace rover::planning
