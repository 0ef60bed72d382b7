#include "trajectory_control/node.hpp"

#include <rover/supervisor_state_t.hpp>
#include <string>

#include "common/bus/convert.hpp"
#include "trajectory_control/convert.hpp"

namespace rover::control {
namespace {

const char* text_of(ControlState state) {
  switch (state) {
    case ControlState::kIdle:
      return "IDLE";
    case ControlState::kFollowing:
      return "FOLLOWING";
    case ControlState::kPointTurn:
      return "POINT_TURN";
    case ControlState::kPathEnd:
      return "PATH_END";
    case ControlState::kStalePose:
      return "STALE_POSE";
    case ControlState::kOutOfCorridor:
      return "OUT_OF_CORRIDOR";
    case ControlState::kNoPermit:
      return "NO_PERMIT";
  }
  return "?";
}

}  // namespace

TrajectoryControlNode::TrajectoryControlNode(Node& node, const TrajectoryControlConfig& config)
    : node_(node), config_(config), controller_(config) {
  node_.subscribe<path_t>(channel::kPath, [this](const path_t& m) { on_path(m); });
  node_.subscribe<pose_t>(channel::kPose, [this](const pose_t& m) { pose_ = pose_from(m, config_.origin_height_m); });
  node_.subscribe<drive_permit_t>(channel::kDrivePermit, [this](const drive_permit_t& m) { permit_ = permit_from(m); });
  node_.subscribe<ground_command_t>(channel::kGroundCommand,
                                    [this](const ground_command_t& m) { on_ground_command(m); });
  node_.subscribe<supervisor_state_t>(channel::kState, [this](const supervisor_state_t& m) {
    teleoperated_ = m.state == supervisor_state_t::TELEOP;
    controller_.set_teleoperated(teleoperated_);
  });
  node_.on_step([this](Utime now) { step(now); });
}

void TrajectoryControlNode::on_path(const path_t& message) {
  const bool accepted = controller_.set_path(path_from(message));
  if (!accepted) node_.reject(channel::kPath, "not a path in odom");
  node_.log(accepted ? "INFO" : "ERROR", "PATH id=" + std::to_string(message.path_id) + " points=" +
                                             std::to_string(message.point_count) + (accepted ? "" : " refused"));
}

// Only the supervisor acknowledges ground commands.
void TrajectoryControlNode::on_ground_command(const ground_command_t& message) {
  if (message.kind == ground_command_t::TELEOP)
    teleop_ = {message.header.utime, message.speed_mps, message.curvature_per_m};
}

void TrajectoryControlNode::step(Utime now) {
  const ControlOutput output = controller_.step(now, pose_, permit_);
  motion_command_t command{};
  command_to(teleoperated_ ? teleop_command(now, teleop_, permit_, config_) : output.command, command);
  node_.publish(channel::kMotionCommand, command, now);
  control_status_t status{};
  status_to(output, status);
  node_.publish(channel::kControlStatus, status, now);
  report(output);
}

void TrajectoryControlNode::report(const ControlOutput& output) {
  if (output.state == state_) return;
  state_ = output.state;
  node_.log("INFO", std::string("CONTROL state=") + text_of(state_) + " path=" + std::to_string(output.path_id) +
                        " s_m=" + std::to_string(output.arc_length_m) +
                        " cross_track_m=" + std::to_string(output.cross_track_m));
}

}  // namespace rover::control
