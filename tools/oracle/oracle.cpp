#include "tools/oracle/oracle.hpp"

#include <algorithm>

#include "tools/oracle/shorten.hpp"

namespace rover::oracle {
namespace {

// Where no short path is in the corridor: the repair.max_deviation_m and full.goal.max_deviation_m of path_planner.
// Constants, so that the oracle is the same for all configurations.
constexpr double kRepairDeviationM = 4.0;
constexpr double kFullDeviationM = 20.0;

// Each where the one before takes too long.
struct Effort {
  double heuristic_weight;
  int max_expansions;
};
constexpr Effort kEfforts[] = {{1.01, 300'000}, {1.05, 500'000}, {1.3, 1'500'000}};

double length_m(const Points& line) {
  double sum = 0.0;
  for (size_t i = 1; i < line.size(); ++i) sum += (line[i] - line[i - 1]).norm();
  return sum;
}

Result search_region(const Request& request, const Region& region, const FootprintCheck& check, int max_expansions) {
  const Eigen::Vector2d goal = request.planned.back();
  const CostToGo cost_to_go(region, check, goal, request.goal_tolerance_m, request.start.yaw_rad);
  const SearchProblem problem{.region = region,
                              .check = check,
                              .cost_to_go = cost_to_go,
                              .max_curvature_per_m = 1.0 / request.vehicle.min_turn_radius_m,
                              .start = request.start,
                              .goal = goal,
                              .tolerance_m = request.goal_tolerance_m};
  Result result{.status = Status::kGaveUp};
  for (const Effort& effort : kEfforts) {
    const int left = max_expansions - result.expansions;
    if (left <= 0) break;
    const SearchResult found = search_poses(problem, effort.heuristic_weight, std::min(effort.max_expansions, left));
    result.expansions += found.expansions;
    if (!found.found && !found.exhausted) continue;
    result.status = found.found ? Status::kFound : Status::kNoPath;
    if (found.found) result.path = shortened(found.path, problem);
    if (found.found) result.length_m = length_m(result.path);
    break;
  }
  return result;
}

}  // namespace

std::string status_text(Status status) {
  switch (status) {
    case Status::kFound:
      return "found";
    case Status::kStartBlocked:
      return "start blocked";
    case Status::kNoPath:
      return "no path in the region";
    case Status::kGaveUp:
      return "search limit reached";
  }
  return "";
}

Result shortest_path(const Request& request) {
  Points line = request.planned;
  line.insert(line.begin(), {request.start.x_m, request.start.y_m});
  const auto region = [&](double half_width_m) {
    return region_around(line, half_width_m, request.map_width_m, request.map_length_m);
  };
  const double widest_m = std::max(kFullDeviationM, request.corridor_half_width_m);
  const Vehicle& vehicle = request.vehicle;
  const double half_wheelbase_m = *std::max_element(vehicle.wheel_x_m.begin(), vehicle.wheel_x_m.end());
  TrueGround ground(request.height_m, request.ground_m,
                    {vehicle.hazard_height_m, vehicle.max_climb_m, half_wheelbase_m, request.zones});
  const FootprintCheck check(vehicle, ground);
  if (region(widest_m).cell(request.start.x_m, request.start.y_m) < 0 || !check.is_free(request.start))
    return {Status::kStartBlocked};
  Result best;
  int regions_left = 3;
  for (const double half_width_m : {request.corridor_half_width_m, kRepairDeviationM, widest_m}) {
    const int left =
        (request.max_expansions - best.expansions) / regions_left--;  // a narrow one leaves the rest its share
    if (half_width_m < request.corridor_half_width_m) continue;
    Result result = search_region(request, region(half_width_m), check, left);
    result.expansions += best.expansions;
    if (best.status == Status::kFound && !(result.length_m < best.length_m)) break;
    best = std::move(result);
    if (best.length_m <= length_m(line)) break;
  }
  return best;
}

Points points_of(const Pieces& path, double step_m) {
  Points points;
  for (const Piece& piece : path) {
    const int n = std::max(1, static_cast<int>(std::ceil(piece.length_m() / step_m)));
    for (int i = 0; i < n; ++i) {
      const Pose2 pose = piece.pose_at(static_cast<double>(i) / n);
      points.emplace_back(pose.x_m, pose.y_m);
    }
  }
  if (!path.empty()) points.emplace_back(path.back().to().x_m, path.back().to().y_m);
  return points;
}

}  // namespace rover::oracle
