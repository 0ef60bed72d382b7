// Simulated pan-tilt unit: moves to the commanded angles at a constant rate and requests an image on arrival. Reported
// angles are the encoders'; the true angles differ by the repeatability.
#pragma once

#include <cstdint>
#include <random>

#include "common/core/pan_tilt.hpp"

namespace rover {

struct PanTiltCommand {
  double pan_rad = 0.0;
  double tilt_rad = 0.0;
  bool take_image = false;
};

struct PanTiltState {
  double pan_rad = 0.0;
  double tilt_rad = 0.0;
  bool moving = false;
};

class PanTiltSim {
 public:
  // `repeatability_rad`: standard deviation of the resting angle, per axis.
  PanTiltSim(const PanTiltUnit& unit, double repeatability_rad, std::uint64_t seed);

  // Clipped to the limits; ignored if not finite. Replaces the previous command and its image request.
  void command(const PanTiltCommand& command);
  void advance(double dt_s);

  const PanTiltState& state() const { return state_; }
  // True angles.
  double pan_rad() const { return state_.pan_rad + pan_error_rad_; }
  double tilt_rad() const { return state_.tilt_rad + tilt_error_rad_; }
  // An image was requested and the unit is stationary.
  bool image_due() const { return wanted_.take_image && !state_.moving; }
  void image_taken() { wanted_.take_image = false; }

 private:
  PanTiltUnit unit_;
  double repeatability_rad_;
  std::mt19937_64 random_;
  PanTiltCommand wanted_;
  PanTiltState state_;
  double pan_error_rad_ = 0.0;
  double tilt_error_rad_ = 0.0;
};

}  // namespace rover
