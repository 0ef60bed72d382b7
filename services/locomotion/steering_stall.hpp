// A steered wheel that stands against a rock stalls: its servo is too weak to push the wheel aside. Rolled on a little,
// the wheel climbs or leaves the rock and the servo brings it in. So a rover that has waited for its steering in vain
// rolls slowly with the angles it has, for a short way; where that does not help, it stands.
#pragma once

namespace rover::locomotion {

struct SteeringStallConfig {
  double patience_s = 0.5;             // the setpoints have arrived, the wheels have not: free ones lag by 0.1 s
  double most_mean_error_rad = 0.524;  // 30 deg of the four: two scrub by 60 deg, or all a little
  double speed_mps = 0.04;
  double way_m = 0.20;  // more than a wheel's radius
};

class SteeringStall {
 public:
  explicit SteeringStall(const SteeringStallConfig& config) : config_(config) {}

  // One tick in which the rover waits for its steering: the speed at which it may roll to free it, 0: stand.
  double freeing_speed_mps(double mean_error_rad, double motion_mps, double dt_s);
  // The steering has arrived.
  void clear() { waited_s_ = rolled_m_ = 0.0; }

 private:
  SteeringStallConfig config_;
  double waited_s_ = 0.0;
  double rolled_m_ = 0.0;
};

}  // namespace rover::locomotion
