#include "pan_tilt/sweep.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace rover::gaze {
namespace {

std::vector<double> pans(const SweepConfig& config) {
  std::vector<double> out = {0.0};
  const int steps = static_cast<int>(std::floor(config.pan_max_rad / config.pan_step_rad + 1e-9));
  for (const double side : {-1.0, 1.0})
    for (int i = 1; i <= steps; ++i) out.push_back(side * i * config.pan_step_rad);
  return out;
}

}  // namespace

std::vector<Gaze> sweep_views(const SweepConfig& config) {
  std::vector<Gaze> views;
  std::array tilts = {config.far_tilt_rad, config.near_tilt_rad};
  for (const double pan : pans(config)) {
    for (const double tilt : tilts) views.push_back({pan, tilt});
    std::reverse(tilts.begin(), tilts.end());
  }
  return views;
}

}  // namespace rover::gaze
