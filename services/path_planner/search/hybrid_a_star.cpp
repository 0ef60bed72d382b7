#include "path_planner/search/hybrid_a_star.hpp"

#include <array>
#include <functional>
#include <unordered_map>
#include <utility>

namespace rover::planning {
namespace {

constexpr double kSampleM = 0.05;
constexpr int kYawBins = 32;
constexpr double kPlaceBinM = 0.2;
constexpr int kCurvatures = 5;
constexpr double kMaxChange = 1.1;  // of the curvature in one motion, relative to the largest
// Of the heuristic, for pruning: arcs and clearances of the lattice are not quite those of a plan.
constexpr double kLatticeBound = 0.85;
constexpr std::array<double, kCurvatures> kLevels = {0.0, 0.5, -0.5, 1.0, -1.0};  // of the largest curvature
constexpr std::array<double, 11> kTurnsDeg = {15.0, 30.0, 45.0, 60.0, 75.0, 90.0, 105.0, 120.0, 140.0, 160.0, 180.0};
constexpr double kMinTurnDeg = 45.0;  // unless the rover stopped in one

struct Node {
  enum class Kind : std::uint8_t {
    kMotion,       // reached by driving
    kTurned,       // reached by a point turn
    kTurnPending,  // stands for the point turns from here until they are worth expanding
    kCusp          // the rover is stationary, to go on in the other direction
  };
  Pose2 pose;
  double curvature_per_m = 0.0;
  double cost = 0.0;         // [s]
  double motion_cost = 0.0;  // of it, what does not depend on the ground
  double distance_m = 0.0;   // forward less reverse: a detour in reverse shows no new ground
  int parent = -1;
  Kind kind = Kind::kMotion;
  bool reverse = false;
};

// A motion with evenly changing curvature.
class Motion {
 public:
  Motion(const Node& from, double to_curvature_per_m, double length_m, const SideSlip& side_slip)
      : side_slip_(side_slip),
        pose_(from.pose),
        from_(from.curvature_per_m),
        slope_((to_curvature_per_m - from.curvature_per_m) / length_m),
        sign_(from.reverse ? -1.0 : 1.0),
        samples_(std::max(1, static_cast<int>(std::ceil(length_m / kSampleM - 1e-6)))),
        step_m_(length_m / samples_) {}
  int samples() const { return samples_; }
  double step_m() const { return step_m_; }
  const Pose2& next() {
    pose_ = side_slip_.advanced(pose_, sign_ * step_m_, from_ + slope_ * step_m_ * (done_++ + 0.5));
    return pose_;
  }

 private:
  SideSlip side_slip_;
  Pose2 pose_;
  double from_;
  double slope_;
  double sign_;
  int samples_;
  double step_m_;
  int done_ = 0;
};

class HybridAStar {
 public:
  HybridAStar(const HybridAStarConfig& config, const MotionCosts& costs, const PricedGround& ground,
              const PoseCostToGo& pose_cost_to_go, double max_cost)
      : config_(config),
        costs_(costs),
        ground_(ground),
        pose_cost_to_go_(pose_cost_to_go),
        pricer_(costs, ground),
        half_m_(0.5 * ground.request.costmap->cells() * ground.request.costmap->cell_m()),
        places_(static_cast<int>(2.0 * half_m_ / kPlaceBinM) + 1) {
    plan_.cost = max_cost;
  }

  Plan run() {
    Node start;
    start.pose = ground_.request.start;
    start.curvature_per_m = ground_.request.start_curvature_per_m;
    start.reverse = ground_.request.start_reverse;
    offer(start);
    while (!open_.empty() && plan_.expansions < config_.max_expansions) {
      const auto [estimate, index] = pop();
      if (estimate >= plan_.cost) break;
      if (nodes_[index].kind == Node::Kind::kTurnPending) {
        turn(index, 1.0);
        turn(index, -1.0);
        continue;
      }
      if (nodes_[index].cost > best_.at(key(nodes_[index]))) continue;
      ++plan_.expansions;
      expand(index);
    }
    if (end_ >= 0) set_poses();
    plan_.needs_unseen_ground = pricer_.needs_unseen_ground();
    return std::move(plan_);
  }

 private:
  using Entry = std::pair<double, int>;
  double relative(double curvature_per_m) const { return curvature_per_m / costs_.max_curvature_per_m; }

  size_t key(const Node& node) const {
    const Pose2& start = ground_.request.start;
    const auto place = [&](double v) {
      return static_cast<size_t>(std::clamp(static_cast<int>((v + half_m_) / kPlaceBinM), 0, places_ - 1));
    };
    const auto heading = static_cast<size_t>(heading_bin(node.pose.yaw_rad, kYawBins));
    const int curvature = static_cast<int>(std::lround(2.0 * relative(node.curvature_per_m))) + kCurvatures / 2;
    const size_t at = place(node.pose.y_m - start.y_m) * places_ + place(node.pose.x_m - start.x_m);
    const auto bin = static_cast<size_t>(std::clamp(curvature, 0, kCurvatures - 1));
    return ((at * kYawBins + heading) * kCurvatures + bin) * 2 + (node.reverse ? 1 : 0);
  }

  double heuristic(const Node& node) const {
    if (node.kind == Node::Kind::kTurnPending) return pose_cost_to_go_.turning(node.pose);
    return node.reverse ? pose_cost_to_go_.reverse(node.pose) : pose_cost_to_go_.forward(node.pose);
  }

  void offer(const Node& node) {
    const auto [best, first] = best_.try_emplace(key(node), node.cost);
    if (!first && node.cost >= best->second) return;
    best->second = node.cost;
    push(node);
  }

  void push(const Node& node) {
    const double remaining = heuristic(node);
    // The start may lie closer to hazards than the lattice allows; its successors need not.
    if (node.parent >= 0 && (std::isinf(remaining) || node.cost + kLatticeBound * remaining >= plan_.cost)) return;
    nodes_.push_back(node);
    open_.emplace_back(node.cost + (std::isinf(remaining) ? 0.0 : HybridAStarConfig::kHeuristicWeight * remaining),
                       static_cast<int>(nodes_.size()) - 1);
    std::push_heap(open_.begin(), open_.end(), std::greater<>());
  }

  Entry pop() {
    std::pop_heap(open_.begin(), open_.end(), std::greater<>());
    const Entry entry = open_.back();
    open_.pop_back();
    return entry;
  }

  static void add_motion_cost(Node& node, double cost) {
    node.cost += cost;
    node.motion_cost += cost;
  }

  void expand(int index) {
    const Node from = nodes_[index];
    if (from.distance_m < ground_.known_free_m) set_views(index);
    for (const double level : kLevels) drive(index, level);
    if (from.kind != Node::Kind::kMotion) return;
    // The wheels keep their angle: the rover goes back on the circle on which it came.
    Node cusp = from;
    cusp.parent = index;
    cusp.kind = Node::Kind::kCusp;
    cusp.reverse = !from.reverse;
    add_motion_cost(cusp, costs_.cusp_s);
    offer(cusp);
    Node pending = from;
    pending.parent = index;
    pending.kind = Node::Kind::kTurnPending;
    pending.curvature_per_m = 0.0;
    add_motion_cost(pending,
                    costs_.point_turn_s + MotionCosts::kPointTurnSteeringS * std::abs(relative(from.curvature_per_m)));
    push(pending);
  }

  void drive(int index, double level) {
    const Node& from = nodes_[index];
    Node next = from;
    next.parent = index;
    next.kind = Node::Kind::kMotion;
    next.curvature_per_m = level * costs_.max_curvature_per_m;
    const double change = std::abs(level - relative(from.curvature_per_m));
    if (change > kMaxChange) return;
    add_motion_cost(next, costs_.curvature_change_s * change * change + MotionCosts::kCurvature * costs_.seconds_per_m *
                                                                            level * level * HybridAStarConfig::kStepM);
    Motion motion(from, next.curvature_per_m, HybridAStarConfig::kStepM, ground_.request.side_slip);
    for (int i = 0; i < motion.samples(); ++i) {
      next.pose = motion.next();
      next.distance_m += from.reverse ? -motion.step_m() : motion.step_m();
      next.cost += motion.step_m() * pricer_.cost_per_m(next.pose, next.distance_m, from.reverse);
      if (next.cost >= plan_.cost) return;
    }
    end_or_offer(next);
  }

  // Point turns to one side, as far as the footprint turns freely over known ground.
  void turn(int index, double side) {
    const Node from = nodes_[index];
    const bool any_angle = ground_.request.turning && from.parent == 0;
    set_views(index);
    double turned = 0.0;
    double cost = 0.0;
    for (const double turn_deg : kTurnsDeg) {
      if (turn_deg < kMinTurnDeg && !any_angle) continue;
      Node next = from;
      for (; turned < to_rad(turn_deg) + kTurnSampleRad; turned += kTurnSampleRad) {
        next.pose.yaw_rad = from.pose.yaw_rad + side * std::min(turned, to_rad(turn_deg));
        const double factor = pricer_.turn_factor(next.pose, from.distance_m);
        if (std::isinf(factor)) return;
        cost += factor * costs_.point_turn_s_per_rad * kTurnSampleRad;
      }
      next.cost += cost;
      next.motion_cost += costs_.point_turn_s_per_rad * turned;
      next.parent = index;
      next.kind = Node::Kind::kTurned;
      for (const bool reverse : {false, true}) {
        next.reverse = reverse;
        offer(next);
      }
    }
  }

  // What the LocCam sees on the path to a node; from where the rover is now it has seen what there is to see.
  void set_views(int index) {
    pricer_.clear_views();
    for (int i = index; nodes_[i].parent >= 0; i = nodes_[i].parent) {
      if (nodes_[i].kind == Node::Kind::kTurned)
        pricer_.add_turn_views(nodes_[nodes_[i].parent].pose.yaw_rad, nodes_[i].pose);
      else
        pricer_.add_view(nodes_[i].pose);
    }
  }

  void end_or_offer(const Node& node) {
    const bool may_end = !node.reverse || !ground_.request.back_to.empty();
    const double end_cost = may_end ? pose_cost_to_go_.end_cost(node.pose) : kInfinity;
    if (node.cost + end_cost < plan_.cost) {
      plan_.found = true;
      plan_.cost = node.cost + end_cost;
      nodes_.push_back(node);
      end_ = static_cast<int>(nodes_.size()) - 1;
    }
    // At the horizon plans end; beside the goal one may go on for a smaller miss.
    if (node.reverse || !pose_cost_to_go_.at_horizon(position(node.pose))) offer(node);
  }

  void set_poses() {
    std::vector<int> chain;
    for (int i = end_; i >= 0; i = nodes_[i].parent) chain.insert(chain.begin(), i);
    const Node& start = nodes_[chain.front()];
    plan_.poses.push_back({start.pose, start.reverse, 0.0});
    for (size_t k = 1; k < chain.size(); ++k) {
      const Node& from = nodes_[chain[k - 1]];
      const Node& to = nodes_[chain[k]];
      if (to.kind == Node::Kind::kTurned) {
        plan_.poses.push_back({to.pose, false, to.motion_cost});
      } else if (to.kind == Node::Kind::kMotion) {
        Motion motion(from, to.curvature_per_m, HybridAStarConfig::kStepM, ground_.request.side_slip);
        for (int i = 0; i < motion.samples(); ++i) plan_.poses.push_back({motion.next(), to.reverse, to.motion_cost});
      }
    }
  }

  const HybridAStarConfig& config_;
  const MotionCosts& costs_;
  const PricedGround& ground_;
  const PoseCostToGo& pose_cost_to_go_;
  PathPricer pricer_;
  double half_m_;                            // of the side of the costmap
  int places_;                               // on it
  std::unordered_map<size_t, double> best_;  // cost by place, heading, curvature and direction
  std::vector<Node> nodes_;
  std::vector<Entry> open_;
  Plan plan_;
  int end_ = -1;
};

}  // namespace

double PathPricer::cost_per_m(const Pose2& pose, double distance_m, bool reverse) {
  double cost = ground_.cost_to_go.cost_per_m(position(pose));
  if (std::isinf(cost) || !ground_.min.clear(pose)) return kInfinity;
  if (!ground_.comfort.clear(pose)) cost *= costs_.tight_factor;
  if (reverse) cost *= costs_.reverse_factor;
  cost *= ground_.roll.factor(pose);
  // No camera looks backwards: ground behind has been seen before.
  if (reverse || !ground_.request.back_to.empty()) return ground_.min.known(pose) ? cost : kInfinity;
  if (distance_m > ground_.known_free_m || visibility_.covers(pose)) return cost;
  needs_unseen_ground_ = true;
  return kInfinity;
}

double PathPricer::turn_factor(const Pose2& pose, double distance_m) {
  if (!ground_.turn.clear(pose) || !ground_.roll.allows(pose)) return kInfinity;
  if (distance_m < ground_.known_free_m && !visibility_.covers(pose)) {
    needs_unseen_ground_ = true;
    return kInfinity;
  }
  return (ground_.comfort.clear(pose) ? 1.0 : costs_.tight_factor) * ground_.roll.factor(pose);
}

Plan search_hybrid_a_star(const HybridAStarConfig& config, const MotionCosts& costs, const PricedGround& ground,
                          const PoseCostToGo& pose_cost_to_go, double max_cost) {
  return HybridAStar(config, costs, ground, pose_cost_to_go, max_cost).run();
}

}  // namespace rover::planning
