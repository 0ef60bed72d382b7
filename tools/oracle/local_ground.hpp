// Local ground: mean of the ground without rocks over a square of 1.2 m. It follows slopes up to their curvature, not
// rocks, so a rock keeps its whole height and a bump of the ground counts like one.
#pragma once

#include "common/core/frames.hpp"
#include "tools/oracle/tiled_grid.hpp"

namespace rover::oracle {

using HeightFunction = std::function<double(double x_m, double y_m)>;

// Each place is evaluated once, when first asked for.
class LocalGround {
 public:
  explicit LocalGround(HeightFunction ground_m) : ground_m_(std::move(ground_m)) {}

  double at(double x_m, double y_m);

 private:
  struct Node {
    double ground_m = kNaN;
    double mean_m = kNaN;
  };
  static constexpr double kNodeM = 0.2;   // interpolated between nodes
  static constexpr int kWindowNodes = 3;  // half side of the square

  double ground_m(int i, int j);
  double mean_m(int i, int j);

  HeightFunction ground_m_;
  TiledGrid<Node> nodes_{kNodeM};
};

}  // namespace rover::oracle
