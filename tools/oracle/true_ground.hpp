// Hazards of the true surface: cells that rise above the local ground by the limit of a wheel or of the body.
#pragma once

#include <vector>

#include "common/core/zones.hpp"
#include "tools/oracle/local_ground.hpp"

namespace rover::oracle {

struct GroundConfig {
  double wheel_limit_m = 0.15;  // as Vehicle::hazard_height_m
  double body_limit_m = 0.20;   // as Vehicle::max_climb_m
  double half_wheelbase_m = 0.75;
  std::vector<Zone> zones;  // what they forbid is a hazard of the body
};

// Centre of a cell of kCellM.
struct Hazard {
  float x_m = 0.0F;
  float y_m = 0.0F;
  bool body = false;  // also of the body
};

// Each place is evaluated once, when first asked for.
class TrueGround {
 public:
  static constexpr double kCellM =
      0.05;  // as the simulator's test of the belly; a rock of 0.15 m is 4 cells wide or more
  static constexpr double kBlockM = 0.5;  // side of a block of cells

  // ground_m: without rocks.
  TrueGround(HeightFunction height_m, HeightFunction ground_m, const GroundConfig& config)
      : height_m_(std::move(height_m)), ground_(std::move(ground_m)), config_(config) {}

  int block_index(double m) const { return blocks_.index_of(m); }
  // The rims of the block's hazards: what is inside them cannot be reached.
  const std::vector<Hazard>& hazards(int bx, int by);
  // Of the ground below the rocks, over the wheelbase.
  double slope_rad(double x_m, double y_m);

 private:
  struct Block {
    float slope_rad = kUnknown;
    bool classified = false;
    std::vector<Hazard> hazards;
  };
  struct Height {
    float m = kUnknown;
  };
  static constexpr float kUnknown = 1e30F;

  float height(int ix, int iy);
  void classify(int bx, int by, Block& block);

  HeightFunction height_m_;
  LocalGround ground_;
  GroundConfig config_;
  TiledGrid<Height> heights_{kCellM};
  TiledGrid<Block> blocks_{kBlockM};
};

}  // namespace rover::oracle
