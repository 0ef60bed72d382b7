#include "test/path_planner/nav_view.hpp"

namespace rover::planning::testing_support {
namespace {

constexpr double kRimM = 0.08;  // the map widens a rock
// Which rocks the map calls impassable from afar, as counted on drives of full_hard: the height that it takes grows
// with the range, and differs from rock to rock. The others cost as traversability's steps do.
constexpr double kNearM = 3.0;
constexpr double kLimitPerM = 0.003;
constexpr double kSpreadM = 0.012;  // deviation at kNearM
constexpr double kSpreadPerM = 0.003;

// A rock's own deviate, always the same.
double shape_of(const Rock& rock) {
  const auto millimetres = [](double v) { return static_cast<std::uint64_t>(std::llround(1e3 * v)); };
  std::mt19937_64 random(millimetres(rock.p.x_m) * 1'000'003 + millimetres(rock.p.y_m));
  return gauss(random);
}

std::uint8_t cost_of(const NavView::SeenRock& rock, double range_m) {
  const double further = std::max(0.0, range_m - kNearM);
  const double shown_m = rock.height_m + (kSpreadM + kSpreadPerM * further) * rock.shape;
  const double ratio = shown_m / (kHazardHeightM + kLimitPerM * further);
  if (ratio * kHazardHeightM >= kBodyHeightM) return TraversabilityGrid::kImpassable;
  if (ratio >= 1.0) return TraversabilityGrid::kLow;
  return static_cast<std::uint8_t>((TraversabilityGrid::kLow - 1) * std::pow(std::max(0.0, ratio), 3));
}

}  // namespace

std::uint8_t NavView::seen(const std::vector<SeenRock>& in_body, Point2 b, double azimuth_rad) const {
  const double dx = b.x_m - camera_.position.x_m;
  const double dy = b.y_m - camera_.position.y_m;
  const double range = std::hypot(dx, dy);
  if (range < camera_.near_m || range > camera_.far_m) return TraversabilityGrid::kUnknown;
  if (std::abs(wrap_angle(std::atan2(dy, dx) - azimuth_rad)) > camera_.half_view_rad)
    return TraversabilityGrid::kUnknown;
  const SeenRock* here = nullptr;
  for (const SeenRock& rock : in_body)
    if (distance(rock.p, b) <= rock.radius_m + kRimM && (here == nullptr || rock.height_m > here->height_m))
      here = &rock;
  const double top = here != nullptr ? here->height_m : 0.0;
  for (const SeenRock& rock : in_body) {
    if (&rock == here) continue;
    const double rx = rock.p.x_m - camera_.position.x_m;
    const double ry = rock.p.y_m - camera_.position.y_m;
    const double along = (rx * dx + ry * dy) / range;
    const double aside = std::abs(rx * dy - ry * dx) / range;
    if (along <= 0.0 || along + 0.5 * rock.radius_m >= range || aside >= 0.8 * rock.radius_m) continue;
    if (camera_.height_m - (camera_.height_m - top) * along / range < rock.height_m)
      return TraversabilityGrid::kUnknown;
  }
  return here == nullptr ? std::uint8_t{0} : cost_of(*here, range);
}

void NavView::look(const std::vector<Rock>& rocks, const Pose2& truth, const Pose2& odom, double azimuth_rad) {
  map_.move_to(odom.x_m, odom.y_m);
  std::vector<SeenRock> in_body;
  for (const Rock& rock : rocks) {
    if (distance(rock.p, position(truth)) > camera_.far_m + 1.0) continue;
    in_body.push_back({rock, shape_of(rock)});
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
  complete(out);
  return out;
}

}  // namespace rover::planning::testing_support
