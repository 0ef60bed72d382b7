// True surface over the local ground, in cells of 0.05 m, evaluated where it is asked for.
//
// Local ground: mean of the ground without rocks over a square of 1.2 m. It follows slopes up to their curvature, not
// rocks, so a rock keeps its whole height and a bump of the ground counts like one.
#pragma once

#include "tools/report/run_record.hpp"
#include "tools/report/tiled_grid.hpp"

namespace rover::report {

struct ReliefCell {
  float ground_m = 0.0F;    // local ground at the centre, in map
  float rise_m = 0.0F;      // highest surface in the cell over the local ground
  float tall_ratio = 0.0F;  // area of the cell with a surface of at least 0.15 m
};

class TrueRelief {
 public:
  // Both heights of the world must be known.
  explicit TrueRelief(const TrueWorld& world);
  TrueRelief(const TrueRelief&) = delete;
  TrueRelief& operator=(const TrueRelief&) = delete;

  const ReliefCell& at(const Eigen::Vector2d& p) { return cells_.at_point(p.x(), p.y()); }

 private:
  void fill(int ix, int iy, std::vector<ReliefCell>& tile) const;

  const TrueWorld& world_;
  TiledGrid<ReliefCell> cells_;
};

}  // namespace rover::report
