#include "supervisor/terrain_view.hpp"

#include <algorithm>
#include <cmath>

namespace rover::supervisor {
namespace {

// Of places in body coordinates.
class Tally {
 public:
  Tally(const CostView& map, const Pose2& body) : map_(map), body_(body) {}
  void look(double forward_m, double left_m) {
    const double c = std::cos(body_.yaw_rad), s = std::sin(body_.yaw_rad);
    known_ += map_.known(body_.x_m + c * forward_m - s * left_m, body_.y_m + s * forward_m + c * left_m) ? 1 : 0;
    ++looked_;
  }
  double share() const { return static_cast<double>(known_) / looked_; }

 private:
  const CostView& map_;
  const Pose2& body_;
  int known_ = 0;
  int looked_ = 0;
};

}  // namespace

bool CostView::known(double x_m, double y_m) const {
  const double column = std::floor((x_m - origin_x_m) / cell_m);
  const double row = std::floor((y_m - origin_y_m) / cell_m);
  if (!(column >= 0.0 && row >= 0.0 && column < cells_x && row < cells_y)) return false;
  const size_t index = static_cast<size_t>(row) * static_cast<size_t>(cells_x) + static_cast<size_t>(column);
  return index < cells.size() && cells[index] != unknown;
}

KnownShares known_shares(const CostView& map, const Pose2& body_odom) {
  Tally ahead(map, body_odom), left(map, body_odom), right(map, body_odom);
  for (int i = 0; i <= 18; ++i)
    for (int j = -6; j <= 6; ++j) ahead.look(1.2 + 0.1 * i, 0.1 * j);
  for (int i = 0; i <= 10; ++i)
    for (int j = 2; j <= 10; ++j) {
      const double range_m = 1.5 + 0.25 * i, bearing_rad = to_rad(5.0 * j);
      left.look(range_m * std::cos(bearing_rad), range_m * std::sin(bearing_rad));
      right.look(range_m * std::cos(bearing_rad), -range_m * std::sin(bearing_rad));
    }
  return {ahead.share(), std::min(left.share(), right.share())};
}

}  // namespace rover::supervisor
