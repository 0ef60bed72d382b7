#include "mission_control/config.hpp"

#include "common/bus/config.hpp"

namespace rover {
namespace {

constexpr Range kMap{-1e7, 1e7};

StartPose read_start(const Config& config) {
  StartPose start;
  start.pose.x_m = config.number("x_m", kMap);
  start.pose.y_m = config.number("y_m", kMap);
  start.z_m = config.number("z_m", {-1e5, 1e5});
  start.pose.yaw_rad = to_rad(config.number("yaw_deg", {-360, 360}));
  config.read("sigma_m", start.sigma_m, {1e-4, 100});
  config.read_deg("sigma_yaw_deg", start.sigma_yaw_rad, {1e-3, 180});
  config.read("clear_radius_m", start.clear_radius_m, {0, 10});
  return start;
}

GlobalPath read_path(const Config& config) {
  GlobalPath path;
  path.x_m = config.numbers("x_m", kMap, 0);
  path.y_m = config.numbers("y_m", kMap, path.x_m.size());
  for (double level : config.numbers("level", {0, 1}, path.x_m.size()))
    path.level.push_back(static_cast<std::int8_t>(level));
  config.read("corridor_half_width_m", path.corridor_half_width_m, {0.1, 50});
  config.read("goal_tolerance_m", path.goal_tolerance_m, {0.01, 10});
  return path;
}

}  // namespace

MissionPlan load_mission_plan(const std::string& config_dir) {
  const Config config = Config::load(config_dir + "/ground.yaml");
  const MissionPlan plan{read_start(config.section("start")), read_path(config.section("path"))};
  config.finish();
  return plan;
}

}  // namespace rover
