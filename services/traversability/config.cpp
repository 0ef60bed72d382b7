#include "traversability/config.hpp"

#include "common/bus/vehicle_config.hpp"

namespace rover::trav {
namespace {

void add_plane(Parameters p, PlaneConfig& c) {
  p.add("radius_m", c.radius_m, {0.2, 3.0}, "of the disc: half the length of the rover");
  p.add("min_seen_fraction", c.min_seen_fraction, {0.01, 1.0},
        "of the disc's cells; a corner of the seen area has a quarter");
  p.add("min_spread_m", c.min_spread_m, {0.01, 1.0}, "standard deviation of the cells' positions along the minor axis");
}

void add_step(Parameters p, StepConfig& c) {
  p.add("radius_m", c.radius_m, {0.05, 1.0}, "diameter of a wheel: a rise within this distance is a step");
  p.add("mean_height_ratio", c.mean_height_ratio, {0.3, 1.0},
        "of a rock's height that remains in the mean heights of cells");
  p.add("grow_height_m", c.grow_height_m, {0.01, 0.5}, "lower rise threshold for neighbours of an obstacle");
  p.add("significance", c.significance, {0.0, 10.0}, "in standard deviations; smaller differences are noise");
  p.add("max_sigma_m", c.max_sigma_m, {0.005, 1.0}, "cells above are unknown");
}

void add_cost(Parameters p, CostConfig& c) {
  p.add_deg("max_slope_deg", c.max_slope_rad, {1.0, 45.0}, "impassable beyond; the scenarios go to 15");
  p.add("slope_exponent", c.slope_exponent, {0.5, 4.0},
        "fits 10/15/25/40 at 0/5/10/15 deg (Azkarate et al. 2020), scaled to the limit");
  p.add("step_exponent", c.step_exponent, {0.5, 4.0}, "of the rise relative to the step limit");
  p.add("max_roughness_m", c.max_roughness_m, {0.005, 1.0}, "rms about the plane with the maximum cost");
  p.add("roughness_exponent", c.roughness_exponent, {0.5, 4.0}, "of the rms relative to max_roughness_m");
}

void add_ahead(Parameters p, AheadConfig& c) {
  p.add("near_m", c.near_m, {0.0, 20.0}, "start of the region, ahead of the body origin");
  p.add("far_m", c.far_m, {0.5, 20.0}, "its end");
  p.add("half_width_m", c.half_width_m, {0.1, 10.0}, "to either side");
  p.add("clearance_m", c.clearance_m, {0.0, 5.0},
        "cells nearer to an obstacle are blocked: half the rover's width plus margin");
  p.add("min_known_fraction", c.min_known_fraction, {0.01, 1.0}, "of the region's cells; less: NaN");
  p.check(c.far_m > c.near_m, "far_m", "must be beyond near_m");
}

}  // namespace

NodeConfig load_config(const std::string& config_dir, ParameterList* list) {
  NodeConfig config;
  TraversabilityConfig& c = config.core;
  apply_vehicle_limits(load_vehicle(config_dir), c);
  Parameters p(config_dir + "/traversability.yaml",
               "Costs of the Full level's map. Hazard height, climb limit and belly clearance: vehicle.yaml.", list);
  p.add_s("latency_s", config.latency_us, {0.02, 5.0}, "modelled processing time, map to costs");
  p.add("max_map_age_s", config.max_map_age_s, {0.1, 60.0}, "older elevation maps are rejected");
  p.add("max_pose_age_s", config.max_pose_age_s, {0.02, 60.0}, "with an older pose the difficulty is NaN");
  add_plane(p.section("plane", "slope and roughness, over the rover's size"), c.plane);
  add_step(p.section("step", "steps and obstacles"), c.step);
  add_cost(p.section("cost", "of a cell: sum of slope, step and roughness, each relative to its limit"), c.cost);
  add_ahead(p.section("ahead", "region for the difficulty, compared with easy_difficulty of supervisor.yaml"), c.ahead);
  p.finish();
  return config;
}

}  // namespace rover::trav
