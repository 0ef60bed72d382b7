// The pan-tilt unit of the simulated rover: goes to where it was last told at a constant rate, and asks for a picture
// once it stands there. What it reports of its angles is what its encoders say; it stands a little beside that.
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
  // `repeatability_rad`: standard deviation of where the unit comes to rest, of each axis.
  PanTiltSim(const PanTiltUnit& unit, double repeatability_rad, std::uint64_t seed);

  // Clipped to the limits; ignored where it is not finite. It replaces the command before with its picture.
  void command(const PanTiltCommand& command);
  void advance(double dt_s);

  const PanTiltState& state() const { return state_; }
  // True angles.
  double pan_rad() const { return state_.pan_rad + pan_error_rad_; }
  double tilt_rad() const { return state_.tilt_rad + tilt_error_rad_; }
  // A picture was asked for and the unit stands.
  bool picture_due() const { return wanted_.take_image && !state_.moving; }
  void picture_taken() { wanted_.take_image = false; }

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
