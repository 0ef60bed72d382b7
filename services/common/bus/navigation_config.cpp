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
  p.finish();
  return c;
}

}  // namespace rover
