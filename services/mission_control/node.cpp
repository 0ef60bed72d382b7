#include "mission_control/node.hpp"

#include <rover/ground_command_t.hpp>
#include <rover/path_t.hpp>

namespace rover {
namespace {

ground_command_t command(std::int8_t kind, std::int64_t command_id) {
  ground_command_t message{};
  message.kind = kind;
  message.command_id = command_id;
  message.level = ground_command_t::AUTO;
  return message;
}

}  // namespace

MissionControlNode::MissionControlNode(Node& node, MissionPlan plan) : node_(node), plan_(std::move(plan)) {
  node_.subscribe<command_ack_t>(channel::kCommandAck, [this](const command_ack_t& ack) { on_ack(ack); });
  node_.subscribe<supervisor_state_t>(channel::kState, [this](const supervisor_state_t& state) {
    standby_ = state.state == supervisor_state_t::STANDBY;
  });
  node_.on_step([this](Utime now) { step(now); });
}

void MissionControlNode::on_ack(const command_ack_t& ack) {
  if (!orders_.acknowledge(ack.command_id, ack.accepted != 0, ack.reason)) return;
  node_.log(ack.accepted ? "INFO" : "WARN",
            "ORDER id=" + std::to_string(ack.command_id) + (ack.accepted ? " accepted" : " refused: " + ack.reason));
  node_.set_status(ack.accepted ? heartbeat_t::OK : heartbeat_t::DEGRADED, orders_.refusal());
}

void MissionControlNode::step(Utime now) {
  if (const auto given = orders_.step(now, standby_)) give(*given);
}

void MissionControlNode::give(const Orders::Given& given) {
  switch (given.order) {
    case Order::kStartPose:
      return publish_start_pose(given.command_id);
    case Order::kPath:
      return publish_path(given.command_id);
    case Order::kGo:
      return publish_go(given.command_id);
  }
}

void MissionControlNode::publish_start_pose(std::int64_t command_id) {
  ground_command_t message = command(ground_command_t::SET_START_POSE, command_id);
  message.position_map_m[0] = plan_.start.pose.x_m;
  message.position_map_m[1] = plan_.start.pose.y_m;
  message.position_map_m[2] = plan_.start.z_m;
  message.yaw_rad = plan_.start.pose.yaw_rad;
  message.sigma_m = plan_.start.sigma_m;
  message.sigma_yaw_rad = plan_.start.sigma_yaw_rad;
  message.clear_radius_m = plan_.start.clear_radius_m;
  node_.publish(channel::kGroundCommand, message, node_.now());
}

void MissionControlNode::publish_path(std::int64_t command_id) {
  path_t message{};
  message.path_id = command_id;
  message.frame = path_t::MAP;
  message.kind = path_t::GLOBAL;
  message.corridor_half_width_m = plan_.path.corridor_half_width_m;
  message.goal_tolerance_m = plan_.path.goal_tolerance_m;
  message.point_count = static_cast<std::int32_t>(plan_.path.x_m.size());
  message.x_m = plan_.path.x_m;
  message.y_m = plan_.path.y_m;
  message.level = plan_.path.level;
  node_.publish(channel::kGlobalPath, message, node_.now());
}

void MissionControlNode::publish_go(std::int64_t command_id) {
  ground_command_t message = command(ground_command_t::GO, command_id);
  node_.publish(channel::kGroundCommand, message, node_.now());
}

}  // namespace rover
