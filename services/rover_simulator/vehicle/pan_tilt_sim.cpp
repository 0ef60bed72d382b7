#include "rover_simulator/vehicle/pan_tilt_sim.hpp"

#include <algorithm>
#include <cmath>

namespace rover {
namespace {

double stepped(double from, double to, double step) {
  return from + std::clamp(to - from, -step, step);
}

}  // namespace

PanTiltSim::PanTiltSim(const PanTiltUnit& unit, double repeatability_rad, std::uint64_t seed)
    : unit_(unit), repeatability_rad_(repeatability_rad), random_(seed) {}

void PanTiltSim::command(const PanTiltCommand& command) {
  if (!std::isfinite(command.pan_rad) || !std::isfinite(command.tilt_rad)) return;
  wanted_ = {unit_.clamp_pan(command.pan_rad), unit_.clamp_tilt(command.tilt_rad), command.take_image};
  state_.moving = wanted_.pan_rad != state_.pan_rad || wanted_.tilt_rad != state_.tilt_rad;
}

void PanTiltSim::advance(double dt_s) {
  if (!state_.moving) return;
  const double step = unit_.rate_radps * dt_s;
  state_.pan_rad = stepped(state_.pan_rad, wanted_.pan_rad, step);
  state_.tilt_rad = stepped(state_.tilt_rad, wanted_.tilt_rad, step);
  state_.moving = wanted_.pan_rad != state_.pan_rad || wanted_.tilt_rad != state_.tilt_rad;
  if (state_.moving) return;
  std::normal_distribution<double> error(0.0, repeatability_rad_);
  pan_error_rad_ = error(random_);
  tilt_error_rad_ = error(random_);
}

}  // namespace rover
