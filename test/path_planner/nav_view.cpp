#include "test/path_planner/nav_view.hpp"

namespace rover::planning::testing_support {
namespace {

constexpr double kRimM = 0.05;         // the map widens a rock
constexpr double kRangeGain = 20.0;    // metres of range for each metre of height
constexpr std::uint8_t kLowRock = 80;  // cost of rocks that are driven over

}  // namespace

std::uint8_t NavView::seen(const std::vector<Rock>& in_body, Point2 b, double azimuth_rad) const {
  const double dx = b.x_m - camera_.position.x_m;
  const double dy = b.y_m - camera_.position.y_m;
  const double range = std::hypot(dx, dy);
  if (range < camera_.near_m || range > camera_.far_m) return TraversabilityGrid::kUnknown;
  if (std::abs(wrap_angle(std::atan2(dy, dx) - azimuth_rad)) > camera_.half_view_rad)
    return TraversabilityGrid::kUnknown;
  const Rock* here = nullptr;
  for (const Rock& rock : in_body)
    if (distance(rock.p, b) <= rock.radius_m + kRimM && (here == nullptr || rock.height_m > here->height_m))
      here = &rock;
  const double top = here != nullptr ? here->height_m : 0.0;
  for (const Rock& rock : in_body) {
    if (&rock == here) continue;
    const double rx = rock.p.x_m - camera_.position.x_m;
    const double ry = rock.p.y_m - camera_.position.y_m;
    const double along = (rx * dx + ry * dy) / range;
    const double aside = std::abs(rx * dy - ry * dx) / range;
    if (along <= 0.0 || along + 0.5 * rock.radius_m >= range || aside >= 0.8 * rock.radius_m) continue;
    if (camera_.height_m - (camera_.height_m - top) * along / range < rock.height_m)
      return TraversabilityGrid::kUnknown;
  }
  if (here == nullptr) return 0;
  const bool known = range < camera_.far_of_least_m + kRangeGain * (top - kHazardHeightM);
  return top >= kHazardHeightM && known ? TraversabilityGrid::kImpassable : kLowRock;
}

void NavView::look(const std::vector<Rock>& rocks, const Pose2& truth, const Pose2& odom, double azimuth_rad) {
  map_.move_to(odom.x_m, odom.y_m);
  std::vector<Rock> in_body;
  for (const Rock& rock : rocks) {
    if (distance(rock.p, position(truth)) > camera_.far_m + 1.0) continue;
    in_body.push_back(rock);
    in_body.back().p = to_body(truth, rock.p);
  }
  map_.for_each([&](CellIndex i, std::uint8_t& cell) {
    const Point2 b = to_body(odom, {map_.center_x_m(i), map_.center_y_m(i)});
    const std::uint8_t value = seen(in_body, b, azimuth_rad);
    if (value != TraversabilityGrid::kUnknown) cell = value;
  });
}

TraversabilityGrid NavView::grid(Utime utime) const {
  TraversabilityGrid out{utime,
                         map_.cell_m(),
                         map_.origin().ix * map_.cell_m(),
                         map_.origin().iy * map_.cell_m(),
                         map_.cells(),
                         map_.cells(),
                         {}};
  map_.for_each([&](CellIndex, std::uint8_t cell) { out.cells.push_back(cell); });
  return out;
}

}  // namespace rover::planning::testing_support
