#include "supervisor/config.hpp"

#include <sstream>

#include "common/bus/config.hpp"
#include "common/bus/vehicle_config.hpp"

namespace rover::supervisor {
namespace {

std::vector<std::string> split(const std::string& words) {
  std::vector<std::string> out;
  std::istringstream in(words);
  for (std::string word; in >> word;) out.push_back(word);
  return out;
}

void read_ages(const Config& c, SupervisorConfig& out) {
  c.read("pose_s", out.pose_max_age_s, {0.02, 5.0});
  c.read("hazards_s", out.hazards_max_age_s, {0.1, 10.0});
  c.read("planner_status_s", out.planner_max_age_s, {0.02, 5.0});
  c.read("control_status_s", out.control_max_age_s, {0.02, 5.0});
  c.read("heartbeat_s", out.heartbeat_max_age_s, {0.2, 30.0});
}

void read_faults(const Config& c, SupervisorConfig& out) {
  c.read("blind_frames", out.blind_frames, {1, 100});
  c.read("path_mismatch_s", out.path_mismatch_s, {0.1, 10.0});
  c.read("no_path_s", out.no_path_s, {1.0, 600.0});
  c.read("blocked_s", out.blocked_s, {1.0, 600.0});
  c.read("clear_confirm_s", out.clear_confirm_s, {0.0, 60.0});
  c.read("slip_limit", out.slip_limit, {0.05, 1.0});
  c.read("slip_persistence_s", out.slip_persistence_s, {0.0, 60.0});
}

void read_hazard_stop(const Config& c, SupervisorConfig& out) {
  c.read("hazard_m", out.hazard_stop_m, {0.1, 5.0});
  c.read("unseen_m", out.unseen_stop_m, {0.05, 5.0});
  c.read("hysteresis_m", out.stop_hysteresis_m, {0.0, 2.0});
  c.read("standing_speed_mps", out.standing_speed_mps, {0.001, 0.1});
  c.read_deg("standing_rate_degps", out.standing_rate_radps, {0.05, 10.0});
}

}  // namespace

SupervisorConfig load_config(const std::string& config_dir) {
  const Vehicle vehicle = load_vehicle(config_dir);
  SupervisorConfig out;
  out.max_speed_mps = vehicle.top_speed_mps;
  const Config config = Config::load(config_dir + "/supervisor.yaml");
  out.required_services = split(config.text("required_services"));
  config.read("max_speed_mps", out.max_speed_mps, {0.01, vehicle.top_speed_mps});
  config.read("permit_validity_s", out.permit_validity_s, {0.04, 0.2});
  config.read("goal_tolerance_m", out.goal_tolerance_m, {0.05, 5.0});
  read_ages(config.section("max_age"), out);
  read_faults(config.section("faults"), out);
  read_hazard_stop(config.section("hazard_stop"), out);
  config.finish();
  return out;
}

}  // namespace rover::supervisor
