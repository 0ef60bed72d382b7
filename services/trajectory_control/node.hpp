// LCM node: subscribes to PATH, POSE, DRIVE_PERMIT; publishes MOTION_COMMAND and CONTROL_STATUS each tick. In the
// supervisor state TELEOP it sends the operator's commands instead of following the path.
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
