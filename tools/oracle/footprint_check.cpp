#include "tools/oracle/footprint_check.hpp"

#include <cmath>

namespace rover::oracle {
namespace {

// A wheel is 0.25 m long: no rim passes between two poses.
constexpr double kStepM = 0.1;
constexpr double kStepRad = to_rad(4.0);
// As cost.max_slope_deg of traversability: steeper ground is impassable on board.
constexpr double kMaxSlopeRad = to_rad(19.0);

}  // namespace

bool FootprintCheck::on_wheel(double x_m, double y_m) const {
  for (size_t i = 0; i < vehicle_.wheel_x_m.size(); ++i)
    if (std::abs(x_m - vehicle_.wheel_x_m[i]) <= vehicle_.wheel_radius_m + kHalfCellM &&
        std::abs(y_m - vehicle_.wheel_y_m[i]) <= 0.5 * vehicle_.wheel_width_m + kHalfCellM)
      return true;
  return false;
}

bool FootprintCheck::is_free(const Pose2& pose) const {
  if (ground_.slope_rad(pose.x_m, pose.y_m) > kMaxSlopeRad) return false;
  const double c = std::cos(pose.yaw_rad);
  const double s = std::sin(pose.yaw_rad);
  const double reach_x = half_length_m_ * std::abs(c) + half_width_m_ * std::abs(s);
  const double reach_y = half_length_m_ * std::abs(s) + half_width_m_ * std::abs(c);
  const int x1 = ground_.block_index(pose.x_m + reach_x);
  const int y1 = ground_.block_index(pose.y_m + reach_y);
  for (int by = ground_.block_index(pose.y_m - reach_y); by <= y1; ++by)
    for (int bx = ground_.block_index(pose.x_m - reach_x); bx <= x1; ++bx)
      for (const Hazard& hazard : ground_.hazards(bx, by)) {
        const double dx = hazard.x_m - pose.x_m;
        const double dy = hazard.y_m - pose.y_m;
        const double x = c * dx + s * dy;
        const double y = c * dy - s * dx;
        if (std::abs(x) > half_length_m_ || std::abs(y) > half_width_m_) continue;
        if (hazard.body || on_wheel(x, y)) return false;
      }
  return true;
}

bool FootprintCheck::is_free(const Piece& piece) const {
  const double steps = piece.is_turn() ? std::abs(piece.turn_rad) / kStepRad : piece.length_m() / kStepM;
  const int n = std::max(1, static_cast<int>(std::ceil(steps - 1e-6)));
  // The end first: it is the most likely to be blocked.
  for (int i = n; i >= 1; --i)
    if (!is_free(piece.pose_at(static_cast<double>(i) / n))) return false;
  return true;
}

}  // namespace rover::oracle
