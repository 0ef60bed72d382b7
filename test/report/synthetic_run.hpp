// Log of a complete run without a simulator: a rover that avoids rocks on its planned path, with known errors.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/report/run_record.hpp"

namespace rover::report {

struct SyntheticRun {
  std::vector<Eigen::Vector2d> planned;  // polyline in map
  std::vector<Rock> rocks;               // those to avoid are on the planned path
  std::vector<double> swerves_m;         // arc lengths along it
  double speed_mps = 0.18;
  double drift_percent = 0.5;  // lateral odometry drift, linear in distance
  double final_s = 2.0;        // after GOAL_REACHED
  std::function<double(double, double)> height_m = [](double, double) { return 0.0; };
};

// Writes traverse.lcm, run.json and the scenario's text into the folder.
void write_synthetic_run(const SyntheticRun& run, const std::string& dir);

}  // namespace rover::report
