#include "supervisor/terrain_view.hpp"

#include <algorithm>
#include <cmath>

namespace rover::supervisor {
namespace {

// Counts known cells at positions in the body frame.
class KnownCounter {
 public:
  KnownCounter(const CostmapView& map, const Pose2& body) : map_(map), body_(body) {}
  void sample(double forward_m, double left_m) {
    const double c = std::cos(body_.yaw_rad), s = std::sin(body_.yaw_rad);
    known_ += map_.known(body_.x_m + c * forward_m - s * left_m, body_.y_m + s * forward_m + c * left_m) ? 1 : 0;
    ++sampled_;
  }
  double fraction() const { return static_cast<double>(known_) / sampled_; }

 private:
  const CostmapView& map_;
  const Pose2& body_;
  int known_ = 0;
  int sampled_ = 0;
};

}  // namespace

bool CostmapView::known(double x_m, double y_m) const {
  const double column = std::floor((x_m - origin_x_m) / cell_m);
  const double row = std::floor((y_m - origin_y_m) / cell_m);
  if (!(column >= 0.0 && row >= 0.0 && column < cells_x && row < cells_y)) return false;
  const size_t index = static_cast<size_t>(row) * static_cast<size_t>(cells_x) + static_cast<size_t>(column);
  return index < cells.size() && cells[index] != unknown;
}

KnownFractions known_fractions(const CostmapView& map, const Pose2& body_odom) {
  KnownCounter ahead(map, body_odom), left(map, body_odom), right(map, body_odom);
  for (int i = 0; i <= 18; ++i)
    for (int j = -6; j <= 6; ++j) ahead.sample(1.2 + 0.1 * i, 0.1 * j);
  for (int i = 0; i <= 10; ++i)
    for (int j = 2; j <= 10; ++j) {
      const double range_m = 1.5 + 0.25 * i, bearing_rad = to_rad(5.0 * j);
      left.sample(range_m * std::cos(bearing_rad), range_m * std::sin(bearing_rad));
      right.sample(range_m * std::cos(bearing_rad), -range_m * std::sin(bearing_rad));
    }
  return {ahead.fraction(), std::min(left.fraction(), right.fraction())};
}

}  // namespace rover::supervisor
