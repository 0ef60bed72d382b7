#include "supervisor/config.hpp"

#include <algorithm>
#include <set>
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

using enum State;

constexpr StateSet kMotion = {kDriving, kHazardStop, kRepairing, kSweeping, kFaultStop, kTeleop};
// All states but BOOT: no row is evaluated before every input has arrived once.
constexpr StateSet kAlways = {kStandby, kDriving,     kHazardStop, kRepairing, kSweeping,
                              kPaused,  kGoalReached, kFaultStop,  kSafe,      kTeleop};

const std::vector<std::string> kResponses = {"log",  "slow",        "stop", "stop_replan", "restart_service",
                                             "safe", "stop_retreat"};

void read_armed(const Config& c, MonitorRow& row) {
  const std::string armed = c.has("armed") ? c.one_of("armed", {"always", "under_way", "motion", "full", "efficient"})
                                           : std::string("always");
  const bool always = armed == "always" || armed == "efficient";
  row.armed = always ? kAlways : armed == "motion" ? kMotion : kUnderWayOrFaultStop;
  if (armed == "full") row.level = Level::kFull;
  if (armed == "efficient") row.level = Level::kEfficient;
}

FdirLine read_line(const Config& c, const Vehicle& vehicle) {
  FdirLine line;
  MonitorRow& row = line.row;
  row.id = c.text("id");
  line.quantity = c.text("quantity");
  const Quantity* quantity = find_quantity(line.quantity);
  if (quantity == nullptr) c.fail("quantity", "'" + line.quantity + "' is not a quantity that the supervisor knows");
  row.limit = c.number("limit", {0.0, 1e6});
  c.read("n", row.n, {1, 64});
  row.m = row.n;
  c.read("m", row.m, {1, 64});
  if (row.n > row.m) c.fail("n", "is larger than m");
  c.read("persistence_s", row.persistence_s, {0.0, 600.0});
  c.read("clear_s", row.clear_s, {0.0, 600.0});
  c.read("latched", row.latched);
  const std::string response = c.one_of("response", kResponses);
  row.response = static_cast<Response>(std::find(kResponses.begin(), kResponses.end(), response) - kResponses.begin());
  if (c.has("back_limit")) row.backtrack_limit = c.number("back_limit", {row.limit, 1e6});
  if (c.has("back_limit") && row.response != Response::kStopBacktrack) c.fail("back_limit", "belongs to stop_retreat");
  if (row.response == Response::kSlow) row.slow_mps = c.number("slow_mps", {0.01, vehicle.top_speed_mps});
  const bool of_service =
      quantity->expansion == Expansion::kEachRequired || quantity->expansion == Expansion::kEachFull;
  if (row.response == Response::kRestartService && !of_service) c.fail("response", "no service to start anew");
  c.read("stops", row.stops);
  if (!row.stops && row.response != Response::kRestartService) c.fail("stops", "belongs to restart_service");
  read_armed(c, row);
  return line;
}

// Skips IMU rows if the vehicle has no IMU. Motor current limits must not exceed those of vehicle.yaml.
std::vector<FdirLine> read_lines(const std::string& config_dir, const Vehicle& vehicle) {
  const bool has_imu = Config::load(config_dir + "/vehicle.yaml").has("imu");
  const Config config = Config::load(config_dir + "/fdir.yaml");
  std::vector<FdirLine> lines;
  std::set<std::string> ids;
  for (const Config& c : config.list("rows")) {
    const FdirLine line = read_line(c, vehicle);
    if (!ids.insert(line.row.id).second) c.fail("id", "'" + line.row.id + "' is there twice");
    if (line.quantity == "drive_current_a" && line.row.limit > vehicle.drive_current_limit_a)
      c.fail("limit", "is above drive.current_limit_a of vehicle.yaml");
    if (line.quantity == "steer_current_a" && line.row.limit > vehicle.steer_current_limit_a)
      c.fail("limit", "is above steering.current_limit_a of vehicle.yaml");
    if (has_imu || line.quantity.rfind("imu_", 0) != 0) lines.push_back(line);
  }
  config.finish();
  return lines;
}

// Inputs required for a permit must not be older than the stopping rows allow; without such a row the default applies.
void apply_row_age(const std::vector<FdirLine>& lines, const std::string& quantity, double& max_age_s) {
  double smallest_s = kInfinity;
  for (const FdirLine& line : lines)
    if (line.quantity == quantity && line.row.response >= Response::kStop)
      smallest_s = std::min(smallest_s, line.row.limit + line.row.persistence_s);
  if (std::isfinite(smallest_s)) max_age_s = smallest_s;
}

void apply_row_ages(SupervisorConfig& out) {
  apply_row_age(out.fdir.lines, "pose_age_s", out.pose_max_age_s);
  apply_row_age(out.fdir.lines, "planner_age_s", out.planner_max_age_s);
  apply_row_age(out.fdir.lines, "control_age_s", out.control_max_age_s);
  apply_row_age(out.fdir.lines, "wheel_state_age_s", out.wheels_max_age_s);
  apply_row_age(out.fdir.lines, "hazards_age_s", out.hazards_max_age_s);
  apply_row_age(out.fdir.lines, "heartbeat_age_s", out.heartbeat_max_age_s);
}

// Applies whatever the response of the row is: without a recent map the rover stops to sweep.
void apply_terrain_distance(SupervisorConfig& out) {
  for (const FdirLine& line : out.fdir.lines)
    if (line.quantity == "terrain_way_m")
      out.terrain_max_distance_m = std::min(out.terrain_max_distance_m, line.row.limit);
}

void read_level(const Config& c, LevelConfig& out) {
  c.read("window_s", out.window_s, {5.0, 3600.0});
  c.read("slow_mps", out.slow_mps, {0.0, 1.0});
  c.read("hazards_per_m", out.hazards_per_m, {0.0, 100.0});
  c.read("least_hazards", out.min_hazards, {1.0, 1000.0});
  c.read("easy_difficulty", out.easy_difficulty, {0.0, 1.0});
  c.read("easy_way_m", out.easy_distance_m, {0.0, 1000.0});
  c.read("failing_starts", out.failing_starts, {1.0, 100.0});
  c.read("failing_sweep_s", out.failing_sweep_s, {1.0, 600.0});
}

void read_sweep(const Config& c, SupervisorConfig& out) {
  c.read("known_ahead", out.terrain_known_ahead, {0.01, 1.0});
  c.read("known_around", out.terrain_known_around, {0.01, 1.0});
  c.read("patience_s", out.sweep_timeout_s, {1.0, 600.0});
}

void read_hazard_stop(const Config& c, SupervisorConfig& out) {
  c.read("hazard_m", out.hazard_stop_m, {0.1, 5.0});
  c.read("unseen_m", out.unseen_stop_m, {0.05, 5.0});
  c.read("hysteresis_m", out.stop_hysteresis_m, {0.0, 2.0});
  c.read("standing_speed_mps", out.stationary_speed_mps, {0.001, 0.1});
  c.read_deg("standing_rate_degps", out.stationary_rate_radps, {0.05, 10.0});
}

void apply_vehicle(const Vehicle& vehicle, SupervisorConfig& out) {
  out.max_speed_mps = vehicle.top_speed_mps;
  out.derived.drive_nominal_a = vehicle.drive_current_nominal_a;
  out.derived.steer_nominal_a = vehicle.steer_current_nominal_a;
  out.derived.wheel_radius_m = vehicle.wheel_radius_m;
}

}  // namespace

SupervisorConfig load_config(const std::string& config_dir) {
  const Vehicle vehicle = load_vehicle(config_dir);
  SupervisorConfig out;
  apply_vehicle(vehicle, out);
  out.fdir.lines = read_lines(config_dir, vehicle);
  apply_row_ages(out);
  apply_terrain_distance(out);
  const Config config = Config::load(config_dir + "/supervisor.yaml");
  out.fdir.required_services = split(config.text("required_services"));
  out.fdir.optional_services = split(config.text("optional_services"));
  out.fdir.full_services = split(config.text("full_services"));
  config.read("max_speed_mps", out.max_speed_mps, {0.01, vehicle.top_speed_mps});
  config.read("teleop_speed_mps", out.teleop_speed_mps, {0.01, vehicle.top_speed_mps});
  config.read("teleop_max_age_s", out.teleop_max_age_s, {0.1, 5.0});
  config.read("permit_validity_s", out.permit_validity_s, {0.04, 0.2});
  config.read("goal_tolerance_m", out.goal_tolerance_m, {0.05, 5.0});
  read_hazard_stop(config.section("hazard_stop"), out);
  read_sweep(config.section("sweep"), out);
  read_level(config.section("level"), out.level);
  const Config restarts = config.section("restarts");
  restarts.read("patience_s", out.restarter.retry_interval_s, {1.0, 60.0});
  restarts.read("window_s", out.restarter.window_s, {1.0, 3600.0});
  out.derived.start_window_s = out.restarter.window_s;
  config.section("motors").read("thermal_time_s", out.derived.thermal_time_s, {1.0, 3600.0});
  config.finish();
  return out;
}

}  // namespace rover::supervisor
