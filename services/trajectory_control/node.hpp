// Trajectory control on the bus: PATH, POSE and DRIVE_PERMIT in, MOTION_COMMAND and CONTROL_STATUS out each tick. In
// the state TELEOP the operator's commands take the place of the path.
#pragma once

#include <rover/ground_command_t.hpp>
#include <rover/path_t.hpp>

#include "common/bus/node.hpp"
#include "trajectory_control/teleop.hpp"
#include "trajectory_control/trajectory_controller.hpp"

namespace rover::control {

class TrajectoryControlNode {
 public:
  TrajectoryControlNode(Node& node, const TrajectoryControlConfig& config);

 private:
  void on_path(const path_t& message);
  void on_ground_command(const ground_command_t& message);
  void step(Utime now);
  void report(const ControlOutput& output);

  Node& node_;
  TrajectoryControlConfig config_;
  TrajectoryController controller_;
  PoseInput pose_;
  DrivePermit permit_;
  bool teleoperated_ = false;
  TeleopInput teleop_;
  ControlState state_ = ControlState::kIdle;
};

}  // namespace rover::control
