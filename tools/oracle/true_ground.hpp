// Hazards of the true surface: cells that rise above the local ground by the limit of a wheel or of the body.
#pragma once

#include <functional>
#include <vector>

#include "common/core/frames.hpp"
#include "tools/oracle/tile_grid.hpp"

namespace rover::oracle {

using HeightFunction = std::function<double(double x_m, double y_m)>;

struct GroundConfig {
  double wheel_limit_m = 0.15;  // as Vehicle::hazard_height_m
  double body_limit_m = 0.20;   // as Vehicle::max_climb_m
  double window_m = 0.75;       // half side of the ground that counts as local: half the wheelbase
};

// Centre of a cell of kCellM.
struct Hazard {
  float x_m = 0.0F;
  float y_m = 0.0F;
  bool body = false;  // also of the body
};

// The box is the part of the map that is asked for; each place is evaluated once, when first asked for.
class TrueGround {
 public:
  static constexpr double kCellM =
      0.05;  // as the simulator's test of the belly; a rock of 0.15 m is 4 cells wide or more
  static constexpr double kBlockM = 0.5;  // side of a block of cells
  static constexpr double kReachM = 5.0;  // ground around the box that is evaluated too

  TrueGround(HeightFunction height_m, const GroundConfig& config, double x0_m, double y0_m, double x1_m, double y1_m);

  int block_index(double m) const { return blocks_.index(m); }
  // The rims of the block's hazards: what is inside them cannot be reached.
  const std::vector<Hazard>& hazards(int bx, int by);
  // Of the ground below the rocks, over the wheelbase.
  double slope_rad(double x_m, double y_m);
  double local_ground_m(double x_m, double y_m);

 private:
  struct Gradient {
    float x = 0.0F;
    float y = 0.0F;
  };
  struct Block {
    float low_m = kUnknown;
    Gradient gradient{kUnknown, kUnknown};
    float slope_rad = kUnknown;
    bool classified = false;
    std::vector<Hazard> hazards;
  };
  struct Height {
    float m = kUnknown;
  };
  static constexpr float kUnknown = 1e30F;

  float height(int ix, int iy);
  float node(int nx, int ny);
  float block_low(int bx, int by);
  Gradient gradient(int bx, int by);
  void classify(int bx, int by, Block& block);

  HeightFunction height_m_;
  GroundConfig config_;
  TileGrid<Height> heights_;
  TileGrid<Height> nodes_;
  TileGrid<Block> blocks_;
  std::vector<float> samples_;
};

}  // namespace rover::oracle
