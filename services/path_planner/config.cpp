#include "path_planner/config.hpp"

#include "common/bus/navigation_config.hpp"
#include "common/bus/vehicle_config.hpp"

namespace rover::planning {
namespace {

// A square map's side, as its number of cells.
void add_side(Parameters& p, const std::string& key, int& cells, double cell_m, Range range,
              const std::string& meaning) {
  double side_m = cells * cell_m;
  p.add(key, side_m, range, meaning);
  cells = static_cast<int>(std::lround(side_m / cell_m));
}

void add_clearance(Parameters p, PathPlannerConfig& c) {
  p.add("normal_m", c.margin_m, {0.0, 1.0}, "a path with less is blocked");
  p.add("reduced_m", c.tight_margin_m, {0.0, 1.0}, "if no path keeps normal_m");
  p.check(c.tight_margin_m <= c.margin_m, "reduced_m", "must not be larger than normal_m");
  p.add("planning_extra_m", c.plan_extra_m, {0.0, 1.0},
        "added when planning: a hazard that grows by half a cell does not block the path");
  p.add("sigma_gain", c.sigma_gain, {0.0, 10.0},
        "times the growth of the position's sigma over the last 3 m: added to the clearance");
  p.add("max_sigma_margin_m", c.most_sigma_margin_m, {0.0, 1.0}, "upper bound of this addition");
}

void add_map(Parameters p, HazardMemoryConfig& c) {
  p.add("cell_m", c.cell_m, {0.05, 0.2}, "side of a cell");
  add_side(p, "side_m", c.cells, c.cell_m, {6.0, 30.0}, "side of the map, which moves with the rover");
  p.add("confirm_hits", c.confirm_hits, {1, 10}, "frames with a hazard in a cell that confirm it");
  p.add("possible_clear_misses", c.possible_clear, {1, 20}, "frames in a row without it that clear a possible hazard");
  p.add("confirmed_clear_misses", c.confirmed_clear, {1, 100},
        "frames in a row without it, within clear_range_m, that clear a confirmed hazard");
  p.add("clear_range_m", c.clear_range_m, {0.5, 10.0}, "largest range of these frames");
  p.add("navcam_override_frames", c.sure_free, {1, 100},
        "frames in a row that see free ground and override a hazard of the NavCam's map");
  p.add("navcam_override_range_m", c.sure_range_m, {0.5, 10.0}, "largest range of these frames");
  p.add("no_data_frames", c.blind_looks, {1, 200},
        "frames in a row, within clear_range_m, that do not measure ground in view: it becomes a hazard");
}

void add_view(Parameters p, ViewArea& c) {
  p.add("camera_x_m", c.camera.x_m, {-5.0, 5.0}, "position of the LocCam, rounded from cameras.yaml");
  p.add("camera_y_m", c.camera.y_m, {-5.0, 5.0}, "the same, to the left");
  p.add("near_m", c.near_m, {0.0, 5.0}, "the LocCam's 0.97 m less half a cell; the map closes such a strip");
  p.add("far_m", c.far_m, {1.0, 20.0}, "far edge");
  p.check(c.far_m > c.near_m, "far_m", "must be larger than near_m");
  p.add("near_half_width_m", c.near_half_width_m, {0.1, 5.0}, "half width at the near edge");
  p.add("far_half_width_m", c.far_half_width_m, {0.1, 20.0}, "half width at the far edge");
}

void add_repair_search(Parameters p, ArcSearchConfig& c) {
  p.add("step_m", c.step_m, {0.1, 1.0}, "length of an arc");
  p.add("point_turn_cost_m", c.turn_cost_m, {0.0, 50.0},
        "a point turn takes about 15 s, in which the rover drives 3 m");
  p.add("point_turn_cost_m_per_rad", c.turn_cost_per_rad_m, {0.0, 50.0}, "added for the angle");
  p.add("point_turn_steering_cost_m", c.turn_bend_cost_m, {0.0, 50.0},
        "added if the wheels come from or go to the largest curvature: 5 s of steering");
  p.add("curvature_change_cost_m", c.bend_cost_m, {0.0, 5.0}, "for a change by the largest curvature");
  p.add("curvature_cost", c.curvature_cost, {0.0, 5.0}, "per metre at the largest curvature");
  p.add("unseen_path_cost", c.unseen_way_cost, {0.0, 20.0},
        "per metre beyond the horizon over ground that is not seen before the rover gets there");
  p.add("heuristic_weight", c.greed, {1.0, 5.0}, "of weighted A*");
  p.add("max_expansions", c.max_expansions, {10, 100000}, "then no path is found");
  p.add("improvement_expansions", c.further_expansions, {0, 100000}, "after the first path, for a better one");
}

void add_smoother(Parameters p, SmootherConfig& c) {
  p.add("knot_spacing_m", c.knot_m, {0.1, 2.0}, "between the knots of the piecewise linear curvature");
  p.add("curvature_weight", c.curvature_weight, {0.0, 100.0}, "of the squared curvature, against 1 for the length");
  p.add("curvature_rate_weight", c.bend_weight, {0.0, 100.0}, "of the squared curvature rate: steering takes time");
  p.add("clearance_weight", c.clearance_weight, {0.0, 100.0}, "of the squared lack of clearance");
  p.add("inflation_distance_m", c.risk_m, {0.0, 5.0}, "beyond the required clearance; farther hazards cost nothing");
  p.add("max_evaluations", c.max_evaluations, {5, 1000}, "of SLSQP");
}

void add_min_radius(Parameters& p, const Vehicle& vehicle, LocalRepairConfig& c) {
  double radius_m = 1.0 / c.search.max_curvature_per_m;
  p.add("min_radius_m", radius_m, {vehicle.min_turn_radius_m, 10.0},
        "preferred for arcs; the vehicle's minimum is 1.0 m");
  c.search.max_curvature_per_m = 1.0 / radius_m;
  // Smoothing may exceed the preferred curvature slightly, the vehicle's limit never.
  c.smoother.max_curvature_per_m = std::min(1.06 / radius_m, 1.0 / vehicle.min_turn_radius_m);
}

void add_repair(Parameters p, const Vehicle& vehicle, LocalRepairConfig& c) {
  add_min_radius(p, vehicle, c);
  p.add("rejoin_within_m", c.rejoin_within_m, {0.0, 10.0},
        "repairs end on this part of the global path beyond the blockage; 0: as soon as possible");
  p.add("point_turn_extra_m", c.turn_extra_m, {0.0, 1.0}, "clearance added for point turns: the rover stops inexactly");
  p.add("failed_region_radius_m", c.dead_end_reach_m, {0.0, 5.0}, "around a position where backtracking began");
  p.add("failed_region_cost", c.dead_end_cost, {0.0, 50.0}, "added per metre there");
  p.add("max_deviation_m", c.max_deviation_m, {0.5, 20.0}, "from the global path");
  p.add("inflation_distance_m", c.risk_distance_m, {0.1, 5.0}, "ground costs more within this clearance (HDPR: 1.5 m)");
  p.add("inflation_cost", c.risk_cost, {0.0, 20.0}, "added per metre at the required clearance");
  p.add("unseen_cost", c.unseen_cost, {0.0, 20.0}, "added per metre over unseen ground");
  add_repair_search(p.section("search", "hybrid A* over arcs"), c.search);
  add_smoother(p.section("smoother", "NLopt's SLSQP over the curvature"), c.smoother);
}

void add_goal(Parameters p, GoalFieldConfig& c) {
  p.add("horizon_m", c.horizon_m, {2.0, 12.0}, "plans end on a line across the global path, this far ahead");
  p.add("max_deviation_m", c.max_deviation_m, {0.5, 40.0}, "from the global path; beyond the map, against oscillation");
  p.add("return_distance_m", c.return_way_m, {1.0, 50.0}, "beyond the line, to return to the global path");
  p.add("heading_cost_m_per_rad", c.heading_cost_m, {0.0, 10.0}, "between the plan's end and the global path");
  p.add("goal_miss_cost", c.goal_miss_cost, {0.0, 50.0}, "per metre between the plan's end and the goal");
  p.add("unknown_cost", c.unknown_cost, {0.0, 20.0}, "added per metre over unknown ground");
  p.add("difficulty_cost", c.difficulty_cost, {0.0, 50.0},
        "added per metre over barely traversable ground; 15 deg of slope cost as much as unknown ground");
  p.add("uncertain_difficulty", c.doubt_from, {0.0, 0.99}, "above, a rock is often found impassable from near");
  p.add("uncertain_cost", c.doubt_cost, {0.0, 50.0}, "added above it, per metre over barely traversable ground");
  p.add("inflation_distance_m", c.risk_distance_m, {0.05, 5.0}, "ground costs more within this clearance");
  p.add("inflation_cost", c.risk_cost, {0.0, 20.0}, "added per metre at the required clearance");
}

void add_plan_search(Parameters p, CurveSearchConfig& c) {
  p.add("step_m", c.step_m, {0.1, 1.0}, "length of a motion primitive");
  p.add("curvature_cost", c.curvature_cost, {0.0, 5.0}, "per metre at the largest curvature");
  p.add("curvature_change_cost_m", c.bend_cost_m, {0.0, 5.0}, "for a change by the largest curvature, quadratic below");
  p.add("point_turn_cost_m", c.turn_cost_m, {0.0, 50.0}, "as in repair.search");
  p.add("point_turn_cost_m_per_rad", c.turn_cost_per_rad_m, {0.0, 50.0}, "as in repair.search");
  p.add("point_turn_steering_cost_m", c.turn_bend_cost_m, {0.0, 50.0}, "as in repair.search");
  p.add("reduced_clearance_factor", c.tight_factor, {1.0, 20.0},
        "on the cost where only the reduced clearance is kept");
  p.add("min_clearance_factor", c.squeeze_factor, {1.0, 20.0}, "on the cost where only the minimum clearance is kept");
  p.add("reduced_clearance_turn_factor", c.tight_turn_factor, {1.0, 20.0}, "the same, point turns");
  p.add("reverse_factor", c.back_factor, {1.0, 20.0}, "on the cost in reverse");
  p.add("cusp_cost_m", c.reversal_cost_m, {0.0, 20.0}, "between forward and reverse: a stop");
  p.add("heuristic_weight", c.greed, {1.0, 5.0}, "of weighted A*");
  p.add("urgent_heuristic_weight", c.hasty_greed, {1.0, 20.0}, "of a second attempt after max_expansions");
  p.add("max_expansions", c.max_expansions, {10, 1000000}, "of one attempt");
}

void add_full(Parameters p, const PathPlannerConfig& shared, FullPlannerConfig& c) {
  p.add("max_map_age_s", c.stale_s, {0.5, 60.0}, "an older map is stale ...");
  p.add("max_map_distance_m", c.stale_way_m, {0.2, 10.0},
        "... after this distance without a newer one; then planning is as at the Efficient level");
  add_side(p, "map_side_m", c.map_cells, shared.memory.cell_m, {16.0, 60.0}, "side of the terrain map");
  p.add("near_range_m", c.near_look_m, {0.0, 10.0},
        "within it a map always updates a cell; beyond it only if no clearly nearer one did");
  p.add("known_free_horizon_m", c.sure_way_m, {0.1, 20.0}, "as above, of a plan");
  p.add("min_known_free_horizon_m", c.least_sure_way_m, {0.1, 20.0}, "the same, if the longer one allows no path");
  p.add("latency_s", c.latency_s, {0.0, 2.0}, "modelled time of the background planner");
  p.add("urgent_wait_s", c.patience_s, {0.0, 0.2}, "a step waits this long for a plan without which the rover stops");
  p.add("committed_prefix_m", c.hold_m, {0.5, 10.0}, "the first part of the driven plan that new plans keep");
  p.add("switch_gain_m", c.switch_gain_m, {0.0, 20.0}, "a plan from the rover itself must cost this much less ...");
  p.add("switch_gain_ratio", c.switch_share, {0.0, 5.0}, "... and this fraction of its cost");
  p.add("block_tolerance_m", c.block_slack_m, {0.0, 1.0},
        "a plan is blocked below min_clearance_m less this: hazards grow by cells");
  p.add("sigma_margin_m", c.sigma_margin_m, {0.0, 1.0},
        "for the pose, instead of clearance.sigma_gain: the map is renewed every half metre");
  p.add("max_backtracks", c.most_retreats, {0, 100}, "in a row, without progress along the global path");
  p.add("min_clearance_m", c.squeeze_margin_m, {0.0, 1.0},
        "at a cost (search.min_clearance_factor): half a cell below reduced_m, so that one cell does not close a gap");
  p.add("min_corridor_half_width_m", c.least_corridor_m, {0.05, 1.0},
        "of a plan between hazards: on a slope a point turn slides by 0.2 m");
  p.add("unconfirmed_range_m", c.doubt_from_m, {0.0, 20.0},
        "if no path is found: small spots of the map never seen from nearer do not count ...");
  p.add("unconfirmed_cells", c.doubt_cells, {0, 1000}, "... up to this size, unless the LocCam confirms them");
  add_goal(p.section("goal", "where plans end"), c.goal);
  c.goal.dead_end_reach_m = shared.repair.dead_end_reach_m;
  add_plan_search(p.section("search", "hybrid A* with continuous curvature"), c.search);
  c.search.max_curvature_per_m = shared.repair.search.max_curvature_per_m;
  c.turn_extra_m = shared.repair.turn_extra_m;
}

void set_vehicle(const Vehicle& vehicle, PathPlannerConfig& c) {
  c.footprint = {vehicle.footprint_half_length_m(), vehicle.footprint_half_width_m()};
  c.repair.footprint = c.footprint;
  c.ground_z_m = -vehicle.origin_height_m;
  c.deceleration_mps2 = vehicle.deceleration_mps2;
  c.rounding.min_radius_m = vehicle.min_turn_radius_m;
}

void set_navigation(const NavigationConfig& navigation, PathPlannerConfig& c) {
  c.goal_tolerance_m = navigation.goal_tolerance_m;
  c.turn_threshold_rad = navigation.point_turn_start_rad;
  c.turn_stop_rad = navigation.point_turn_stop_rad;
}

}  // namespace

PathPlannerConfig load_config(const std::string& config_dir, ParameterList* list) {
  PathPlannerConfig c;
  const Vehicle vehicle = load_vehicle(config_dir);
  set_vehicle(vehicle, c);
  set_navigation(load_navigation(config_dir), c);
  Parameters p(config_dir + "/path_planner.yaml",
               "Local path repair, and continuous planning at the Full level. Footprint, minimum turn radius and "
               "deceleration: vehicle.yaml. Goal tolerance and point turns: navigation.yaml.",
               list);
  p.add("pose_max_age_s", c.pose_max_age_s, {0.02, 5.0}, "without a newer POSE there is no path");
  p.add("release_latency_s", c.release_latency_s, {0.02, 1.0}, "modelled processing time, frame to path");
  p.add("corridor_half_width_m", c.corridor_half_width_m, {0.1, 5.0},
        "if the global path has none (HDPR: 0.75 to 1.5 m)");
  p.add("min_corridor_half_width_m", c.least_corridor_m, {0.05, 1.0},
        "of a repair between hazards; the controller keeps within 0.1 m");
  p.add("blocked_goal_radius_m", c.blocked_goal_reach_m, {0.0, 3.0},
        "a path may end this far from a goal with hazards");
  p.add("max_start_offset_m", c.max_start_offset_m, {0.05, 5.0},
        "farther from the global path, a path to it is planned");
  p.add("hazard_stop_distance_m", c.stop_hazard_m, {0.1, 5.0},
        "nearer hazards need another path at once; without one: NO_PATH");
  p.add("unseen_stop_distance_m", c.stop_unseen_m, {0.05, 5.0}, "the same, unseen ground");
  p.add("block_timeout_frames", c.patience_frames, {1, 100},
        "frames until unseen ground or a single hit ahead counts as blocked, and failed searches as NO_PATH");
  p.add("known_free_horizon_m", c.sure_way_m, {0.1, 20.0},
        "first part of a repair whose ground is known free, or seen before the rover gets there");
  p.add("min_known_free_horizon_m", c.least_sure_way_m, {0.1, 20.0}, "the same, if the longer one allows no path");
  p.add("improve_below_m", c.firm_way_m, {0.0, 20.0}, "a repair known free for less is replaced ...");
  p.add("improve_gain_m", c.firm_gain_m, {0.0, 20.0}, "... by one known free for this much more");
  p.add("backtrack_m", c.retreat_m, {0.5, 5.0},
        "reverse along the driven track if there is no path; each one in a row is this much longer");
  p.add("max_backtracks", c.most_retreats, {0, 100}, "in a row, without progress along the global path");
  p.add("backtrack_corridor_half_width_m", c.retreat_corridor_m, {0.05, 1.0}, "of a backtracking path");
  p.add("map_shift_m", c.correction_m, {0.005, 1.0}, "movement of map against odom that updates the path");
  p.add("max_frame_expansions", c.frame_work, {1, 1000000},
        "search budget of a frame; beyond it the next frame continues the search");
  add_clearance(p.section("clearance", "footprint to the centre of a hazard cell, of which half a cell is the cell"),
                c);
  add_map(p.section("map", "obstacle map"), c.memory);
  add_view(p.section("view", "ground that the LocCam sees, body axes; slightly less than its geometry gives"),
           c.repair.view);
  c.memory.view = c.repair.view;
  add_repair(p.section("repair", "path around hazards, back to the global path"), vehicle, c.repair);
  add_full(p.section("full", "continuous planning at the Full level, on the NavCam's map"), c, c.full);
  p.finish();
  return c;
}

}  // namespace rover::planning
