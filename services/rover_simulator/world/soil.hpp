// Zones of soil: a low-frequency noise tells sand, firm ground and bedrock apart, and the slope has its say.
#pragma once

#include <cstdint>
#include <optional>

#include "rover_simulator/world/surface.hpp"

namespace rover {

struct SoilConfig {
  std::optional<Soil> everywhere;  // set: no zones
  double patch_m = 14.0;           // typical size of a zone
  double sand_fraction = 0.12;     // of level ground
  double bedrock_fraction = 0.08;
  double sand_max_slope_rad = 0.17;     // loose sand lies on gentle ground
  double bedrock_min_slope_rad = 0.31;  // steeper ground is bare
};

class SoilZones {
 public:
  SoilZones(const SoilConfig& config, std::uint64_t seed);

  // The noise of the zones, standard deviation about 1.
  double zone(double x_m, double y_m) const;
  Soil soil(double zone, double slope_rad) const;
  // Weights of sand and bedrock in [0, 1], continuous over the zones' borders.
  struct Blend {
    double sand, bedrock;
  };
  Blend blend(double zone) const;

 private:
  SoilConfig config_;
  std::uint64_t seed_;
  double sand_below_ = 0.0;
  double bedrock_above_ = 0.0;
};

}  // namespace rover
