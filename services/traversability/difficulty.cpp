#include "traversability/difficulty.hpp"

#include <algorithm>
#include <cmath>

#include "common/core/distance_field.hpp"

namespace rover::trav {
namespace {

struct Sums {
  int known = 0;
  int blocked = 0;
  double cost = 0.0;  // relative to the maximum
};

class AheadRegion {
 public:
  AheadRegion(const Pose2& body, const AheadConfig& config)
      : body_(body), config_(config), cos_(std::cos(body.yaw_rad)), sin_(std::sin(body.yaw_rad)) {}

  bool contains(double x_m, double y_m) const {
    const double dx = x_m - body_.x_m, dy = y_m - body_.y_m;
    const double ahead = cos_ * dx + sin_ * dy, lateral = cos_ * dy - sin_ * dx;
    return ahead >= config_.near_m && ahead <= config_.far_m && std::abs(lateral) <= config_.half_width_m;
  }
  double area_m2() const { return (config_.far_m - config_.near_m) * 2.0 * config_.half_width_m; }

 private:
  const Pose2& body_;
  const AheadConfig& config_;
  double cos_, sin_;
};

}  // namespace

double difficulty_ahead(const TraversabilityMap& map, const Pose2& body, const AheadConfig& config) {
  const GridShape& shape = map.shape;
  const AheadRegion ahead(body, config);
  const std::vector<double> clearance_m = distance_field(map.obstacle, shape.cells_x, shape.cells_y, shape.cell_m);
  Sums sums;
  for (int iy = 0; iy < shape.cells_y; ++iy)
    for (int ix = 0; ix < shape.cells_x; ++ix) {
      const std::size_t i = shape.at(ix, iy);
      if (map.cells[i] == kUnknown || !ahead.contains(shape.x_m(ix), shape.y_m(iy))) continue;
      ++sums.known;
      sums.blocked += clearance_m[i] < config.clearance_m;
      sums.cost += static_cast<double>(map.cells[i]) / kImpassable;
    }
  const double cells = ahead.area_m2() / (shape.cell_m * shape.cell_m);
  if (sums.known == 0 || sums.known < config.min_known_fraction * cells) return kNaN;
  return std::max<double>(sums.blocked, sums.cost) / sums.known;
}

}  // namespace rover::trav
