// Reads ground.yaml: what the ground believes and wants. It holds nothing of the true world.
#pragma once

#include <string>

#include "mission_control/orders.hpp"

namespace rover {

struct MissionPlan {
  StartPose start;
  GlobalPath path;
};

MissionPlan load_mission_plan(const std::string& config_dir);

}  // namespace rover
