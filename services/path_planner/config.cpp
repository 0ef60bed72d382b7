#include "path_planner/config.hpp"

#include "common/bus/navigation_config.hpp"
#include "common/bus/vehicle_config.hpp"

namespace rover::planning {
namespace {

void add_belief(Parameters p, BeliefConfig& c) {
  double side_m = c.cells * BeliefConfig::kCellM;
  p.add("side_m", side_m, {10.0, 60.0}, "side of the map, which moves with the rover");
  c.cells = static_cast<int>(std::lround(side_m / BeliefConfig::kCellM));
  p.add("hit_log_odds", c.hit, {0.0, 10.0}, "evidence of a hazard in one frame of the LocCam");
  p.add("miss_log_odds", c.miss, {0.0, 10.0}, "evidence of free ground, from within near_range_m");
  p.add("max_log_odds", c.max_evidence, {0.5, 20.0}, "bound of the evidence of all frames");
  p.add("near_range_m", c.near_range_m, {0.5, 10.0}, "farther frames count in proportion to 1 / range");
  p.add("navcam_sigma", c.sigma, {0.001, 1.0}, "of a step in the NavCam's map, relative to the limit");
  p.add("navcam_sigma_per_m", c.sigma_per_m, {0.0, 1.0}, "added per metre of range");
  p.add("navcam_max_log_odds", c.max_navcam_evidence, {0.1, 20.0}, "bound of its evidence");
  p.add("unmeasured_frames", c.unmeasured_frames, {1, 200},
        "frames in a row, within near_range_m, that do not measure ground in view: a hazard, unless it is surely free");
}

void add_clearance(Parameters p, PathPlannerConfig& c) {
  Clearances& clearances = c.planner.clearances;
  p.add("min_m", clearances.min_m, {0.0, 1.0},
        "minimum of a plan; of point turns and the global path 0.03 m more; motions within 0.06 m of it cost more");
  clearances.turn_m = clearances.min_m + Clearances::kToleranceM;
  clearances.comfort_m = clearances.min_m + 2.0 * Clearances::kToleranceM;
}

void add_ground(Parameters p, PathPlannerConfig& c) {
  p.add("hazard_probability", c.costmap.hazard_probability, {0.05, 0.95}, "from here on a cell is a hazard");
  p.add("hazard_cost", c.costmap.hazard_cost, {0.0, 50.0}, "at probability 1: the expected detour");
  p.add("difficulty_cost", c.costmap.difficulty_cost, {0.0, 50.0}, "at ground that is just traversable");
  p.add("unknown_cost", c.costmap.unknown_cost, {0.0, 20.0}, "unknown ground");
  p.add("clearance_cost", c.planner.cost_to_go.clearance_cost, {0.0, 20.0}, "at the minimum clearance");
  p.add_deg("max_roll_deg", c.planner.roll.max_rad, {1.0, 45.0}, "of a plan, by the NavCam's map: below that of FDIR");
  p.add("roll_cost", c.planner.roll.cost, {0.0, 20.0}, "at the largest roll; nothing below 0.75 of it");
}

void add_motion(Parameters p, MotionCosts& c) {
  p.add("point_turn_s", c.point_turn_s, {0.0, 200.0}, "steering to it and back");
  p.add("point_turn_s_per_rad", c.point_turn_s_per_rad, {0.0, 200.0}, "turning");
  p.add("curvature_change_s", c.curvature_change_s, {0.0, 50.0}, "by the largest curvature, quadratic below");
  p.add("cusp_s", c.cusp_s, {0.0, 200.0}, "between forward and reverse");
  p.add("reverse_factor", c.reverse_factor, {1.0, 20.0}, "on the cost in reverse");
  p.add("tight_factor", c.tight_factor, {1.0, 20.0}, "on the cost of motions within 0.06 m of clearance.min_m");
}

void add_search(Parameters p, HybridPlannerConfig& c) {
  p.add("horizon_m", c.horizon_m, {2.0, 12.0}, "of headings and clearances; beyond, the 2-D cost-to-go");
  p.add("known_free_m", c.search.known_free_m, {0.1, 20.0},
        "first part of a plan whose ground is known, or seen before the rover is there");
  p.add("switching_cost_s", c.switching_cost_s, {0.0, 200.0},
        "a plan replaces the driven one if it is cheaper by this");
  p.add("max_expansions", c.search.max_expansions, {10, 1000000}, "then no path is found");
}

void set_vehicle(const Vehicle& vehicle, PathPlannerConfig& c) {
  c.footprint = {vehicle.footprint_half_length_m(), vehicle.footprint_half_width_m(), vehicle.half_gap_m()};
  for (size_t i = 0; i < c.footprint.wheels.size(); ++i)
    c.footprint.wheels[i] = {vehicle.wheel_x_m[i], vehicle.wheel_y_m[i]};
  c.costmap.wheel_reach_m = vehicle.footprint_half_width_m();
  c.origin_height_m = vehicle.origin_height_m;
  c.deceleration_mps2 = vehicle.deceleration_mps2;
  c.rounding.min_radius_m = vehicle.min_turn_radius_m;
  c.planner.motion.max_curvature_per_m = MotionCosts::kCurvatureRatio / vehicle.min_turn_radius_m;
  c.planner.motion.seconds_per_m = c.planner.cost_to_go.seconds_per_m = 1.0 / vehicle.top_speed_mps;
}

void set_navigation(const NavigationConfig& navigation, PathPlannerConfig& c) {
  c.goal_tolerance_m = navigation.goal_tolerance_m;
  c.corridor_half_width_m = navigation.corridor_half_width_m;
  c.turn_threshold_rad = navigation.point_turn_start_rad;
  c.turn_stop_rad = navigation.point_turn_stop_rad;
}

}  // namespace

PathPlannerConfig load_config(const std::string& config_dir, ParameterList* list) {
  PathPlannerConfig c;
  const Vehicle vehicle = load_vehicle(config_dir);
  set_vehicle(vehicle, c);
  const NavigationConfig navigation = load_navigation(config_dir);
  set_navigation(navigation, c);
  Parameters p(config_dir + "/path_planner.yaml",
               "Belief map, planning and recovery at both levels. Footprint, minimum turn radius and deceleration: "
               "vehicle.yaml. Goal tolerance and point turns: navigation.yaml.",
               list);
  p.add_choice("planner", c.planner_name, planner_names(), "the search; another one: docs/contributing.md");
  p.add("pose_max_age_s", c.pose_max_age_s, {0.02, 5.0}, "without a newer POSE there is no path");
  p.add("release_latency_s", c.release_latency_s, {0.02, 1.0}, "modelled processing time, frame to path");
  p.add("planning_latency_s", c.planning_latency_s, {0.0, 2.0}, "modelled time of the background planner");
  p.add("min_corridor_half_width_m", c.min_corridor_m, {0.05, 1.0},
        "of a path between hazards or back; the controller keeps within 0.1 m");
  p.add("blocked_goal_radius_m", c.planner.cost_to_go.blocked_goal_radius_m, {0.0, 3.0},
        "a path may end this far from a goal with hazards");
  p.add("hazard_stop_distance_m", c.stop_hazard_m, {0.1, 5.0}, "nearer hazards on the path need another one at once");
  p.add("unseen_stop_distance_m", c.stop_unknown_m, {0.05, 5.0}, "the same, unseen ground");
  p.add("patience", c.patience, {1, 100}, "plans that find no path before the rover backs up");
  p.add("backtrack_m", c.back_up_m, {0.5, 5.0},
        "back on the driven track if there is no path; each one in a row is this much longer");
  p.add("max_backtracks", c.max_back_ups, {0, 100}, "in a row, without progress along the global path");
  p.add("view_range_m", c.belief.view.far_m, {1.0, 20.0}, "the LocCam sees the ground this far ahead");
  c.belief.view = view_of(load_stereo_rig(config_dir, "loccam"), -c.origin_height_m, c.belief.view.far_m);
  p.check(c.belief.view.far_half_width_m > 0.0, "view_range_m", "the LocCam of cameras.yaml does not see so far");
  add_belief(p.section("belief", "probability that a wheel cannot pass a cell"), c.belief);
  add_clearance(p.section("clearance", "footprint to the centre of a hazard cell, of which half a cell is the cell"),
                c);
  add_ground(p.section("ground", "cost of a metre, relative to a metre of easy ground"), c);
  add_motion(p.section("motion", "cost of motions"), c.planner.motion);
  add_search(p.section("search", "hybrid A*"), c.planner);
  p.finish();
  c.planning_latency_s *= navigation.cpu_scale;
  return c;
}

}  // namespace rover::planning
