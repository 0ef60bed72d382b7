#include "supervisor/config.hpp"

#include <algorithm>
#include <set>
#include <sstream>

#include "common/bus/config.hpp"
#include "common/bus/navigation_config.hpp"
#include "common/bus/service_names.hpp"
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
// All states but BOOT: no row is evaluated before the inputs of inputs_ready() have arrived.
constexpr StateSet kAlways = {kStandby, kDriving,     kHazardStop, kRepairing, kSweeping,
                              kPaused,  kGoalReached, kFaultStop,  kSafe,      kTeleop};

const std::vector<std::string> kResponses = {"log",  "slow",          "stop", "stop_replan", "restart_service",
                                             "safe", "stop_backtrack"};

void read_armed(const Config& c, MonitorRow& row) {
  const std::string armed =
      c.has("armed") ? c.one_of("armed", {"always", "drive", "motion", "full", "efficient"}) : std::string("always");
  const bool always = armed == "always" || armed == "efficient";
  row.armed = always ? kAlways : armed == "motion" ? kMotion : kUnderWayOrFaultStop;
  if (armed == "full") row.level = Level::kFull;
  if (armed == "efficient") row.level = Level::kEfficient;
}

FdirLine read_line(const Config& c, const Vehicle& vehicle, double cpu_scale) {
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
  if (c.has("backtrack_limit")) row.backtrack_limit = c.number("backtrack_limit", {row.limit, 1e6});
  if (c.has("backtrack_limit") && row.response != Response::kStopBacktrack)
    c.fail("backtrack_limit", "belongs to stop_backtrack");
  if (row.response == Response::kSlow) row.slow_mps = c.number("slow_mps", {0.01, vehicle.top_speed_mps});
  const bool of_service =
      quantity->expansion == Expansion::kEachRequired || quantity->expansion == Expansion::kEachFull;
  if (row.response == Response::kRestartService && !of_service)
    c.fail("response", "restart_service needs a quantity of required_services or full_services");
  c.read("stops", row.stops);
  if (!row.stops && row.response != Response::kRestartService) c.fail("stops", "belongs to restart_service");
  read_armed(c, row);
  if (quantity->of_computing) row.limit *= cpu_scale;
  return line;
}

// Skips IMU rows if the vehicle has no IMU. Motor current limits must not exceed those of vehicle.yaml.
std::vector<FdirLine> read_lines(const std::string& config_dir, const Vehicle& vehicle, double cpu_scale) {
  const bool has_imu = Config::load(config_dir + "/vehicle.yaml").has("imu");
  const Config config = Config::load(config_dir + "/fdir.yaml");
  std::vector<FdirLine> lines;
  std::set<std::string> ids;
  for (const Config& c : config.list("rows")) {
    const FdirLine line = read_line(c, vehicle, cpu_scale);
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
    if (line.quantity == "terrain_distance_m")
      out.terrain_max_distance_m = std::min(out.terrain_max_distance_m, line.row.limit);
}

void add_words(Parameters& p, const std::string& key, std::vector<std::string>& words, const std::string& meaning) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  p.add(key, text, meaning);
  words = split(text);
}

void add_services(Parameters& p, FdirConfig& c) {
  add_words(p, "required_services", c.required_services, "the rover stops without one of them");
  add_words(p, "optional_services", c.optional_services, "the rover drives on without them");
  add_words(p, "full_services", c.full_services, "also required at the Full level");
}

void add_hazard_stop(Parameters& p, SupervisorConfig& c) {
  p.add("stop_distance_m", c.stop_distance_m, {0.1, 5.0},
        "the rover stops at this distance to a hazard or unseen ground along the path, to which it brakes");
  p.add("advance_per_frame_m", c.advance_per_frame_m, {0.02, 1.0},
        "the rover drives at most this far from one frame of HAZARDS to the next");
  p.add("stop_hysteresis_m", c.stop_hysteresis_m, {0.0, 2.0}, "added for resuming, unless the path is new");
  p.add("stationary_speed_mps", c.stationary_speed_mps, {0.001, 0.1}, "below it and the next the rover is stationary");
  p.add_deg("stationary_rate_degps", c.stationary_rate_radps, {0.05, 10.0}, "yaw rate");
}

void add_sweep(Parameters& p, SupervisorConfig& c) {
  p.add("terrain_known_ahead", c.terrain_known_ahead, {0.01, 1.0},
        "known fraction of the Full-level map ahead, 1.2 to 3 m; below it the rover stops and sweeps");
  p.add("terrain_known_around", c.terrain_known_around, {0.01, 1.0},
        "known fraction on each side, 1.5 to 4 m, that ends a sweep ...");
  p.add("sweep_around_s", c.sweep_around_s, {1.0, 600.0},
        "... or, after this time, the first alone; a whole sweep takes 17 s");
}

void add_level(Parameters p, LevelConfig& c) {
  p.add("window_s", c.window_s, {5.0, 3600.0}, "driving time over which progress and hazards are measured");
  p.add("slow_mps", c.slow_mps, {0.0, 1.0}, "lower progress towards the goal: raise");
  p.add("hazards_per_m", c.hazards_per_m, {0.0, 100.0}, "more hazard stops and repairs: raise");
  p.add("min_hazards", c.min_hazards, {1, 1000}, "minimum number of them in the window");
  p.add("easy_difficulty", c.easy_difficulty, {0.0, 1.0}, "lower terrain difficulty ahead ...");
  p.add("easy_distance_m", c.easy_distance_m, {0.0, 1000.0}, "... over this distance: lower");
  p.add("failing_starts", c.failing_starts, {1, 100}, "starts of one of full_services within restarts.window_s: lower");
  p.add("failing_sweep_s", c.failing_sweep_s, {1.0, 600.0}, "sweep without known ground for this long: lower");
  p.add("linger_s", c.linger_s, {1.0, 1e6}, "services of the Full level are stopped after so long without need");
}

void add_restarts(Parameters p, ServiceRestarterConfig& c) {
  p.add("retry_interval_s", c.retry_interval_s, {1.0, 60.0}, "time until the next attempt to restart it");
  p.add("window_s", c.window_s, {1.0, 3600.0}, "attempts and starts are counted over it");
}

void apply_vehicle(const Vehicle& vehicle, SupervisorConfig& out) {
  out.origin_height_m = vehicle.origin_height_m;
  out.max_speed_mps = vehicle.top_speed_mps;
  out.deceleration_mps2 = vehicle.deceleration_mps2;
  out.footprint_half_length_m = vehicle.footprint_half_length_m();
  out.footprint_half_width_m = vehicle.footprint_half_width_m();
  out.derived.drive_nominal_a = vehicle.drive_current_nominal_a;
  out.derived.steer_nominal_a = vehicle.steer_current_nominal_a;
  out.derived.wheel_radius_m = vehicle.wheel_radius_m;
}

}  // namespace

SupervisorConfig load_config(const std::string& config_dir, ParameterList* list) {
  const Vehicle vehicle = load_vehicle(config_dir);
  const NavigationConfig navigation = load_navigation(config_dir);
  SupervisorConfig c;
  apply_vehicle(vehicle, c);
  c.goal_tolerance_m = navigation.goal_tolerance_m;
  c.teleop_max_age_s = navigation.teleop_max_age_s;
  Parameters p(config_dir + "/supervisor.yaml",
               "Supervisor without its fault table (fdir.yaml). Top speed and motor data come from vehicle.yaml, goal "
               "tolerance and age of operator commands from navigation.yaml.",
               list);
  add_services(p, c.fdir);
  c.on_demand_services.assign(kFullServiceNames.begin(), kFullServiceNames.end());
  p.add("permit_validity_s", c.permit_validity_s, {0.04, 0.2}, "of DRIVE_PERMIT; without a newer one the rover stops");
  p.add("teleop_speed_mps", c.teleop_speed_mps, {0.01, vehicle.top_speed_mps}, "speed limit in TELEOP");
  p.add("motor_thermal_time_s", c.derived.motor_thermal_time_s, {1.0, 3600.0},
        "time constant of a motor winding (i2t)");
  add_hazard_stop(p, c);
  add_sweep(p, c);
  add_level(p.section("level", "selection of the level on board over a window of driving time"), c.level);
  add_restarts(p.section("restarts", "restarts of unresponsive services"), c.restarts);
  p.finish();
  c.derived.start_window_s = c.restarts.window_s;
  if (list != nullptr) return c;
  c.fdir.lines = read_lines(config_dir, vehicle, navigation.cpu_scale);
  apply_row_ages(c);
  apply_terrain_distance(c);
  return c;
}

}  // namespace rover::supervisor
