// Fine surface for wheels and cameras, in the map frame. Implementations are pure functions of position.
#pragma once

#include <cstdint>

namespace rover {

enum class Soil : std::int8_t { kSand = 0, kFirm = 1, kBedrock = 2 };

struct Material {
  Soil soil = Soil::kFirm;     // rocks count as bedrock
  int rock_id = -1;            // -1: ground
  double rock_height_m = 0.0;  // rock surface above the ground at this position; 0: ground
};

class Surface {
 public:
  virtual ~Surface() = default;
  virtual double height_m(double x_m, double y_m) const = 0;
  virtual Material material(double x_m, double y_m) const = 0;
};

}  // namespace rover
