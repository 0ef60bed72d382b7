#include "rover_simulator/vehicle/wheel_soil.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "common/core/frames.hpp"

namespace rover {
namespace {

constexpr double kFullSlip = 1.2;  // bristle saturation: full sliding beyond it

struct Point {
  double slip, slope_deg;
};

// Slip against slope [project's table, estimates tied to Opportunity's 50 % in Endurance crater]; the last point of
// each is the most the soil gives at full slip.
constexpr Point kSand[] = {{0.05, 0},  {0.10, 5},    {0.22, 10}, {0.33, 12.5},
                           {0.50, 15}, {0.70, 17.5}, {0.95, 20}, {1.0, 20.3}};
constexpr Point kFirm[] = {{0.01, 0},    {0.03, 5},  {0.06, 10}, {0.09, 12.5}, {0.14, 15},
                           {0.20, 17.5}, {0.28, 20}, {0.50, 25}, {0.80, 30},   {1.0, 32}};
constexpr Point kBedrock[] = {{0.002, 0}, {0.01, 5},  {0.02, 10}, {0.03, 12.5}, {0.04, 15}, {0.05, 17.5},
                              {0.07, 20}, {0.11, 25}, {0.20, 30}, {0.5, 38},    {1.0, 45}};
constexpr std::array<double, 3> kRolling = {0.10, 0.03, 0.015};

std::span<const Point> table_of(Soil soil) {
  switch (soil) {
    case Soil::kSand:
      return kSand;
    case Soil::kBedrock:
      return kBedrock;
    case Soil::kFirm:
      break;
  }
  return kFirm;
}

double net_traction(const Point& point) {
  return std::tan(to_rad(point.slope_deg));
}

}  // namespace

double rolling_resistance(Soil soil) {
  return kRolling[static_cast<size_t>(soil)];
}

double gross_traction(Soil soil, double slip) {
  const std::span<const Point> table = table_of(soil);
  const double rolling = rolling_resistance(soil);
  if (slip <= table[0].slip) return rolling * slip / table[0].slip;
  for (size_t i = 1; i < table.size(); ++i)
    if (slip <= table[i].slip)
      return rolling + std::lerp(net_traction(table[i - 1]), net_traction(table[i]),
                                 (slip - table[i - 1].slip) / (table[i].slip - table[i - 1].slip));
  return rolling + net_traction(table.back());
}

double gross_traction(const std::array<double, 3>& soil_fraction, double slip) {
  double sum = 0.0;
  for (size_t i = 0; i < 3; ++i)
    if (soil_fraction[i] > 0.0) sum += soil_fraction[i] * gross_traction(static_cast<Soil>(i), slip);
  return sum;
}

double rolling_resistance(const std::array<double, 3>& soil_fraction) {
  return soil_fraction[0] * kRolling[0] + soil_fraction[1] * kRolling[1] + soil_fraction[2] * kRolling[2];
}

Eigen::Vector2d Bristle::step(const WheelSoilConfig& config, const std::array<double, 3>& soil_fraction, double load_n,
                              double along_mps, double across_mps, double rim_speed_mps, double dt_s) {
  const Eigen::Vector2d slip_velocity(along_mps - rim_speed_mps, across_mps);
  const Eigen::Vector2d before = deflection_m_;
  deflection_m_ += dt_s * (slip_velocity - std::abs(rim_speed_mps) / config.relaxation_m * deflection_m_);
  const double longest = kFullSlip * config.relaxation_m;
  if (const double length = deflection_m_.norm(); length > longest) deflection_m_ *= longest / length;

  const double length = deflection_m_.norm(), most = gross_traction(soil_fraction, kFullSlip);
  Eigen::Vector2d force = -config.damping_spm * (deflection_m_ - before) / dt_s;
  if (length > 0.0) force -= gross_traction(soil_fraction, length / config.relaxation_m) / length * deflection_m_;
  if (const double size = force.norm(); size > most) force *= most / size;
  force.y() *= config.lateral_factor;
  return load_n * force;
}

double rolling_force(const WheelSoilConfig& config, const std::array<double, 3>& soil_fraction, double load_n,
                     double along_mps) {
  return -rolling_resistance(soil_fraction) * load_n * std::tanh(along_mps / config.rolling_speed_mps);
}

double scrub_torque(const WheelSoilConfig& config, const std::array<double, 3>& soil_fraction, double load_n,
                    double turn_radps) {
  return -config.scrub_arm_m * load_n * gross_traction(soil_fraction, 1.0) *
         std::tanh(turn_radps / config.scrub_rate_radps);
}

}  // namespace rover
