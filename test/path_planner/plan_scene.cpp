#include "test/path_planner/plan_scene.hpp"

namespace rover::planning::testing_support {
namespace {

constexpr double kFreeAroundStartM = 1.3;  // radius of the footprint and 0.3 m
constexpr float kCertain = 4.0F;           // log-odds

}  // namespace

BeliefMap certain_belief(const GroundAt& ground) {
  BeliefMap belief{BeliefConfig{}};
  belief.move_to({0.0, 0.0});
  GridMap<CellBelief>& map = belief.cells();
  map.for_each([&](CellIndex i, CellBelief& cell) {
    const Ground kind = ground({map.center_x_m(i), map.center_y_m(i)});
    if (kind == Ground::kUnknown) return;
    cell.known = true;
    cell.evidence = kind == Ground::kHazard ? kCertain : -kCertain;
  });
  return belief;
}

void set_heights(BeliefMap& belief, const std::function<double(Point2)>& height_m) {
  GridMap<CellBelief>& map = belief.cells();
  map.for_each([&](CellIndex i, CellBelief& cell) {
    cell.height_m = static_cast<float>(height_m({map.center_x_m(i), map.center_y_m(i)}));
  });
}

double side_slope(double deg, Point2 p) {
  return std::tan(to_rad(deg)) * p.y_m;
}

GroundAt ground_of(std::vector<Rock> rocks) {
  return [rocks = std::move(rocks)](Point2 p) {
    const auto covers = [&](const Rock& r) { return r.height_m >= kHazardHeightM && distance(r.p, p) <= r.radius_m; };
    return std::any_of(rocks.begin(), rocks.end(), covers) ? Ground::kHazard : Ground::kFree;
  };
}

std::vector<Rock> random_rocks(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const double k = uniform(random, 0.03, 0.1);
  std::vector<Rock> rocks = rock_field(k, {-12.0, -12.0}, {12.0, 12.0}, 0.3, random);
  std::erase_if(rocks, [](const Rock& r) { return distance(r.p, {}) < kFreeAroundStartM + r.radius_m; });
  return rocks;
}

PlanRequest plan_request(const BeliefMap& belief, const Pose2& start, const std::vector<Point2>& global_path) {
  std::vector<RoutePoint> points;
  for (const Point2& p : global_path) points.push_back({p, kNaN, 0});
  const double side_m = belief.cells().cells() * belief.cells().cell_m();
  PlanRequest request;
  request.costmap = std::make_shared<const Costmap>(CostmapConfig{}, belief, position(start), side_m);
  request.global_path = std::make_shared<const Route>(rounded(points, RoundingConfig{}));
  request.global_progress_m = request.global_path->closest(position(start));
  request.rover = request.start = start;
  request.goal_tolerance_m = 0.3;
  return request;
}

HybridPlannerConfig search_config() {
  HybridPlannerConfig config = planner_config().planner;
  config.footprint = planner_config().footprint;
  return config;
}

}  // namespace rover::planning::testing_support
