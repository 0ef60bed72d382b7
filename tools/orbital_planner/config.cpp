#include "tools/orbital_planner/config.hpp"

#include "common/bus/navigation_config.hpp"

namespace rover::orbital {
namespace {

void add_terrain(Parameters p, TerrainConfig& c) {
  p.add("window_m", c.window_m, {0.5, 100.0},
        "side of the square of a plane fit; averages the vertical noise of the map");
  p.add("min_known_fraction", c.min_known_fraction, {0.1, 1.0},
        "of the square's cells with heights; fewer: the cell is unknown");
  p.add_deg("sloping_deg", c.sloping_rad, {0.0, 35.0}, "slope above which ground is classified as sloping");
  p.add("rough_m", c.rough_m, {0.0, 10.0}, "roughness above which ground is classified as rough");
  p.add("max_roughness_m", c.max_roughness_m, {0.01, 10.0},
        "rms of the residuals of the plane fit; above: an obstacle");
  p.add("max_step_m", c.max_step_m, {0.05, 10.0},
        "height difference to a neighbouring cell beyond the plane's own; above: an obstacle");
  p.check(c.sloping_rad <= c.steep_rad, "sloping_deg", "must not be larger than steep_slope_deg of navigation.yaml");
}

void add_cost(Parameters p, CostConfig& c) {
  p.add("clearance_m", c.clearance_m, {0.0, 100.0},
        "of the path to obstacles and unknown ground: corridor, half the rover's width, a map cell");
  p.add("risk_distance_m", c.risk_distance_m, {0.0, 1000.0}, "the cost rises within this distance of an obstacle");
  p.add("risk_cost", c.risk_cost, {0.0, 100.0}, "factor that is added to the slope cost at the clearance");
  p.add("difficulty_cost", c.difficulty_cost, {0.0, 100.0}, "cost added at difficulty 1");
  p.check(c.risk_distance_m > c.clearance_m, "risk_distance_m", "must be larger than clearance_m");
}

void add_levels(Parameters p, LevelConfig& c) {
  p.add("full_above", c.full_above, {0.0, 1.0}, "difficulty above which the Full level starts: 8.3 deg of slope");
  p.add("efficient_below", c.efficient_below, {0.0, 1.0},
        "difficulty below which it ends (hysteresis): 6 deg of slope");
  p.add("averaging_distance_m", c.averaging_distance_m, {0.0, 1000.0},
        "length of path over which difficulty is averaged");
  p.add("lead_distance_m", c.lead_distance_m, {0.0, 100.0},
        "the Full level starts this much earlier, to fill its map first");
  p.add("min_segment_length_m", c.min_segment_length_m, {0.0, 1000.0},
        "shorter Full segments are lengthened, shorter Efficient segments become Full");
  p.check(c.efficient_below <= c.full_above, "efficient_below", "must not be larger than full_above");
}

void add_path(Parameters p, RouteConfig& c) {
  p.add("point_spacing_m", c.point_spacing_m, {0.2, 50.0}, "distance between points");
  p.add("smoothing_sigma_m", c.smoothing_sigma_m, {0.0, 50.0},
        "standard deviation of the Gaussian smoothing along the path");
}

void share(const NavigationConfig& navigation, ToolConfig& config) {
  config.planner.terrain.steep_rad = navigation.steep_slope_rad;
  config.planner.terrain.max_slope_rad = navigation.max_slope_rad;
  config.planner.levels.corridor_half_width_m = navigation.corridor_half_width_m;
  config.terms = {navigation.corridor_half_width_m, navigation.goal_tolerance_m};
}

}  // namespace

ToolConfig load_config(const std::string& config_dir, ParameterList* list) {
  ToolConfig config;
  Parameters p(config_dir + "/orbital_planner.yaml",
               "Global path on an orbital elevation model (./rover plan). Slope costs: HDPR (Azkarate et al. 2020).",
               list);
  if (list == nullptr) share(load_navigation(config_dir), config);
  add_terrain(p.section("terrain", "terrain analysis by plane fits"), config.planner.terrain);
  add_cost(p.section("cost", "per metre of path, relative to level ground"), config.planner.cost);
  add_levels(
      p.section("levels", "level of autonomy, by difficulty relative to the limits of slope, roughness and step"),
      config.planner.levels);
  add_path(p.section("path", "points of the path"), config.planner.route);
  p.finish();
  return config;
}

}  // namespace rover::orbital
