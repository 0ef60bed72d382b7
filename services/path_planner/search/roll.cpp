#include "path_planner/search/roll.hpp"

namespace rover::planning {

RollCheck::RollCheck(const RollCosts& costs, const Costmap& costmap, const Footprint& footprint, const Pose2& rover,
                     double tolerance_rad)
    : costs_(costs),
      costmap_(costmap),
      footprint_(footprint),
      limit_rad_(costmap.backing_up() ? kInfinity : std::max(costs.max_rad, roll_rad(rover)) + tolerance_rad) {}

double RollCheck::factor(const Pose2& pose) const {
  const double roll = roll_rad(pose);
  if (roll > limit_rad_) return kInfinity;
  const double over = roll / costs_.max_rad - RollCosts::kFreeRatio;
  return 1.0 + costs_.cost * std::max(0.0, over) / (1.0 - RollCosts::kFreeRatio);
}

double RollCheck::roll_rad(const Pose2& pose) const {
  if (!costmap_.has_heights()) return 0.0;
  const double c = std::cos(pose.yaw_rad);
  const double s = std::sin(pose.yaw_rad);
  double rise_m = 0.0;   // sum of the heights, right wheels negative
  double width_m = 0.0;  // and of the distances from the middle
  for (const Point2& wheel : footprint_.wheels) {
    const double height_m =
        costmap_.height_m({pose.x_m + c * wheel.x_m - s * wheel.y_m, pose.y_m + s * wheel.x_m + c * wheel.y_m});
    if (std::isnan(height_m)) return 0.0;
    rise_m += wheel.y_m > 0.0 ? height_m : -height_m;
    width_m += std::abs(wheel.y_m);
  }
  return std::abs(std::atan2(rise_m, width_m));
}

}  // namespace rover::planning
