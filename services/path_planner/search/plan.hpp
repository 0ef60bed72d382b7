// A plan and what it is asked for. A planner is a pure function of its request.
#pragma once

#include <memory>
#include <vector>

#include "path_planner/map/costmap.hpp"
#include "path_planner/route.hpp"
#include "path_planner/side_slip.hpp"

namespace rover::planning {

// A pose of a plan, every few cm. Two at one place: a point turn.
struct PlanPose {
  Pose2 pose;                // in odom
  bool reverse = false;      // how the rover gets there from the pose before
  double motion_cost = 0.0;  // of curvature, steering, point turns and changes of direction up to here [s]
};

struct Plan {
  bool found = false;
  bool keeps_incumbent = false;      // no other plan is better by the switching cost
  bool needs_unseen_ground = false;  // not found, but paths were dropped whose ground does not come into view
  bool closed_in = false;            // not found, and no pose from which the goal can be reached is reachable
  std::vector<PlanPose> poses;       // from the start of the request
  double cost = kInfinity;           // to the goal [s]
  double clearance_m = kNaN;         // smallest distance of the footprint to the centre of a hazard cell
  int expansions = 0;
};

// Where a plan to back up may end.
struct BackUpPlace {
  Point2 p;
  double cost_s = 0.0;  // of ending there
};

struct PlanRequest {
  std::shared_ptr<const Costmap> costmap;
  std::shared_ptr<const Route> global_path;  // in odom
  double global_progress_m = 0.0;            // along it, of the rover
  Pose2 rover;
  Pose2 start;  // where the committed part of the active path ends
  double start_curvature_per_m = 0.0;
  bool start_reverse = false;        // the rover comes to the start in reverse
  bool turning = false;              // stopped in a point turn there, which may go on or back by any angle
  std::vector<Pose2> views;          // poses from which the LocCam looks on the way from the rover to the start
  std::vector<BackUpPlace> back_to;  // the goal instead of that of the global path, over known ground; empty: none
  double goal_tolerance_m = 0.0;
  SideSlip side_slip;
  std::vector<PlanPose> incumbent;  // the active plan from the start on; empty: none
};

class Planner {
 public:
  virtual ~Planner() = default;
  virtual Plan plan(const PlanRequest& request) const = 0;
};

}  // namespace rover::planning
