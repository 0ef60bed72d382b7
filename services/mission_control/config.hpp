// Reads ground.yaml (what the ground believes and wants; it holds nothing of the true world), mission_control.yaml, and
// what the page shows of the other files.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "common/core/vehicle.hpp"
#include "mission_control/command.hpp"
#include "mission_control/ground_map.hpp"
#include "mission_control/http_server.hpp"
#include "mission_control/orders.hpp"
#include "mission_control/request_guard.hpp"

namespace rover {

struct MissionPlan {
  StartPose start;
  GlobalPath path;
};

MissionPlan load_mission_plan(const std::string& config_dir);

namespace mission {

// Of paths that the operator draws.
struct DrawnPath {
  double corridor_half_width_m = 1.5;
  double goal_tolerance_m = 0.5;
  double longest_m = 2000.0;
  SlopeLimits slope;
  CommandLimits limits;
};

struct PageConfig {
  bool served = true;
  GuardConfig guard;
  int most_pages = 16;
  ServerLimits limits;  // but for the number of connections, which follows from most_pages
  DrawnPath path;
};

// Throws ConfigError: an address that others can reach needs a token in a file of mode 0600.
PageConfig load_page_config(const std::string& config_dir);
// The token of the file. Throws ConfigError where it may be read by others or is too short.
std::string load_token(const std::string& file);

// What of the vehicle, the limits and the cameras the page draws; it does not change.
nlohmann::json page_setup(const std::string& config_dir, const Vehicle& vehicle);

}  // namespace mission
}  // namespace rover
