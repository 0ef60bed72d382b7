#include "test/bench_faults/judge/row_table.hpp"

#include <iterator>
#include <map>
#include <sstream>

#include "common/bus/config.hpp"
#include "common/bus/vehicle_config.hpp"
#include "common/core/frames.hpp"

namespace rover::bench_faults {
namespace {

using Names = std::vector<std::string>;

const Names kDrives = {"FL", "FR", "ML", "MR", "RL", "RR"};
const Names kSteers = {"FL", "FR", "RL", "RR"};
const Names kOne = {""};

Names words(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

// Motors or services for which a line with this quantity makes a row.
struct Services {
  Names required, optional, full;
};

Names subjects(const std::string& quantity, const Services& services) {
  if (quantity.starts_with("drive_")) return kDrives;
  if (quantity.starts_with("steer_")) return kSteers;
  if (quantity == "optional_heartbeat_age_s") return services.optional;
  if (quantity.starts_with("full_")) return services.full;
  const Names of_services = {"heartbeat_age_s", "service_fault", "starts_per_minute", "restart_attempts"};
  for (const std::string& name : of_services)
    if (quantity == name) return services.required;
  return kOne;
}

Row read_row(const Config& c) {
  Row row;
  row.line = c.text("id");
  row.quantity = c.text("quantity");
  row.limit = c.number("limit", {0.0, 1e6});
  c.read("n", row.n, {1, 64});
  row.m = row.n;
  c.read("m", row.m, {1, 64});
  c.read("persistence_s", row.persistence_s, {0.0, 600.0});
  const std::string response = c.text("response");
  row.stops = response != "log" && response != "slow";
  c.read("stops", row.stops);
  static const std::map<std::string, Armed> kArmed = {{"always", Armed::kAlways},
                                                      {"motion", Armed::kMotion},
                                                      {"drive", Armed::kUnderWay},
                                                      {"full", Armed::kFull},
                                                      {"efficient", Armed::kEfficient}};
  if (c.has("armed")) row.armed = kArmed.at(c.text("armed"));
  return row;
}

std::vector<Row> read_rows(const std::string& config_dir, const Services& services) {
  std::vector<Row> rows;
  for (const Config& c : Config::load(config_dir + "/fdir.yaml").list("rows")) {
    const Row line = read_row(c);
    const Names who = subjects(line.quantity, services);
    for (size_t i = 0; i < who.size(); ++i) {
      rows.push_back(line);
      rows.back().id = who[i].empty() ? line.line : line.line + "." + who[i];
      rows.back().service = who[i];
      rows.back().motor = static_cast<int>(i);
    }
  }
  return rows;
}

}  // namespace

Settings read_settings(const std::string& config_dir) {
  constexpr Range kAny{0.0, 1e4};
  Settings out;
  const Config supervisor = Config::load(config_dir + "/supervisor.yaml");
  out.rows =
      read_rows(config_dir, {words(supervisor.text("required_services")), words(supervisor.text("optional_services")),
                             words(supervisor.text("full_services"))});
  out.restart_window_s = supervisor.section("restarts").number("window_s", kAny);
  out.motor_time_s = supervisor.number("motor_thermal_time_s", kAny);
  out.stop_distance_m = supervisor.number("stop_distance_m", kAny);
  out.stationary_speed_mps = supervisor.number("stationary_speed_mps", kAny);
  out.stationary_rate_radps = to_rad(supervisor.number("stationary_rate_degps", kAny));
  const Config vehicle = Config::load(config_dir + "/vehicle.yaml");
  out.wheel_radius_m = vehicle.section("wheels").number("radius_m", kAny);
  out.drive_nominal_a = vehicle.section("drive").number("current_nominal_a", kAny);
  out.steer_nominal_a = vehicle.section("steering").number("current_nominal_a", kAny);
  const Vehicle geometry = load_vehicle(config_dir);
  out.half_length_m = geometry.footprint_half_length_m();
  out.half_width_m = geometry.footprint_half_width_m();
  out.deceleration_mps2 = geometry.deceleration_mps2;
  return out;
}

}  // namespace rover::bench_faults
