// Soil zones (sand, firm, bedrock) from low-frequency noise and slope.
#pragma once

#include <cstdint>
#include <optional>

#include "rover_simulator/world/surface.hpp"

namespace rover {

struct SoilConfig {
  std::optional<Soil> everywhere;  // set: no zones
  double patch_m = 14.0;           // typical size of a zone
  double sand_fraction = 0.12;     // on level ground
  double bedrock_fraction = 0.08;
  double sand_max_slope_rad = 0.17;     // no sand above this slope
  double bedrock_min_slope_rad = 0.31;  // only bedrock above this slope
};

class SoilZones {
 public:
  SoilZones(const SoilConfig& config, std::uint64_t seed);

  // Zone noise, standard deviation about 1.
  double zone(double x_m, double y_m) const;
  Soil soil(double zone, double slope_rad) const;
  // Weights of sand and bedrock in [0, 1], continuous across zone borders.
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
