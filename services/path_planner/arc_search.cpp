#include "path_planner/arc_search.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <utility>

namespace rover::planning {
namespace {

constexpr double kSampleM = 0.05;  // as the verification, so that both judge the same poses
constexpr int kHeadings = 32;
constexpr double kPlaceM = 0.15;  // two poses in one such square with one heading are the same
constexpr double kTurnSampleRad = 0.0524;
constexpr double kTurnViewRad = 0.4;
constexpr std::array<double, 9> kCurvatures = {0.0, 0.25, -0.25, 0.5, -0.5, 0.75, -0.75, 1.0, -1.0};  // of the largest
constexpr std::array<double, 5> kJoinAheadM = {0.8, 1.5, 2.4, 3.5, 4.8};
constexpr std::array<double, 2> kJoinRadii = {1.6, 1.0};  // of the least radius
constexpr std::array<double, 7> kTurnsDeg = {45.0, 60.0, 75.0, 95.0, 120.0, 150.0, 180.0};

struct ArcNode {
  Pose2 pose;
  double curvature_per_m = 0.0;
  double cost = 0.0;
  double way_m = 0.0;
  int parent = -1;
  bool turned = false;        // by a point turn from the parent
  bool to_be_turned = false;  // stands for the point turns from here, until they are worth looking at
};

class ArcSearch {
 public:
  ArcSearch(const ArcSearchConfig& config, const SearchProblem& problem)
      : config_(config), problem_(problem), terrain_(problem.check.terrain()), seen_(problem.check, problem.view) {
    corner_ = terrain_.center_of(0);
    places_ = static_cast<int>(std::ceil(terrain_.cells() * terrain_.cell_m() / kPlaceM)) + 1;
    best_cost_.assign(static_cast<size_t>(places_) * places_ * kHeadings, kInfinity);
  }

  SearchResult run() {
    offer({problem_.start, problem_.start_curvature_per_m, 0.0, 0.0, -1});
    const double turn_cost_m = config_.turn_cost_m + turn_bend_cost(problem_.start_curvature_per_m);
    put({problem_.stopped, 0.0, turn_cost_m, 0.0, -1, false, true});
    int left = config_.max_expansions;
    while (!open_.empty() && left-- > 0) {
      const auto [estimate, index] = pop();
      if (estimate >= result_.cost) break;
      if (nodes_[index].to_be_turned) {
        offer_turns(index, 1.0);
        offer_turns(index, -1.0);
        continue;
      }
      if (nodes_[index].cost > best_cost_[key(nodes_[index].pose)]) continue;
      ++result_.expansions;
      const bool had = result_.found;
      finish_from(index);
      expand(index);
      if (result_.found && !had) left = std::min(left, config_.further_expansions);
    }
    return result_;
  }

 private:
  using Entry = std::pair<double, int>;

  size_t key(const Pose2& pose) const {
    const auto place = [&](double v, double corner) {
      return std::clamp(static_cast<int>((v - corner) / kPlaceM), 0, places_ - 1);
    };
    const int heading = heading_bin(pose.yaw_rad, kHeadings);
    return (static_cast<size_t>(place(pose.y_m, corner_.y_m)) * places_ + place(pose.x_m, corner_.x_m)) * kHeadings +
           heading;
  }

  double travel_from(const Pose2& pose) const {
    return terrain_.contains(position(pose)) ? problem_.travel[terrain_.cell_of(position(pose))] : kInfinity;
  }

  double ground_cost(const Pose2& pose) const {
    return terrain_.contains(position(pose)) ? problem_.cost.cost_per_m[terrain_.cell_of(position(pose))] : kInfinity;
  }

  void offer(const ArcNode& node) {
    if (!(node.cost + travel_from(node.pose) < result_.cost)) return;
    double& best = best_cost_[key(node.pose)];
    if (node.cost >= best) return;
    best = node.cost;
    put(node);
  }

  void put(const ArcNode& node) {
    nodes_.push_back(node);
    open_.emplace_back(node.cost + config_.greed * travel_from(node.pose), static_cast<int>(nodes_.size()) - 1);
    std::push_heap(open_.begin(), open_.end(), std::greater<>());
  }

  Entry pop() {
    std::pop_heap(open_.begin(), open_.end(), std::greater<>());
    const Entry entry = open_.back();
    open_.pop_back();
    return entry;
  }

  // Point turns to one side, as far as the rectangle turns freely over seen ground.
  void offer_turns(int index, double side) {
    const ArcNode from = nodes_[index];
    note_way_to(index);
    double turned = 0.0;
    for (const double turn_deg : kTurnsDeg) {
      const double turn = to_rad(turn_deg);
      ArcNode next = from;
      for (; turned < turn + kTurnSampleRad; turned += kTurnSampleRad) {
        next.pose.yaw_rad = from.pose.yaw_rad + side * std::min(turned, turn);
        if (!problem_.turn_check.clear(next.pose) || !seen_.covers(next.pose)) return;
      }
      next.cost += config_.turn_cost_per_rad_m * turn;
      next.parent = index;
      next.turned = true;
      next.to_be_turned = false;
      offer(next);
    }
  }

  double bend_cost(double from_per_m, double to_per_m) const {
    return config_.bend_cost_m * std::abs(to_per_m - from_per_m) / config_.max_curvature_per_m;
  }

  // The wheels stand across before and after a point turn; towards a tight arc they have twice as far to steer.
  double turn_bend_cost(double curvature_per_m) const {
    return config_.turn_bend_cost_m * std::abs(curvature_per_m) / config_.max_curvature_per_m;
  }

  // Cost of an arc from the pose, infinity where it is not free; passes are noted for what follows.
  double arc_cost(const Pose2& from, const ArcSegment& arc, double way_before_m) {
    const int samples = std::max(1, static_cast<int>(std::ceil(arc.length_m / kSampleM - 1e-6)));
    const double step = arc.length_m / samples;
    const double share = arc.curvature_per_m / config_.max_curvature_per_m;
    double cost = config_.curvature_cost * share * share * arc.length_m;
    for (int i = 1; i <= samples; ++i) {
      const Pose2 pose = advanced(from, step * i, arc.curvature_per_m);
      cost += step * ground_cost(pose);
      if (std::isinf(cost) || !problem_.check.clear(pose)) return kInfinity;
      if (seen_.covers(pose)) continue;
      if (way_before_m + step * i <= problem_.sure_m) {
        result_.unseen_in_the_way = true;
        return kInfinity;
      }
      cost += step * config_.unseen_way_cost;
    }
    return cost;
  }

  void note_way_to(int index) {
    seen_.clear();
    for (int i = index; i >= 0; i = nodes_[i].parent) {
      seen_.passed(nodes_[i].pose);
      if (nodes_[i].turned) note_turn(nodes_[nodes_[i].parent].pose, nodes_[i].pose);
    }
  }

  // The camera sweeps all that lies between the two headings.
  void note_turn(const Pose2& from, const Pose2& to) {
    const int steps = static_cast<int>(std::abs(to.yaw_rad - from.yaw_rad) / kTurnViewRad);
    for (int i = 1; i <= steps; ++i)
      seen_.passed({to.x_m, to.y_m, from.yaw_rad + (to.yaw_rad - from.yaw_rad) * i / (steps + 1)});
  }

  void expand(int index) {
    note_way_to(index);
    const ArcNode from = nodes_[index];
    for (const double share : kCurvatures) {
      const ArcSegment arc{share * config_.max_curvature_per_m, config_.step_m};
      ArcNode next = from;
      next.parent = index;
      next.turned = false;
      next.pose = advanced(from.pose, arc.length_m, arc.curvature_per_m);
      next.cost += bend_cost(from.curvature_per_m, arc.curvature_per_m);
      if (from.turned) next.cost += turn_bend_cost(arc.curvature_per_m);
      if (next.cost + arc.length_m + travel_from(next.pose) >= result_.cost) continue;
      next.cost += arc_cost(from.pose, arc, from.way_m);
      next.curvature_per_m = arc.curvature_per_m;
      next.way_m += arc.length_m;
      offer(next);
    }
    if (from.turned || from.parent < 0) return;
    ArcNode halt = from;
    halt.parent = index;
    halt.curvature_per_m = 0.0;
    halt.cost += config_.turn_cost_m + turn_bend_cost(from.curvature_per_m);
    halt.turned = false;
    halt.to_be_turned = true;
    put(halt);
  }

  void finish_from(int index) {
    const ArcNode& node = nodes_[index];
    if (problem_.goal && node.parent >= 0) end_at_goal(index, distance(position(node.pose), *problem_.goal));
    if (problem_.targets.empty()) return;
    const int near = nearest_target(position(node.pose));
    const double near_m = problem_.targets[near].way_m;
    int last = -1;
    for (const double ahead : kJoinAheadM) {
      int target = near;
      while (target + 1 < static_cast<int>(problem_.targets.size()) && problem_.targets[target].way_m < near_m + ahead)
        ++target;
      if (target == last) break;
      last = target;
      for (const double radius : kJoinRadii) join(index, target, radius / config_.max_curvature_per_m);
    }
  }

  void end_at_goal(int index, double miss_m) {
    const double cost = nodes_[index].cost + problem_.goal_miss_cost * miss_m;
    if (miss_m <= problem_.goal_reach_m && cost < result_.cost) accept(index, nullptr, -1, cost);
  }

  int nearest_target(Point2 p) const {
    int best = 0;
    for (int i = 1; i < static_cast<int>(problem_.targets.size()); ++i)
      if (distance(position(problem_.targets[i].pose), p) < distance(position(problem_.targets[best].pose), p))
        best = i;
    return best;
  }

  void join(int index, int target, double radius_m) {
    const ArcNode node = nodes_[index];
    const JoinTarget& join_at = problem_.targets[target];
    const double straight = distance(position(node.pose), position(join_at.pose));
    const std::optional<DubinsPath> path = dubins_path(node.pose, join_at.pose, radius_m);
    if (!path || path->length_m() > 1.25 * straight + 0.1) return;
    double cost = node.cost + join_at.travel_cost;
    if (cost + path->length_m() >= result_.cost) return;
    note_way_to(index);
    Pose2 pose = node.pose;
    double way = node.way_m;
    double curvature = node.curvature_per_m;
    bool turned = node.turned;
    for (const ArcSegment& arc : path->segments) {
      if (arc.length_m < 1e-6) continue;
      if (std::exchange(turned, false)) cost += turn_bend_cost(arc.curvature_per_m);
      cost += bend_cost(curvature, arc.curvature_per_m) + arc_cost(pose, arc, way);
      if (cost >= result_.cost) return;
      pose = advanced(pose, arc.length_m, arc.curvature_per_m);
      way += arc.length_m;
      curvature = arc.curvature_per_m;
      seen_.passed(pose);
    }
    accept(index, &*path, target, cost + bend_cost(curvature, 0.0));
  }

  void accept(int index, const DubinsPath* join, int target, double cost) {
    result_.found = true;
    result_.cost = cost;
    result_.target = target;
    result_.sections.assign(1, {});
    for (int i = index; i >= 0; i = nodes_[i].parent) {
      const ArcNode& node = nodes_[i];
      WaySection& section = result_.sections.front();
      section.start = node.pose;
      if (node.turned)
        result_.sections.insert(result_.sections.begin(), WaySection{});
      else if (node.parent >= 0 && !node.to_be_turned)
        section.segments.insert(section.segments.begin(), {node.curvature_per_m, config_.step_m});
    }
    // A section that has no arc is the halt before the first turn.
    result_.turns_first = result_.sections.front().segments.empty() && result_.sections.size() > 1;
    if (result_.turns_first) result_.sections.erase(result_.sections.begin());
    if (join == nullptr) return;
    for (const ArcSegment& arc : join->segments)
      if (arc.length_m >= 1e-6) result_.sections.back().segments.push_back(arc);
  }

  const ArcSearchConfig& config_;
  const SearchProblem& problem_;
  const Terrain& terrain_;
  SeenOnTheWay seen_;
  Point2 corner_;
  int places_;
  std::vector<double> best_cost_;
  std::vector<ArcNode> nodes_;
  std::vector<Entry> open_;
  SearchResult result_;
};

}  // namespace

bool SeenOnTheWay::covers(const Pose2& pose) const {
  return check_.all_unseen(pose, [&](Point2 p) {
    return std::any_of(views_.begin(), views_.end(), [&](const View& v) {
      const double dx = p.x_m - v.from.x_m;
      const double dy = p.y_m - v.from.y_m;
      return view_.sees({v.cos_yaw * dx + v.sin_yaw * dy, v.cos_yaw * dy - v.sin_yaw * dx});
    });
  });
}

SearchResult search_arcs(const ArcSearchConfig& config, const SearchProblem& problem) {
  return ArcSearch(config, problem).run();
}

}  // namespace rover::planning
