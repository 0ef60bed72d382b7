// Reads ground.yaml (start pose estimate and path; no ground truth), mission_control.yaml, and the parameters of other
// files that the page displays.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "common/bus/parameters.hpp"
#include "common/core/vehicle.hpp"
#include "mission_control/command.hpp"
#include "mission_control/ground_map.hpp"
#include "mission_control/http_server.hpp"
#include "mission_control/mission_sequence.hpp"
#include "mission_control/request_guard.hpp"

namespace rover {

struct MissionPlan {
  StartPose start;
  GlobalPath path;
};

MissionPlan load_mission_plan(const std::string& config_dir);

namespace mission {

// Limits and defaults for paths drawn by the operator.
struct OperatorPathConfig {
  double corridor_half_width_m = 1.5;
  double goal_tolerance_m = 0.5;
  double max_length_m = 2000.0;
  SlopeLimits slope;
  CommandLimits limits;
};

struct PageConfig {
  bool served = true;
  GuardConfig guard;
  int max_pages = 16;
  ServerLimits limits;  // the number of connections is derived from max_pages
  OperatorPathConfig path;
};

// Throws ConfigError if a non-loopback address has no token file.
PageConfig load_config(const std::string& config_dir, ParameterList* list = nullptr);
// Reads the token. Throws ConfigError if others can read the file (mode not 0600) or the token is too short.
std::string load_token(const std::string& file);

// Constant vehicle, limit and camera parameters that the page draws.
nlohmann::json page_setup(const std::string& config_dir, const Vehicle& vehicle);

}  // namespace mission
}  // namespace rover
