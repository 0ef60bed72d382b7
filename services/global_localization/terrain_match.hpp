// How well the template fits the orbital map at a place and a turn: by the correlation of the gradients, which tells
// places apart, and by what is left of the heights' difference, which says where exactly the place is.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "global_localization/terrain_template.hpp"

namespace rover::global {

// Masked normalised cross-correlation: sums over those samples alone that both maps know. Means are taken out: a common
// tilt tells nothing of the place.
struct CorrelationSums {
  int count = 0;
  double tx = 0.0, ty = 0.0, tt = 0.0;  // template: sums of the components, sum of squares
  double mx = 0.0, my = 0.0, mm = 0.0;  // orbital map
  double tm = 0.0;

  void add(double t_x, double t_y, double m_x, double m_y) {
    ++count;
    tx += t_x, ty += t_y, tt += t_x * t_x + t_y * t_y;
    mx += m_x, my += m_y, mm += m_x * m_x + m_y * m_y;
    tm += t_x * m_x + t_y * m_y;
  }
  // -1 .. 1; 0 where there is nothing to compare.
  double correlation() const;
};

// Where the template's centre lies in map, and its turn from odom to map.
struct Placement {
  Eigen::Vector2d center_map = Eigen::Vector2d::Zero();
  double yaw_rad = 0.0;
};

struct Fit {
  int compared = 0;          // samples that both maps know
  double correlation = 0.0;  // of the gradients
  double residual_m = 0.0;   // rms of the difference of the heights, without a common offset
};

// A part of the orbital map with the same filter as the template, read between its cells by cubic convolution (Keys
// 1981).
class OrbitalPart {
 public:
  explicit OrbitalPart(PlaneField field);

  const PlaneField& field() const { return field_; }
  Fit fit(const TerrainTemplate& terrain, const Placement& placement) const;
  // The residual alone [m^2]; infinite where fewer than `least` samples can be compared.
  double mean_square(const TerrainTemplate& terrain, const Placement& placement, int least) const;

 private:
  struct Square;  // the 4 x 4 cells about a place, and their weights
  bool find(const Eigen::Vector2d& p_map, Square& square) const;

  PlaneField field_;
  std::vector<std::uint8_t> surrounded_;  // all 4 x 4 cells about the square from here to the next cell are known
};

}  // namespace rover::global
