#include "path_planner/search/cost_to_go.hpp"

#include "common/core/distance_field.hpp"

namespace rover::planning {
namespace {

constexpr double kBorderM = 0.3;         // of the costmap, where nothing ends
constexpr double kBorderBandM = 0.3;     // of the cells that seed the march
constexpr double kGlobalStepM = 0.5;     // along the global path
constexpr double kReturnWithinM = 15.0;  // along the global path, on which the rover may return to it
constexpr double kAroundFactor = 2.0;    // from the border to a goal inside of it: the direct path is blocked
constexpr double kAtRoverM = 1.2;        // the rover may be closer to a hazard than it would drive
constexpr double kTightCost = 6.0;       // relative to driving, there
constexpr double kScrapeM = 0.05;

}  // namespace

CostToGo::CostToGo(const CostToGoConfig& config, const PlanRequest& request, const Footprint& footprint,
                   double margin_m)
    : config_(config),
      costmap_(*request.costmap),
      ground_cost_(costmap_.costs()),
      half_width_m_(footprint.half_width_m),
      margin_m_(margin_m),
      rover_(position(request.rover)),
      goals_(request.back_to),
      goal_tolerance_m_(request.goal_tolerance_m),
      goal_reach_m_(goal_tolerance_m_),
      coarse_cells_((costmap_.cells() + kCoarse - 1) / kCoarse) {
  if (goals_.empty()) {
    goals_ = {{request.global_path->points().back().p, 0.0}};
    goal_reach_m_ = std::max(goal_tolerance_m_, config.blocked_goal_radius_m);
  }
  std::erase_if(goals_, [&](const BackUpPlace& goal) { return costmap_.inside_m(goal.p) <= kBorderM; });
  std::vector<std::uint8_t> tall(static_cast<size_t>(costmap_.cells()) * costmap_.cells(), 0);
  for (const auto& [p, low] : costmap_.hazards())
    if (!low) tall[costmap_.cell_of(p)] = 1;
  tall_distance_m_ = distance_field(tall, costmap_.cells(), costmap_.cells(), costmap_.cell_m());
  room_at_rover_m_ = std::min(-margin_m_, room_m(costmap_.cell_of(rover_)));
  march_from_goal(request);
}

double CostToGo::cost_per_m(int cell) const {
  // Over a low hazard the rover may pass, with the right heading.
  const double room = room_m(cell);
  if (room < 0.0) {
    const bool at_rover = room > room_at_rover_m_ - kScrapeM && distance(costmap_.center_of(cell), rover_) < kAtRoverM;
    return at_rover ? config_.seconds_per_m * kTightCost : kInfinity;
  }
  const double lack = std::clamp(1.0 - room / CostToGoConfig::kClearanceDistanceM, 0.0, 1.0);
  return config_.seconds_per_m * (ground_cost_[cell] + config_.clearance_cost * lack * lack);
}

double CostToGo::goal_cost(Point2 p) const {
  double least = kInfinity;
  for (const BackUpPlace& goal : goals_) {
    const double miss = distance(p, goal.p);
    if (miss > goal_reach_m_) continue;
    const double too_far = std::max(0.0, miss - goal_tolerance_m_);
    least = std::min(least, goal.cost_s + config_.seconds_per_m * config_.goal_miss_cost * too_far);
  }
  return least;
}

// From a cell at the border: straight to where the global path is met again, and along it to the goal. `ahead`: points
// of the global path each kGlobalStepM from the rover on, with `left_m` to the goal from the first.
double CostToGo::beyond(const std::vector<Point2>& ahead, double left_m, Point2 p) const {
  constexpr auto kReturn = static_cast<size_t>(kReturnWithinM / kGlobalStepM);
  std::vector<double> away_m;
  for (size_t i = 0; i < std::min(ahead.size(), 3 * kReturn); ++i) away_m.push_back(distance(p, ahead[i]));
  const auto nearest = std::min_element(away_m.begin(), away_m.begin() + std::min(away_m.size(), 2 * kReturn));
  const size_t last = static_cast<size_t>(nearest - away_m.begin()) + kReturn;
  double least = kInfinity;
  for (size_t i = 0; i < away_m.size() && i <= last; ++i)
    least = std::min(least, config_.off_path_factor * away_m[i] + left_m - static_cast<double>(i) * kGlobalStepM);
  return config_.seconds_per_m * least;
}

void CostToGo::march_from_goal(const PlanRequest& request) {
  const int n = costmap_.cells();
  const auto count = static_cast<size_t>(coarse_cells_) * coarse_cells_;
  MarchGrid grid{coarse_cells_, coarse_cells_, kCoarse * costmap_.cell_m(), std::vector<double>(count, kInfinity)};
  std::vector<double> seed(count, kInfinity);
  const Route& path = *request.global_path;
  std::vector<Point2> ahead;
  for (double s = request.global_progress_m; s <= path.length_m(); s += kGlobalStepM) ahead.push_back(path.point_at(s));
  const double left_m = path.length_m() - request.global_progress_m;
  for (int cell = 0; cell < n * n; ++cell) {
    const double cost = cost_per_m(cell);
    if (std::isinf(cost)) continue;
    const int coarse = coarse_cell(cell);
    grid.cost_per_m[coarse] = std::min(grid.cost_per_m[coarse], cost);
    const Point2 p = costmap_.center_of(cell);
    seed[coarse] = std::min(seed[coarse], goal_cost(p));
    const double inside = costmap_.inside_m(p);
    if (inside < kBorderM || inside > kBorderM + kBorderBandM || std::isfinite(seed[coarse])) continue;
    if (!request.back_to.empty()) continue;
    // If all paths through the costmap are blocked, one may lead around it.
    seed[coarse] = goals_.empty() ? beyond(ahead, left_m, p)
                                  : config_.seconds_per_m * kAroundFactor * distance(p, goals_.front().p);
  }
  std::vector<Seed> seeds;
  for (size_t i = 0; i < count; ++i)
    if (std::isfinite(seed[i])) seeds.push_back({static_cast<int>(i), seed[i]});
  to_goal_ = seeds.empty() ? std::vector<double>(count, kInfinity) : march(grid, seeds, -1, 0.0);
}

double CostToGo::descent_rad(Point2 p) const {
  const double d = 1.5 * kCoarse * costmap_.cell_m();
  const double here = at(p);
  const auto rise = [&](double dx, double dy) {
    const double ahead = at({p.x_m + dx, p.y_m + dy});
    const double behind = at({p.x_m - dx, p.y_m - dy});
    return (std::isinf(ahead) ? here : ahead) - (std::isinf(behind) ? here : behind);
  };
  return std::atan2(-rise(0.0, d), -rise(d, 0.0));
}

}  // namespace rover::planning
