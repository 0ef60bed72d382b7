#include "path_planner/config.hpp"

#include "common/bus/config.hpp"
#include "common/bus/vehicle_config.hpp"

namespace rover::planning {
namespace {

void read_memory(const Config& c, HazardMemoryConfig& out) {
  double side_m = out.cells * out.cell_m;
  c.read("cell_m", out.cell_m, {0.05, 0.2});
  c.read("side_m", side_m, {6.0, 30.0});
  out.cells = static_cast<int>(std::lround(side_m / out.cell_m));
  c.read("confirm_hits", out.confirm_hits, {1, 10});
  c.read("possible_clear", out.possible_clear, {1, 20});
  c.read("confirmed_clear", out.confirmed_clear, {1, 100});
  c.read("clear_range_m", out.clear_range_m, {0.5, 10.0});
  c.read("sure_free", out.sure_free, {1, 100});
  c.read("sure_range_m", out.sure_range_m, {0.5, 10.0});
  c.read("blind_looks", out.blind_looks, {1, 200});
}

void read_view(const Config& c, ViewArea& out) {
  c.read("camera_x_m", out.camera.x_m, {-5.0, 5.0});
  c.read("camera_y_m", out.camera.y_m, {-5.0, 5.0});
  c.read("near_m", out.near_m, {0.0, 5.0});
  c.read("far_m", out.far_m, {1.0, 20.0});
  c.read("near_half_width_m", out.near_half_width_m, {0.1, 5.0});
  c.read("far_half_width_m", out.far_half_width_m, {0.1, 20.0});
  if (out.far_m <= out.near_m) c.fail("far_m", "must be larger than near_m");
}

void read_repair(const Config& c, LocalRepairConfig& out) {
  c.read("rejoin_within_m", out.rejoin_within_m, {0.0, 10.0});
  c.read("turn_extra_m", out.turn_extra_m, {0.0, 1.0});
  c.read("dead_end_reach_m", out.dead_end_reach_m, {0.0, 5.0});
  c.read("dead_end_cost", out.dead_end_cost, {0.0, 50.0});
  c.read("max_deviation_m", out.max_deviation_m, {0.5, 20.0});
  c.read("risk_distance_m", out.risk_distance_m, {0.1, 5.0});
  c.read("risk_cost", out.risk_cost, {0.0, 20.0});
  c.read("unseen_cost", out.unseen_cost, {0.0, 20.0});
}

void read_search(const Config& c, ArcSearchConfig& out) {
  c.read("step_m", out.step_m, {0.1, 1.0});
  c.read("turn_cost_m", out.turn_cost_m, {0.0, 50.0});
  c.read("turn_cost_per_rad_m", out.turn_cost_per_rad_m, {0.0, 50.0});
  c.read("turn_bend_cost_m", out.turn_bend_cost_m, {0.0, 50.0});
  c.read("bend_cost_m", out.bend_cost_m, {0.0, 5.0});
  c.read("curvature_cost", out.curvature_cost, {0.0, 5.0});
  c.read("unseen_way_cost", out.unseen_way_cost, {0.0, 20.0});
  c.read("greed", out.greed, {1.0, 5.0});
  c.read("max_expansions", out.max_expansions, {10, 100000});
  c.read("further_expansions", out.further_expansions, {0, 100000});
}

void read_smoother(const Config& c, SmootherConfig& out) {
  c.read("knot_m", out.knot_m, {0.1, 2.0});
  c.read("curvature_weight", out.curvature_weight, {0.0, 100.0});
  c.read("bend_weight", out.bend_weight, {0.0, 100.0});
  c.read("clearance_weight", out.clearance_weight, {0.0, 100.0});
  c.read("risk_m", out.risk_m, {0.0, 5.0});
  c.read("max_evaluations", out.max_evaluations, {5, 1000});
}

void read_margins(const Config& c, PathPlannerConfig& out) {
  c.read("hazard_m", out.margin_m, {0.0, 1.0});
  c.read("tight_m", out.tight_margin_m, {0.0, 1.0});
  c.read("plan_extra_m", out.plan_extra_m, {0.0, 1.0});
  c.read("sigma_gain", out.sigma_gain, {0.0, 10.0});
  c.read("most_sigma_m", out.most_sigma_margin_m, {0.0, 1.0});
  if (out.tight_margin_m > out.margin_m) c.fail("tight_m", "must not be larger than hazard_m");
}

void read_goal(const Config& c, GoalFieldConfig& out) {
  c.read("horizon_m", out.horizon_m, {2.0, 12.0});
  c.read("max_deviation_m", out.max_deviation_m, {0.5, 40.0});
  c.read("return_way_m", out.return_way_m, {1.0, 50.0});
  c.read("heading_cost_m", out.heading_cost_m, {0.0, 10.0});
  c.read("goal_miss_cost", out.goal_miss_cost, {0.0, 50.0});
  c.read("unknown_cost", out.unknown_cost, {0.0, 20.0});
  c.read("difficulty_cost", out.difficulty_cost, {0.0, 50.0});
  c.read("doubt_from", out.doubt_from, {0.0, 0.99});
  c.read("doubt_cost", out.doubt_cost, {0.0, 50.0});
  c.read("risk_distance_m", out.risk_distance_m, {0.05, 5.0});
  c.read("risk_cost", out.risk_cost, {0.0, 20.0});
}

void read_curves(const Config& c, CurveSearchConfig& out) {
  c.read("step_m", out.step_m, {0.1, 1.0});
  c.read("curvature_cost", out.curvature_cost, {0.0, 5.0});
  c.read("bend_cost_m", out.bend_cost_m, {0.0, 5.0});
  c.read("turn_cost_m", out.turn_cost_m, {0.0, 50.0});
  c.read("turn_cost_per_rad_m", out.turn_cost_per_rad_m, {0.0, 50.0});
  c.read("turn_bend_cost_m", out.turn_bend_cost_m, {0.0, 50.0});
  c.read("tight_factor", out.tight_factor, {1.0, 20.0});
  c.read("squeeze_factor", out.squeeze_factor, {1.0, 20.0});
  c.read("tight_turn_factor", out.tight_turn_factor, {1.0, 20.0});
  c.read("back_factor", out.back_factor, {1.0, 20.0});
  c.read("reversal_cost_m", out.reversal_cost_m, {0.0, 20.0});
  c.read("greed", out.greed, {1.0, 5.0});
  c.read("hasty_greed", out.hasty_greed, {1.0, 20.0});
  c.read("max_expansions", out.max_expansions, {10, 1000000});
}

// What both levels share is read before.
void read_full(const Config& c, const PathPlannerConfig& shared, FullPlannerConfig& out) {
  read_goal(c.section("goal"), out.goal);
  out.goal.dead_end_reach_m = shared.repair.dead_end_reach_m;
  out.search.max_curvature_per_m = shared.repair.search.max_curvature_per_m;
  read_curves(c.section("search"), out.search);
  out.turn_extra_m = shared.repair.turn_extra_m;
  double map_side_m = out.map_cells * shared.memory.cell_m;
  c.read("map_side_m", map_side_m, {16.0, 60.0});
  out.map_cells = static_cast<int>(std::lround(map_side_m / shared.memory.cell_m));
  c.read("sure_way_m", out.sure_way_m, {0.1, 20.0});
  c.read("least_sure_way_m", out.least_sure_way_m, {0.1, 20.0});
  c.read("hold_m", out.hold_m, {0.5, 10.0});
  c.read("switch_gain_m", out.switch_gain_m, {0.0, 20.0});
  c.read("switch_share", out.switch_share, {0.0, 5.0});
  c.read("sigma_m", out.sigma_margin_m, {0.0, 1.0});
  c.read("most_retreats", out.most_retreats, {0, 100});
  c.read("doubt_from_m", out.doubt_from_m, {0.0, 20.0});
  c.read("doubt_cells", out.doubt_cells, {0, 1000});
  c.read("near_look_m", out.near_look_m, {0.0, 10.0});
  c.read("squeeze_m", out.squeeze_margin_m, {0.0, 1.0});
  c.read("least_corridor_m", out.least_corridor_m, {0.05, 1.0});
  c.read("latency_s", out.latency_s, {0.0, 2.0});
  c.read("patience_s", out.patience_s, {0.0, 0.2});
  c.read("block_slack_m", out.block_slack_m, {0.0, 1.0});
  c.read("stale_s", out.stale_s, {0.5, 60.0});
  c.read("stale_way_m", out.stale_way_m, {0.2, 10.0});
}

void read_vehicle(const Vehicle& vehicle, PathPlannerConfig& out) {
  out.footprint = {vehicle.footprint_half_length_m(), vehicle.footprint_half_width_m()};
  out.ground_z_m = -vehicle.origin_height_m;
  out.deceleration_mps2 = vehicle.deceleration_mps2;
  out.rounding.min_radius_m = vehicle.min_turn_radius_m;
}

void read_radius(const Config& c, const Vehicle& vehicle, LocalRepairConfig& out) {
  double radius_m = 1.0 / out.search.max_curvature_per_m;
  c.read("least_radius_m", radius_m, {vehicle.min_turn_radius_m, 10.0});
  out.search.max_curvature_per_m = 1.0 / radius_m;
  // The smoothed curvature may pass the preferred one by a little, never the vehicle's.
  out.smoother.max_curvature_per_m = std::min(1.06 / radius_m, 1.0 / vehicle.min_turn_radius_m);
}

}  // namespace

PathPlannerConfig load_config(const std::string& config_dir) {
  const Vehicle vehicle = load_vehicle(config_dir);
  PathPlannerConfig out;
  read_vehicle(vehicle, out);
  const Config config = Config::load(config_dir + "/path_planner.yaml");
  config.read("pose_max_age_s", out.pose_max_age_s, {0.02, 5.0});
  config.read("release_latency_s", out.release_latency_s, {0.02, 1.0});
  config.read("corridor_half_width_m", out.corridor_half_width_m, {0.1, 5.0});
  config.read("least_corridor_m", out.least_corridor_m, {0.05, 1.0});
  config.read("goal_tolerance_m", out.goal_tolerance_m, {0.05, 5.0});
  config.read("blocked_goal_reach_m", out.blocked_goal_reach_m, {0.0, 3.0});
  config.read("max_start_offset_m", out.max_start_offset_m, {0.05, 5.0});
  config.read_deg("point_turn_deg", out.turn_threshold_rad, {5.0, 90.0});
  config.read_deg("point_turn_stop_deg", out.turn_stop_rad, {0.2, 20.0});
  config.read("stop_hazard_m", out.stop_hazard_m, {0.1, 5.0});
  config.read("stop_unseen_m", out.stop_unseen_m, {0.05, 5.0});
  config.read("patience_frames", out.patience_frames, {1, 100});
  config.read("sure_way_m", out.sure_way_m, {0.1, 20.0});
  config.read("least_sure_way_m", out.least_sure_way_m, {0.1, 20.0});
  config.read("firm_gain_m", out.firm_gain_m, {0.0, 20.0});
  config.read("firm_way_m", out.firm_way_m, {0.0, 20.0});
  config.read("retreat_m", out.retreat_m, {0.5, 5.0});
  config.read("most_retreats", out.most_retreats, {0, 100});
  config.read("retreat_corridor_m", out.retreat_corridor_m, {0.05, 1.0});
  config.read("correction_m", out.correction_m, {0.005, 1.0});
  config.read("frame_work", out.frame_work, {1, 1000000});
  read_margins(config.section("margin"), out);
  read_memory(config.section("map"), out.memory);
  read_view(config.section("view"), out.repair.view);
  out.memory.view = out.repair.view;
  const Config repair = config.section("repair");
  read_repair(repair, out.repair);
  read_radius(repair, vehicle, out.repair);
  read_search(repair.section("search"), out.repair.search);
  read_smoother(repair.section("smoother"), out.repair.smoother);
  read_full(config.section("full"), out, out.full);
  config.finish();
  out.repair.footprint = out.footprint;
  return out;
}

}  // namespace rover::planning
