#include "tools/orbital_planner/config.hpp"

#include "common/bus/config.hpp"

namespace rover::orbital {
namespace {

void read_terrain(const Config& yaml, TerrainConfig& terrain) {
  yaml.read("window_m", terrain.window_m, {0.5, 100.0});
  yaml.read("least_known", terrain.least_known, {0.1, 1.0});
  yaml.read_deg("sloping_deg", terrain.sloping_rad, {0.0, 35.0});
  yaml.read_deg("steep_deg", terrain.steep_rad, {0.0, 35.0});
  yaml.read_deg("most_slope_deg", terrain.most_slope_rad, {1.0, 35.0});
  yaml.read("rough_m", terrain.rough_m, {0.0, 10.0});
  yaml.read("most_roughness_m", terrain.most_roughness_m, {0.01, 10.0});
  yaml.read("most_step_m", terrain.most_step_m, {0.05, 10.0});
  if (terrain.sloping_rad > terrain.steep_rad) yaml.fail("sloping_deg", "must not be beyond steep_deg");
  if (terrain.steep_rad > terrain.most_slope_rad) yaml.fail("steep_deg", "must not be beyond most_slope_deg");
}

void read_cost(const Config& yaml, CostConfig& cost) {
  yaml.read("clearance_m", cost.clearance_m, {0.0, 100.0});
  yaml.read("risk_distance_m", cost.risk_distance_m, {0.0, 1000.0});
  yaml.read("risk_cost", cost.risk_cost, {0.0, 100.0});
  yaml.read("difficulty_cost", cost.difficulty_cost, {0.0, 100.0});
  if (cost.risk_distance_m <= cost.clearance_m) yaml.fail("risk_distance_m", "must be beyond clearance_m");
}

void read_levels(const Config& yaml, LevelConfig& levels) {
  yaml.read("full_above", levels.full_above, {0.0, 1.0});
  yaml.read("efficient_below", levels.efficient_below, {0.0, 1.0});
  yaml.read("mean_over_m", levels.mean_over_m, {0.0, 1000.0});
  yaml.read("corridor_m", levels.corridor_m, {0.0, 50.0});
  yaml.read("lead_m", levels.lead_m, {0.0, 100.0});
  yaml.read("least_stretch_m", levels.least_stretch_m, {0.0, 1000.0});
  if (levels.efficient_below > levels.full_above) yaml.fail("efficient_below", "must not be above full_above");
}

void read_path(const Config& yaml, RouteConfig& route, PathTerms& terms) {
  yaml.read("point_spacing_m", route.point_spacing_m, {0.2, 50.0});
  yaml.read("rounding_m", route.rounding_m, {0.0, 50.0});
  yaml.read("corridor_half_width_m", terms.corridor_half_width_m, {0.5, 20.0});
  yaml.read("goal_tolerance_m", terms.goal_tolerance_m, {0.05, 5.0});
}

}  // namespace

ToolConfig load_config(const std::string& config_dir) {
  ToolConfig config;
  const Config yaml = Config::load(config_dir + "/orbital_planner.yaml");
  read_terrain(yaml.section("terrain"), config.planner.terrain);
  read_cost(yaml.section("cost"), config.planner.cost);
  read_levels(yaml.section("levels"), config.planner.levels);
  read_path(yaml.section("path"), config.planner.route, config.terms);
  yaml.finish();
  return config;
}

}  // namespace rover::orbital
