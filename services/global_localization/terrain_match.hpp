// Match quality of the template at a candidate pose on the orbital map: the correlation of gradients or edges
// discriminates between places, the height residual localises precisely. Edges do both.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "global_localization/terrain_template.hpp"

namespace rover::global {

// Masked normalised cross-correlation (Padfield 2012) over samples valid in both maps. Means are subtracted because a
// common tilt carries no position information.
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
  // In [-1, 1]; 0 without overlap.
  double correlation() const;
};

// Position of the template's centre in map, and yaw from odom to map.
struct CandidatePose {
  Eigen::Vector2d center_map = Eigen::Vector2d::Zero();
  double yaw_rad = 0.0;
};

struct Fit {
  int compared = 0;          // samples valid in both maps
  double correlation = 0.0;  // of the gradients or edges
  // Heights: rms difference after removing the fitted drift [m]. Pictures: what the correlation leaves unexplained,
  // sqrt(1 - correlation^2).
  double residual = 0.0;
};

// Turns a gradient or an edge with the ground.
Eigen::Rotation2Dd turn_of(Layer layer, double yaw_rad);

// Section of the orbital map, filtered like the template and interpolated by cubic convolution (Keys 1981).
class OrbitalSection {
 public:
  explicit OrbitalSection(PlaneField field);

  const PlaneField& field() const { return field_; }
  Fit fit(const TerrainTemplate& terrain, const CandidatePose& pose) const;
  // Square of the fit's residual; infinite with fewer than `min_compared` valid samples.
  double mean_square(const TerrainTemplate& terrain, const CandidatePose& pose, int min_compared) const;

 private:
  struct Stencil;  // 4 x 4 cells around a position, with interpolation weights
  bool find_stencil(const Eigen::Vector2d& p_map, Stencil& stencil) const;

  PlaneField field_;
  std::vector<std::uint8_t> stencil_known_;  // per cell: its whole 4 x 4 stencil is known
};

}  // namespace rover::global
