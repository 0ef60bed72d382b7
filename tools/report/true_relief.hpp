// True surface over the local ground, in cells of 0.05 m, evaluated where it is asked for.
#pragma once

#include "tools/oracle/local_ground.hpp"
#include "tools/report/run_record.hpp"

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
  void fill(int ix, int iy, std::vector<ReliefCell>& tile);

  const TrueWorld& world_;
  oracle::LocalGround ground_;
  oracle::TiledGrid<ReliefCell> cells_;
};

}  // namespace rover::report
