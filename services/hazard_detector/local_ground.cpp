#include "hazard_detector/local_ground.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rover::hazard {
namespace {

struct GridNode {
  float low_m = 0.0f;
  float high_m = 0.0f;
};

float quantile(std::vector<float>& values, double q) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

class LocalGroundBuilder {
 public:
  LocalGroundBuilder(const std::vector<float>& over_plane_m, const GridShape& shape, const LocalGroundConfig& config,
                     double front_axle_x_m)
      : heights_(over_plane_m), shape_(shape), config_(config), front_axle_x_m_(front_axle_x_m) {
    step_ = std::max(1, static_cast<int>(std::lround(config.node_m / shape.cell_m)));
    radius_ = std::max(1, static_cast<int>(std::lround(config.window_m / shape.cell_m)));
    nodes_x_ = shape.cells_x / step_ + 2;
    const int nodes_y = shape.cells_y / step_ + 2;
    for (int j = 0; j < nodes_y; ++j)
      for (int i = 0; i < nodes_x_; ++i) nodes_.push_back(node(i * step_, j * step_));
  }

  // Bilinear interpolation between the four nodes around the cell.
  GridNode at(int ix, int iy) const {
    const int i = ix / step_, j = iy / step_;
    const float u = static_cast<float>(ix % step_) / static_cast<float>(step_);
    const float v = static_cast<float>(iy % step_) / static_cast<float>(step_);
    const GridNode &a = nodes_[static_cast<size_t>(j * nodes_x_ + i)],
                   &b = nodes_[static_cast<size_t>(j * nodes_x_ + i + 1)];
    const GridNode &c = nodes_[static_cast<size_t>((j + 1) * nodes_x_ + i)],
                   &d = nodes_[static_cast<size_t>((j + 1) * nodes_x_ + i + 1)];
    const auto bilinear = [u, v](float p, float q, float r, float s) {
      return (1 - v) * ((1 - u) * p + u * q) + v * ((1 - u) * r + u * s);
    };
    return {bilinear(a.low_m, b.low_m, c.low_m, d.low_m), bilinear(a.high_m, b.high_m, c.high_m, d.high_m)};
  }

 private:
  GridNode node(int ix, int iy) {
    window_.clear();
    for (int y = std::max(0, iy - radius_); y <= std::min(shape_.cells_y - 1, iy + radius_); ++y)
      for (int x = std::max(0, ix - radius_); x <= std::min(shape_.cells_x - 1, ix + radius_); ++x) {
        const float height = heights_[static_cast<size_t>(shape_.at(x, y))];
        if (!std::isnan(height)) window_.push_back(height);
      }
    if (static_cast<int>(window_.size()) < config_.min_cells) return {};
    const double ahead_m = std::max(0.0, shape_.x_m(ix) - front_axle_x_m_);
    const float bound = static_cast<float>(config_.max_deviation_m + config_.max_deviation_m_per_m * ahead_m);
    const float low = quantile(window_, config_.low_quantile);
    const float high = quantile(window_, config_.high_quantile);
    return {std::clamp(low, -bound, bound), std::clamp(high, -bound, bound)};
  }

  const std::vector<float>& heights_;
  const GridShape& shape_;
  const LocalGroundConfig& config_;
  double front_axle_x_m_;
  int step_ = 1;
  int radius_ = 1;
  int nodes_x_ = 0;
  std::vector<GridNode> nodes_;
  std::vector<float> window_;
};

// Separable minimum filter; NaN cells are ignored.
std::vector<float> min_filter(const std::vector<float>& heights, const GridShape& shape, int radius) {
  std::vector<float> along_x(heights.size()), both(heights.size());
  const auto min_ignoring_nan = [](float a, float b) { return std::isnan(a) || b < a ? b : a; };
  const auto pass = [&](const std::vector<float>& from, std::vector<float>& to, int dx, int dy) {
    for (int iy = 0; iy < shape.cells_y; ++iy)
      for (int ix = 0; ix < shape.cells_x; ++ix) {
        float low = std::numeric_limits<float>::quiet_NaN();
        for (int k = -radius; k <= radius; ++k)
          if (shape.contains(ix + k * dx, iy + k * dy))
            low = min_ignoring_nan(low, from[static_cast<size_t>(shape.at(ix + k * dx, iy + k * dy))]);
        to[static_cast<size_t>(shape.at(ix, iy))] = low;
      }
  };
  pass(heights, along_x, 1, 0);
  pass(along_x, both, 0, 1);
  return both;
}

}  // namespace

LocalGround estimate_local_ground(const std::vector<float>& over_plane_m, const GridShape& shape,
                                  const LocalGroundConfig& config, double front_axle_x_m) {
  const LocalGroundBuilder builder(over_plane_m, shape, config, front_axle_x_m);
  const int step_radius = static_cast<int>(std::lround(config.step_radius_m / shape.cell_m));
  const std::vector<float> lowest = min_filter(over_plane_m, shape, step_radius);
  const float tolerance = static_cast<float>(config.step_tolerance_m);
  LocalGround ground;
  ground.low_m.reserve(over_plane_m.size());
  ground.high_m.reserve(over_plane_m.size());
  for (int iy = 0; iy < shape.cells_y; ++iy)
    for (int ix = 0; ix < shape.cells_x; ++ix) {
      const GridNode node = builder.at(ix, iy);
      const float step_limit = lowest[static_cast<size_t>(shape.at(ix, iy))] + tolerance;
      ground.low_m.push_back(step_limit < node.low_m ? step_limit : node.low_m);  // false for NaN
      ground.high_m.push_back(node.high_m);
    }
  return ground;
}

}  // namespace rover::hazard
