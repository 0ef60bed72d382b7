#include "test/path_planner/rock_world.hpp"

namespace rover::planning::testing_support {
namespace {

constexpr double kGridCellM = 0.1;
constexpr double kTypicalFreeCells = 600.0;  // of a frame
constexpr double kSeenRimM = 0.03;           // stereo widens a rock

// Rocks per square metre with at least the diameter: N(D) = integral of 4 k q exp(-q x) / (pi x^2) dx.
double count_above(double k, double diameter_m) {
  const double q = 1.79 + 0.152 / k;
  double sum = 0.0;
  constexpr double kStep = 0.002;
  for (double x = diameter_m; x < 3.0; x += kStep) {
    const double middle = x + 0.5 * kStep;
    sum += 4.0 * k * q * std::exp(-q * middle) / (kPi * middle * middle) * kStep;
  }
  return sum;
}

// Diameters and the share of rocks that are larger: the inverse of the cumulative count.
std::vector<std::pair<double, double>> diameter_table(double k, double min_diameter_m) {
  const double total = count_above(k, min_diameter_m);
  std::vector<std::pair<double, double>> table;
  for (double d = min_diameter_m; d < 2.0; d += 0.02) table.emplace_back(count_above(k, d) / total, d);
  return table;
}

bool visible(const CameraModel& camera, Point2 b) {
  if (b.x_m < camera.near_m || b.x_m > camera.far_m) return false;
  const double ahead = b.x_m - camera.position.x_m;
  const double depth = ahead * std::cos(camera.pitch_rad) + camera.height_m * std::sin(camera.pitch_rad);
  const double side = b.y_m - camera.position.y_m;
  return side <= camera.tangent * depth - camera.baseline_m && -side <= camera.tangent * depth;
}

bool hides(const CameraModel& camera, const Rock& rock_body, Point2 b) {
  const double dx = b.x_m - camera.position.x_m;
  const double dy = b.y_m - camera.position.y_m;
  const double length = std::hypot(dx, dy);
  const double rx = rock_body.p.x_m - camera.position.x_m;
  const double ry = rock_body.p.y_m - camera.position.y_m;
  const double along = (rx * dx + ry * dy) / length;
  const double aside = std::abs(rx * dy - ry * dx) / length;
  if (along <= 0.0 || along + 0.5 * rock_body.radius_m >= length || aside >= 0.8 * rock_body.radius_m) return false;
  return camera.height_m * (1.0 - along / length) < rock_body.height_m;
}

std::uint8_t seen_at(const CameraModel& camera, const std::vector<Rock>& rocks_body, Point2 b) {
  if (!visible(camera, b)) return HazardGrid::kUnseen;
  double height_m = 0.0;
  for (const Rock& r : rocks_body)
    if (distance(r.p, b) <= r.radius_m + kSeenRimM) height_m = std::max(height_m, r.height_m);
  if (height_m >= kHazardHeightM) return height_m < kBodyHeightM ? HazardGrid::kLow : HazardGrid::kObstacle;
  const auto hides_it = [&](const Rock& r) { return hides(camera, r, b); };
  if (std::any_of(rocks_body.begin(), rocks_body.end(), hides_it)) return HazardGrid::kUnseen;
  return HazardGrid::kFree;
}

}  // namespace

std::vector<Rock> rock_field(double k, Point2 low, Point2 high, double min_diameter_m, std::mt19937_64& random) {
  const double area = (high.x_m - low.x_m) * (high.y_m - low.y_m);
  const long count = std::lround(count_above(k, min_diameter_m) * area);
  const std::vector<std::pair<double, double>> table = diameter_table(k, min_diameter_m);
  std::vector<Rock> rocks;
  for (long i = 0; i < count; ++i) {
    const double share = uniform(random, 0.0, 1.0);
    double diameter = min_diameter_m;
    for (const auto& [above, d] : table)
      if (above >= share) diameter = d;
    const double x = uniform(random, low.x_m, high.x_m);
    const double y = uniform(random, low.y_m, high.y_m);
    rocks.push_back({{x, y}, 0.5 * diameter, 0.5 * diameter});
  }
  return rocks;
}

HazardGrid observe(const CameraModel& camera, const std::vector<Rock>& rocks, const Pose2& pose, Utime utime,
                   std::mt19937_64& random) {
  HazardGrid grid{utime, kGridCellM, 0.5, -2.0, 35, 40, {}};
  std::vector<Rock> in_body;
  for (const Rock& rock : rocks) {
    if (distance(rock.p, position(pose)) > camera.far_m + 1.0) continue;
    in_body.push_back(rock);
    in_body.back().p = to_body(pose, rock.p);
  }
  for (int iy = 0; iy < grid.cells_y; ++iy)
    for (int ix = 0; ix < grid.cells_x; ++ix) {
      const Point2 b{grid.origin_x_m + (ix + 0.5) * kGridCellM, grid.origin_y_m + (iy + 0.5) * kGridCellM};
      std::uint8_t cell = seen_at(camera, in_body, b);
      const double false_ratio = camera.false_hit_rate / kTypicalFreeCells;
      if (cell == HazardGrid::kFree && uniform(random, 0.0, 1.0) < false_ratio) cell = HazardGrid::kObstacle;
      grid.cells.push_back(cell);
    }
  return grid;
}

double clearance_m(const Footprint& footprint, const Pose2& pose, const std::vector<Rock>& rocks) {
  double least = kInfinity;
  for (const Rock& rock : rocks)
    if (rock.height_m >= kHazardHeightM && distance(rock.p, position(pose)) < 3.0) {
      const double d =
          rock.height_m < kBodyHeightM ? footprint.wheel_distance_m(pose, rock.p) : footprint.distance_m(pose, rock.p);
      least = std::min(least, d - rock.radius_m);
    }
  return least;
}

void complete(TraversabilityGrid& map) {
  for (const std::uint8_t cost : map.cells) {
    const double share = std::min<double>(cost, TraversabilityGrid::kLow) / TraversabilityGrid::kLow;
    map.step_percent.push_back(static_cast<std::uint8_t>(100.0 * std::cbrt(share)));
  }
  map.height_m.assign(map.cells.size(), 0.0F);
}

PathPlannerConfig planner_config() {
  PathPlannerConfig config;
  config.footprint = {
      0.875, 0.47, 0.35, {{{0.75, 0.41}, {0.75, -0.41}, {0.0, 0.41}, {0.0, -0.41}, {-0.75, 0.41}, {-0.75, -0.41}}}};
  config.goal_tolerance_m = 0.4;
  config.turn_threshold_rad = 0.7;
  config.turn_stop_rad = 0.035;
  return config;
}

}  // namespace rover::planning::testing_support
