#include "test/path_planner/repair_field.hpp"

namespace rover::planning::testing_support {
namespace {

constexpr double kFreeAroundStartM = 1.3;  // the rectangle's radius, the margin and 0.14 m

Route random_route(std::mt19937_64& random) {
  const bool ends_near = random() % 6 == 0;
  const double bend = uniform(random, -0.5, 0.5);
  const Point2 end = ends_near ? Point2{uniform(random, 3.0, 4.2), uniform(random, -0.5, 0.5)}
                               : Point2{20.0, uniform(random, -6.0, 6.0)};
  return rounded({{{-6.0, bend}, kNaN, 0}, {{0.0, 0.0}, kNaN, 0}, {end, kNaN, 0}}, RoundingConfig{});
}

Pose2 beside(const Pose2& pose, std::mt19937_64& random) {
  const double aside = uniform(random, -0.2, 0.2);
  const double yaw = pose.yaw_rad + uniform(random, -0.25, 0.25);
  return {pose.x_m - aside * std::sin(pose.yaw_rad), pose.y_m + aside * std::cos(pose.yaw_rad), yaw};
}

// What the camera has seen on the last metres of the way, with every rock that is known.
void see_from_the_way(HazardMemory& memory, const std::vector<Rock>& rocks, const RepairField& field,
                      std::mt19937_64& random) {
  for (double back = 3.0; back >= 0.0; back -= 0.25) {
    Pose2 pose = field.route.pose_at(field.from_m - back);
    if (back == 0.0) pose = field.start;
    memory.mark_driven(pose, planner_config().footprint);
    for (int hit = 0; hit < 2; ++hit)
      memory.add(observe(CameraModel{}, rocks, pose, 0, random), from_planar(pose), 0.0);
  }
}

std::vector<Rock> random_rocks(const RepairField& field, std::mt19937_64& random) {
  std::vector<Rock> rocks = rock_field(uniform(random, 0.02, 0.09), {-5.0, -5.0}, {5.0, 5.0}, 0.3, random);
  const Pose2 ahead = field.route.pose_at(field.from_m + uniform(random, 1.9, 2.6));
  const double aside = uniform(random, -0.4, 0.4);
  rocks.push_back({{ahead.x_m, ahead.y_m + aside}, uniform(random, 0.15, 0.4), 0.3});
  std::erase_if(rocks, [&](const Rock& r) {
    return distance(r.p, position(field.start)) < kFreeAroundStartM + r.radius_m ||
           distance(r.p, position(field.stopped)) < kFreeAroundStartM + r.radius_m;
  });
  return rocks;
}

}  // namespace

HazardMemory ground(bool seen) {
  HazardMemoryConfig config;
  config.cells = 100;
  HazardMemory memory(config);
  memory.move_to({0.0, 0.0});
  if (seen) memory.mark_seen({0.0, 0.0}, 10.0);
  return memory;
}

void lay_rocks(HazardMemory& memory, const std::vector<Rock>& rocks) {
  const GridMap<GroundCell>& map = memory.map();
  memory.map().for_each([&](CellIndex i, GroundCell& cell) {
    const Point2 p{map.center_x_m(i), map.center_y_m(i)};
    const auto covers = [&](const Rock& r) { return r.height_m >= kHazardHeightM && distance(r.p, p) <= r.radius_m; };
    if (std::any_of(rocks.begin(), rocks.end(), covers)) cell = {true, 2, 0, 0, 0};
  });
}

Route straight_route(double length_ahead_m) {
  return rounded({{{-4.0, 0.0}, kNaN, 0}, {{length_ahead_m, 0.0}, kNaN, 0}}, RoundingConfig{});
}

RepairField random_field(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  RepairField field{ground(false), random_route(random), 0.0, {}, 0.0, {}, kInfinity};
  field.from_m = field.route.closest({-1.5, 0.0});  // most of the map lies ahead
  field.start = beside(field.route.pose_at(field.from_m), random);
  field.stopped = field.start;
  if (random() % 2 == 0) {
    field.start_curvature_per_m = uniform(random, -0.5, 0.5);
    field.stopped = advanced(field.start, 0.17, field.start_curvature_per_m);
  }
  const std::vector<Rock> rocks = random_rocks(field, random);
  if (random() % 4 == 0) {
    field.sure_m = uniform(random, 0.6, 2.5);
    see_from_the_way(field.memory, rocks, field, random);
  } else {
    field.memory = ground(true);
    lay_rocks(field.memory, rocks);
  }
  return field;
}

RepairResult plan_on(const RepairField& field, const Terrain& terrain, const LocalRepairConfig& config,
                     double goal_reach_m) {
  return LocalRepair(config).plan({terrain, field.route, field.from_m, field.start, field.start_curvature_per_m,
                                   field.stopped, kRepairMarginM, field.sure_m, goal_reach_m});
}

}  // namespace rover::planning::testing_support
