#include "hazard_detector/config.hpp"

#include <algorithm>
#include <filesystem>

#include "common/bus/navigation_config.hpp"
#include "common/bus/vehicle_config.hpp"

namespace rover::hazard {
namespace {

void add_grid(Parameters p, GridConfig& c) {
  p.add("cell_m", c.cell_m, {0.02, 1.0}, "side of a cell");
  p.add("min_x_m", c.min_x_m, {-5.0, 5.0}, "rear edge");
  p.add("max_x_m", c.max_x_m, {0.5, 20.0}, "front edge");
  p.add("half_width_m", c.half_width_m, {0.5, 10.0}, "to either side");
  p.check(c.max_x_m >= c.min_x_m + c.cell_m, "max_x_m", "must be beyond min_x_m");
  // The core stores cell indices in 16 bits.
  p.check((c.max_x_m - c.min_x_m) * 2.0 * c.half_width_m / (c.cell_m * c.cell_m) <= 30000.0, "cell_m",
          "makes more than 30000 cells");
}

void add_plane(Parameters p, PlanePrior& c) {
  p.add_deg("max_slope_deg", c.max_slope_rad, {0.0, 30.0}, "bound of the slope");
  p.add("max_offset_m", c.max_offset_m, {0.0, 0.5},
        "bound of the height at the front axle; 10 deg of body pitch cause 0.13");
  p.add("inlier_m", c.inlier_m, {0.01, 0.5}, "inlier distance in the search");
  p.add("tukey_m", c.tukey_m, {0.01, 1.0}, "Tukey scale of the refinement: larger residuals have no weight");
  p.add("half_weight_m", c.half_weight_m, {0.1, 100.0}, "distance ahead of the front axle at which a cell weighs half");
  p.add("min_cells", c.min_cells, {3, 10000}, "fewer measured cells: flat ground is assumed");
}

void add_local_ground(Parameters p, LocalGroundConfig& c) {
  p.add("window_m", c.window_m, {0.1, 3.0},
        "half side of the neighbourhood; rocks must cover less than low_quantile of it");
  p.add("node_m", c.node_m, {0.05, 3.0}, "spacing of the nodes at which it is computed");
  p.add("low_quantile", c.low_quantile, {0.0, 0.5}, "of the heights: the ground that obstacles rise from");
  p.add("high_quantile", c.high_quantile, {0.5, 1.0}, "of the heights: the ground around holes");
  p.add("max_deviation_m", c.max_deviation_m, {0.0, 0.5}, "from the plane, at the front axle");
  p.add("max_deviation_m_per_m", c.max_deviation_m_per_m, {0.0, 0.5}, "growth of the bound with the distance ahead");
  p.add("min_cells", c.min_cells, {3, 10000}, "fewer measured cells in the neighbourhood: no deviation");
  p.add("step_radius_m", c.step_radius_m, {0.0, 1.0},
        "obstacle height also counts from the lowest cell within this radius");
  p.add("step_tolerance_m", c.step_tolerance_m, {0.0, 0.5}, "added to that cell: slope of the ground over the radius");
}

void add_limits(Parameters p, HazardConfig& c) {
  p.add("hole_depth_m", c.hole_depth_m, {0.02, 2.0},
        "T_far (paper: 0.40); only 0.2 m of the far wall of a 0.25 m deep hole is visible");
  p.add("grow_height_m", c.grow_height_m, {0.01, 1.0}, "region growing: higher neighbours of an obstacle belong to it");
  p.add("margin_m", c.margin_m, {0.0, 1.0}, "inflation of hazards");
  p.add("min_cell_samples", c.min_cell_samples, {1, 1000}, "hazard samples that make a cell suspect");
  p.add("min_cluster_samples", c.min_cluster_samples, {1, 10000}, "hazard samples of a connected component");
}

void add_coverage(Parameters p, HazardConfig& c) {
  p.add("min_free_fraction", c.min_free_fraction, {0.1, 1.0}, "of a free cell's expected samples: measured");
  p.add("min_free_samples", c.min_free_samples, {1, 1000}, "measured samples of a free cell");
  p.add("min_coverage", c.min_coverage, {0.05, 1.0}, "valid stereo in the region of interest; less: BLIND");
}

GroundCalibration read_calibration(const std::string& file) {
  const Config yaml = Config::load(file);
  GroundCalibration calibration;
  calibration.height_m = yaml.number("height_m", {0.1, 5.0});
  calibration.pitch_rad = to_rad(yaml.number("pitch_deg", {5.0, 85.0}));
  calibration.roll_rad = to_rad(yaml.number("roll_deg", {-45.0, 45.0}));
  yaml.finish();
  return calibration;
}

}  // namespace

NodeConfig load_config(const std::string& config_dir, ParameterList* list) {
  NodeConfig config;
  HazardConfig& c = config.core;
  const Vehicle vehicle = load_vehicle(config_dir);
  const NavigationConfig navigation = load_navigation(config_dir);
  c.roi_near_m = navigation.hazard_roi_near_m;
  c.roi_far_m = navigation.hazard_roi_far_m;
  c.origin_height_m = vehicle.origin_height_m;
  c.obstacle_height_m = vehicle.hazard_height_m;
  c.body_height_m = vehicle.max_climb_m;
  c.plane.front_axle_x_m = *std::max_element(vehicle.wheel_x_m.begin(), vehicle.wheel_x_m.end());
  Parameters p(config_dir + "/hazard_detector.yaml",
               "Hazard detection in disparity space (Azkarate et al. 2020). T_near is hazard_height_m of vehicle.yaml. "
               "The disparity look-up table is computed from hazard_detector_calibration.yaml (written by "
               "hazard_calibrate) if present, else from the camera mount in cameras.yaml.",
               list);
  p.add_s("latency_s", config.latency_us, {0.02, 5.0}, "modelled processing time, disparity to hazards");
  add_grid(p.section("grid", "rover-frame map, body frame"), c.grid);
  add_plane(p.section("plane", "ground plane ahead, relative to the plane under the rover"), c.plane);
  add_local_ground(p.section("local_ground", "deviation of natural ground from the plane"), c.local_ground);
  add_limits(p.section("limits", "of hazards"), c);
  add_coverage(p.section("coverage", "stereo that free cells and the region of interest need"), c);
  p.finish();
  const std::string calibration = config_dir + "/" + kCalibrationFile;
  if (std::filesystem::exists(calibration)) c.calibration = read_calibration(calibration);
  return config;
}

}  // namespace rover::hazard
