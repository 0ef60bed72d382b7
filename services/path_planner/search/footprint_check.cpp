#include "path_planner/search/footprint_check.hpp"

namespace rover::planning {
namespace {

constexpr double kTurnViewRad = 0.4;
constexpr double kShadowM = 0.5;  // of a rock of 0.2 m, seen from 1.2 m

}  // namespace

FootprintCheck::FootprintCheck(const Costmap& costmap, const Footprint& footprint, double margin_m, double approach_m,
                               double known_margin_m, const Pose2& start, const Pose2& planned_from)
    : costmap_(costmap),
      footprint_(footprint),
      margin_m_(margin_m),
      approach_m_(approach_m),
      start_(start),
      planned_from_(planned_from) {
  const double x = footprint.half_length_m + known_margin_m;
  const double y = footprint.half_width_m + known_margin_m;
  const int nx = static_cast<int>(std::ceil(2.0 * x / costmap.cell_m()));
  const int ny = static_cast<int>(std::ceil(2.0 * y / costmap.cell_m()));
  for (int i = 0; i < ny; ++i) edge_.push_back({x, y * (2.0 * i / ny - 1.0)});
  for (int i = 0; i < nx; ++i) edge_.push_back({x * (1.0 - 2.0 * i / nx), y});
  for (int i = 0; i < ny; ++i) edge_.push_back({-x, y * (1.0 - 2.0 * i / ny)});
  for (int i = 0; i < nx; ++i) edge_.push_back({x * (2.0 * i / nx - 1.0), -y});
}

bool FootprintCheck::violates(const Pose2& pose, const Hazard& hazard) const {
  const double d = distance_m(pose, hazard);
  if (d >= margin_m_) return false;
  const double onto_m = std::min(distance_m(planned_from_, hazard) - approach_m_, 0.5 * costmap_.cell_m());
  return d < std::min(margin_m_, std::max(distance_m(start_, hazard) - approach_m_ - slide_m_, onto_m));
}

bool FootprintCheck::enters(const Pose2& pose, Point2 unknown) const {
  if (!costmap_.contains(unknown)) return true;
  const Point2 cell = costmap_.center_of(costmap_.cell_of(unknown));
  return footprint_.distance_m(pose, cell) < footprint_.distance_m(start_, cell) - approach_m_;
}

bool FootprintCheck::clear(const Pose2& pose) const {
  const double reach = footprint_.radius_m() + margin_m_;
  if (costmap_.hazard_distance_m(position(pose)) > reach + costmap_.cell_m()) return true;
  for (const Hazard& hazard : costmap_.hazards_near(position(pose), reach)) {
    if (std::abs(hazard.p.x_m - pose.x_m) <= reach && violates(pose, hazard)) return false;
  }
  return true;
}

double FootprintCheck::clearance_m(const Pose2& pose, double max) const {
  double nearest = max;
  for (const Hazard& hazard : costmap_.hazards_near(position(pose), footprint_.radius_m() + max))
    nearest = std::min(nearest, distance_m(pose, hazard));
  return nearest;
}

std::vector<Pose2> turn_views(double from_yaw_rad, const Pose2& to) {
  const double turn_rad = to.yaw_rad - from_yaw_rad;
  const int steps = 1 + static_cast<int>(std::abs(turn_rad) / kTurnViewRad);
  std::vector<Pose2> views;
  for (int k = 1; k <= steps; ++k) views.push_back({to.x_m, to.y_m, from_yaw_rad + turn_rad * k / steps});
  return views;
}

bool Visibility::covers(const Pose2& pose) const {
  return check_.all_unknown(pose, [&](Point2 p) {
    return std::any_of(views_.begin(), views_.end(), [&](const View& view) { return sees(view, p); });
  });
}

bool Visibility::sees(const View& view, Point2 p) const {
  const double dx = p.x_m - view.from.x_m;
  const double dy = p.y_m - view.from.y_m;
  const Point2 in_body{view.cos_yaw * dx + view.sin_yaw * dy, view.cos_yaw * dy - view.sin_yaw * dx};
  if (!view_.sees(in_body)) return false;
  // Towards the camera, over the length of a shadow.
  const double to_x = view_.camera.x_m - in_body.x_m;
  const double to_y = view_.camera.y_m - in_body.y_m;
  const double step = costmap_.cell_m() / std::hypot(to_x, to_y);
  for (double u = step; u < std::min(1.0, step * kShadowM / costmap_.cell_m()); u += step) {
    const double x = u * to_x;
    const double y = u * to_y;
    const Point2 q{p.x_m + view.cos_yaw * x - view.sin_yaw * y, p.y_m + view.sin_yaw * x + view.cos_yaw * y};
    if (costmap_.hazard_distance_m(q) < costmap_.cell_m()) return false;
  }
  return true;
}

}  // namespace rover::planning
