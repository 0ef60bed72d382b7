// The ground's side of the bus: gives the orders of a mission plan.
#pragma once

#include <rover/command_ack_t.hpp>
#include <rover/supervisor_state_t.hpp>

#include "common/bus/node.hpp"
#include "mission_control/config.hpp"

namespace rover {

class MissionControlNode {
 public:
  MissionControlNode(Node& node, MissionPlan plan);

 private:
  void on_ack(const command_ack_t& ack);
  void step(Utime now);
  void give(const Orders::Given& given);
  void publish_start_pose(std::int64_t command_id);
  void publish_path(std::int64_t command_id);
  void publish_go(std::int64_t command_id);

  Node& node_;
  MissionPlan plan_;
  Orders orders_;
  bool standby_ = false;
};

}  // namespace rover
