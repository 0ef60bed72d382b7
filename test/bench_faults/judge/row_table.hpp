// The rows of config/fdir.yaml: one for each motor or service of a line.
#pragma once

#include <string>
#include <vector>

namespace rover::bench_faults {

enum class Armed { kAlways, kMotion, kUnderWay, kFull, kEfficient };

struct Row {
  std::string id;    // with its motor or service: "drive_heat.FL"
  std::string line;  // without: "drive_heat"
  std::string quantity;
  std::string service;  // empty if the row has no service
  int motor = 0;
  double limit = 0.0;
  int n = 1;
  int m = 1;
  double persistence_s = 0.0;
  Armed armed = Armed::kAlways;
  bool stops = false;  // its response withdraws the permit
};

// Values of other files that quantities depend on.
struct Settings {
  std::vector<Row> rows;
  double wheel_radius_m = 0.0;
  double drive_nominal_a = 0.0;
  double steer_nominal_a = 0.0;
  double motor_time_s = 0.0;
  double restart_window_s = 0.0;
  double stop_distance_m = 0.0;
  double stationary_speed_mps = 0.0;
  double stationary_rate_radps = 0.0;
  double half_length_m = 0.0;
  double half_width_m = 0.0;
  double deceleration_mps2 = 0.0;
};

Settings read_settings(const std::string& config_dir);

}  // namespace rover::bench_faults
