#include "common/bus/navigation_config.hpp"

namespace rover {

NavigationConfig load_navigation(const std::string& config_dir, ParameterList* list) {
  NavigationConfig c;
  Parameters p(config_dir + "/navigation.yaml", "Values that several services share.", list);
  p.add("goal_tolerance_m", c.goal_tolerance_m, {0.05, 5.0},
        "distance to the end of the path at which the goal is reached");
  p.add("corridor_half_width_m", c.corridor_half_width_m, {0.5, 20.0},
        "of global paths planned or drawn on the ground");
  p.add_deg("point_turn_start_deg", c.point_turn_start_rad, {5.0, 90.0}, "larger heading errors start a point turn");
  p.add_deg("point_turn_stop_deg", c.point_turn_stop_rad, {0.2, 20.0}, "a point turn ends within this heading error");
  p.add("teleop_max_age_s", c.teleop_max_age_s, {0.1, 5.0}, "the rover stops without a newer TELEOP command");
  p.check(c.point_turn_stop_rad < c.point_turn_start_rad, "point_turn_start_deg",
          "must be larger than point_turn_stop_deg");
  p.add_deg("steep_slope_deg", c.steep_slope_rad, {0.0, 35.0},
            "steeper ground on the orbital map is classified as steep, and the page warns of a path over it");
  p.add_deg("max_slope_deg", c.max_slope_rad, {1.0, 35.0},
            "steeper ground on the orbital map is an obstacle (HDPR): no path is planned or accepted over it");
  p.check(c.steep_slope_rad <= c.max_slope_rad, "steep_slope_deg", "must not be larger than max_slope_deg");
  p.add("hazard_roi_near_m", c.hazard_roi_near_m, {0.0, 10.0},
        "start of the region of interest of hazard detection, ahead of the camera");
  p.add("hazard_roi_far_m", c.hazard_roi_far_m, {0.1, 20.0}, "its end");
  p.check(c.hazard_roi_far_m > c.hazard_roi_near_m, "hazard_roi_far_m", "must be beyond hazard_roi_near_m");
  p.add(
      "cpu_scale", c.cpu_scale, {1.0, 100.0},
      "modelled computer: multiplies the latencies of the services, and the limits in fdir.yaml of the ages that they "
      "cause");
  p.finish();
  return c;
}

}  // namespace rover
