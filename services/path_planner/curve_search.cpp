#include "path_planner/curve_search.hpp"

#include <array>
#include <functional>
#include <utility>

namespace rover::planning {
namespace {

constexpr double kPieceSampleM = 0.05;
constexpr int kYawBins = 32;
constexpr double kPlaceBinM = 0.2;
constexpr int kBends = 5;
constexpr double kMostBend = 1.1;  // of the largest curvature, in one piece
constexpr double kSpinSampleRad = 0.0524;
constexpr double kSpinViewRad = 0.4;
constexpr double kSurely = 0.85;  // of what the lattice says is left: its arcs and rooms are not quite those of a plan
constexpr std::array<double, 5> kLevels = {0.0, 0.5, -0.5, 1.0, -1.0};  // of the largest curvature
constexpr std::array<double, 9> kSpinsDeg = {45.0, 60.0, 75.0, 90.0, 105.0, 120.0, 140.0, 160.0, 180.0};

struct CurveNode {
  Pose2 pose;
  double curvature_per_m = 0.0;
  double cost = 0.0;
  double way_m = 0.0;
  int parent = -1;
  bool turned = false;        // by a point turn from the parent
  bool to_be_turned = false;  // stands for the point turns from here, until they are worth looking at
  bool backwards = false;
  bool reversed = false;  // the rover stands where its parent is, to drive on in the other direction
};

// Along a piece whose curvature changes evenly.
class Piece {
 public:
  Piece(const Pose2& from, double from_per_m, double to_per_m, double length_m, bool backwards)
      : pose_(from),
        from_(from_per_m),
        slope_((to_per_m - from_per_m) / length_m),
        sense_(backwards ? -1.0 : 1.0),
        samples_(std::max(1, static_cast<int>(std::ceil(length_m / kPieceSampleM - 1e-6)))),
        step_(length_m / samples_) {}
  int samples() const { return samples_; }
  double step_m() const { return step_; }
  const Pose2& next() {
    pose_ = advanced(pose_, sense_ * step_, from_ + slope_ * step_ * (done_++ + 0.5));
    return pose_;
  }

 private:
  Pose2 pose_;
  double from_;
  double slope_;
  double sense_;
  int samples_;
  double step_;
  int done_ = 0;
};

class CurveSearch {
 public:
  CurveSearch(const CurveSearchConfig& config, const CurveProblem& problem)
      : config_(config), problem_(problem), terrain_(problem.squeeze.terrain()), seen_(problem.squeeze, problem.view) {
    corner_ = terrain_.center_of(0);
    places_ = static_cast<int>(std::ceil(terrain_.cells() * terrain_.cell_m() / kPlaceBinM)) + 1;
    const auto places = static_cast<size_t>(places_);
    best_cost_.assign(places * places * kYawBins * kBends * 2, kMost);
  }

  CurvePlan run() {
    plan_.cost = problem_.most_cost;
    offer({problem_.start, problem_.start_curvature_per_m, 0.0, 0.0, -1});
    put({problem_.stopped, 0.0, halt_cost(problem_.start_curvature_per_m), 0.0, -1, false, true});
    if (problem_.may_back) offer_reversal({problem_.stopped, problem_.start_curvature_per_m, 0.0, 0.0, -1}, -1);
    while (!open_.empty() && plan_.expansions < config_.max_expansions) {
      const auto [estimate, index] = pop();
      if (estimate >= plan_.cost) break;
      if (nodes_[index].to_be_turned) {
        offer_turns(index, 1.0);
        offer_turns(index, -1.0);
        continue;
      }
      if (static_cast<float>(nodes_[index].cost) > best_cost_[key(nodes_[index])]) continue;
      ++plan_.expansions;
      expand(index);
    }
    if (end_ >= 0) lay_poses();
    return std::move(plan_);
  }

 private:
  using Entry = std::pair<double, int>;
  static constexpr float kMost = 1e30F;

  size_t key(const CurveNode& node) const {
    const auto place = [&](double v, double corner) {
      return std::clamp(static_cast<int>((v - corner) / kPlaceBinM), 0, places_ - 1);
    };
    const int heading = heading_bin(node.pose.yaw_rad, kYawBins);
    const double share = node.curvature_per_m / config_.max_curvature_per_m;
    const int bend = std::clamp(static_cast<int>(std::lround(2.0 * share)) + kBends / 2, 0, kBends - 1);
    const int at = place(node.pose.y_m, corner_.y_m) * places_ + place(node.pose.x_m, corner_.x_m);
    const size_t pose = static_cast<size_t>(at) * kYawBins + static_cast<size_t>(heading);
    return (pose * kBends + static_cast<size_t>(bend)) * 2 + (node.backwards ? 1 : 0);
  }

  double halt_cost(double curvature_per_m) const {
    return config_.turn_cost_m + config_.turn_bend_cost_m * std::abs(curvature_per_m) / config_.max_curvature_per_m;
  }

  void offer(const CurveNode& node) {
    float& best = best_cost_[key(node)];
    if (static_cast<float>(node.cost) >= best) return;
    best = static_cast<float>(node.cost);
    put(node);
  }

  double left_to_go(const CurveNode& node) const {
    if (node.to_be_turned) return problem_.headings.to_go_turning(node.pose);
    return node.backwards ? problem_.headings.to_go_backing(node.pose) : problem_.headings.to_go(node.pose);
  }

  void put(const CurveNode& node) {
    const double to_go = left_to_go(node);
    if (std::isinf(to_go) || node.cost + to_go * kSurely >= plan_.cost) return;
    nodes_.push_back(node);
    open_.emplace_back(node.cost + config_.greed * to_go, static_cast<int>(nodes_.size()) - 1);
    std::push_heap(open_.begin(), open_.end(), std::greater<>());
  }

  Entry pop() {
    std::pop_heap(open_.begin(), open_.end(), std::greater<>());
    const Entry entry = open_.back();
    open_.pop_back();
    return entry;
  }

  // The wheels stay as they are: the rover goes back on the circle on which it came.
  void offer_reversal(const CurveNode& from, int parent) {
    CurveNode next = from;
    next.parent = parent;
    next.reversed = true;
    next.backwards = !from.backwards;
    next.cost += config_.reversal_cost_m;
    offer(next);
  }

  // Point turns to one side, as far as the rectangle turns freely over seen ground.
  void offer_turns(int index, double side) {
    const CurveNode from = nodes_[index];
    note_way_to(index);
    double turned = 0.0;
    double cost = 0.0;
    for (const double turn_deg : kSpinsDeg) {
      const double turn = to_rad(turn_deg);
      CurveNode next = from;
      while (turned < turn + kSpinSampleRad) {
        next.pose.yaw_rad = from.pose.yaw_rad + side * std::min(turned, turn);
        if (!problem_.turn.clear(next.pose)) return;
        if (from.way_m < problem_.sure_m && !seen_.covers(next.pose)) return;
        const double factor = problem_.roomy.clear(next.pose) ? 1.0 : config_.tight_turn_factor;
        cost += factor * config_.turn_cost_per_rad_m * kSpinSampleRad;
        turned += kSpinSampleRad;
      }
      next.cost += cost;
      next.parent = index;
      next.turned = true;
      next.to_be_turned = false;
      next.backwards = false;
      offer(next);
    }
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
    const int steps = static_cast<int>(std::abs(to.yaw_rad - from.yaw_rad) / kSpinViewRad);
    for (int i = 1; i <= steps; ++i)
      seen_.passed({to.x_m, to.y_m, from.yaw_rad + (to.yaw_rad - from.yaw_rad) * i / (steps + 1)});
  }

  void expand(int index) {
    const CurveNode from = nodes_[index];
    if (from.way_m < problem_.sure_m) note_way_to(index);
    for (const double level : kLevels) {
      const double curvature = level * config_.max_curvature_per_m;
      const double change = std::abs(curvature - from.curvature_per_m) / config_.max_curvature_per_m;
      if (change > kMostBend) continue;
      CurveNode next = from;
      next.parent = index;
      next.turned = next.reversed = false;
      next.curvature_per_m = curvature;
      next.cost += config_.bend_cost_m * change * change + config_.curvature_cost * level * level * config_.step_m;
      if (!drive(from, curvature, next)) continue;
      end_or_offer(next);
    }
    if (from.turned || from.reversed || from.parent < 0) return;
    if (problem_.may_back) offer_reversal(from, index);
    CurveNode halt = from;
    halt.parent = index;
    halt.curvature_per_m = 0.0;
    halt.cost += halt_cost(from.curvature_per_m);
    halt.turned = halt.reversed = false;
    halt.to_be_turned = true;
    put(halt);
  }

  // Moves the node along one piece; false where that is not free or not worth it.
  bool drive(const CurveNode& from, double curvature_per_m, CurveNode& next) {
    Piece piece = piece_of(from, curvature_per_m);
    const double factor = from.backwards ? config_.back_factor : 1.0;
    for (int i = 0; i < piece.samples(); ++i) {
      next.pose = piece.next();
      next.cost += factor * piece.step_m() * pose_cost_per_m(problem_, config_, next.pose);
      if (next.cost >= plan_.cost) return false;
      if (!from.backwards) next.way_m += piece.step_m();
      if (seen_in_time(next)) continue;
      plan_.unseen_in_the_way = true;
      return false;
    }
    return true;
  }

  Piece piece_of(const CurveNode& from, double curvature_per_m) const {
    return {from.pose, from.curvature_per_m, curvature_per_m, config_.step_m, from.backwards};
  }

  // Nothing looks where the stern goes: ground there has been seen before.
  bool seen_in_time(const CurveNode& node) const {
    if (node.backwards) return problem_.squeeze.all_unseen(node.pose, [](Point2) { return false; });
    return node.way_m > problem_.sure_m || seen_.covers(node.pose);
  }

  void end_or_offer(const CurveNode& node) {
    const double end_cost = node.backwards ? kInfinity : problem_.field.end_cost(node.pose);
    if (std::isinf(end_cost)) return offer(node);
    if (node.cost + end_cost >= plan_.cost) return;
    plan_.found = true;
    plan_.cost = node.cost + end_cost;
    nodes_.push_back(node);
    end_ = static_cast<int>(nodes_.size()) - 1;
  }

  void lay_poses() {
    std::vector<int> chain;
    for (int i = end_; i >= 0; i = nodes_[i].parent) chain.insert(chain.begin(), i);
    plan_.poses.push_back(nodes_[chain.front()].pose);
    plan_.backs_first = nodes_[chain.front()].backwards;
    for (size_t k = 1; k < chain.size(); ++k) {
      const CurveNode& from = nodes_[chain[k - 1]];
      const CurveNode& to = nodes_[chain[k]];
      if (to.to_be_turned) continue;
      if (to.turned) {
        if (from.backwards) plan_.reversals.push_back(plan_.poses.size() - 1);
        plan_.poses.push_back(to.pose);
      } else if (to.reversed) {
        plan_.reversals.push_back(plan_.poses.size() - 1);
      } else {
        Piece piece = piece_of(from, to.curvature_per_m);
        for (int i = 0; i < piece.samples(); ++i) plan_.poses.push_back(piece.next());
      }
      plan_.halts += to.turned || to.reversed ? 1 : 0;
    }
  }

  const CurveSearchConfig& config_;
  const CurveProblem& problem_;
  const Terrain& terrain_;
  SeenOnTheWay seen_;
  Point2 corner_;
  int places_;
  std::vector<float> best_cost_;
  std::vector<CurveNode> nodes_;
  std::vector<Entry> open_;
  CurvePlan plan_;
  int end_ = -1;
};

}  // namespace

double pose_cost_per_m(const CurveProblem& problem, const DrivingPrices& prices, const Pose2& pose) {
  const double ground = problem.field.cost_per_m(position(pose));
  if (std::isinf(ground)) return kInfinity;
  if (problem.roomy.clear(pose)) return ground;
  if (problem.tight.clear(pose)) return prices.tight_factor * ground;
  return problem.squeeze.clear(pose) ? prices.squeeze_factor * ground : kInfinity;
}

std::deque<CurveLeg> legs_of(const CurvePlan& plan) {
  std::deque<CurveLeg> legs;
  size_t begin = 0;
  const auto add = [&](size_t end) {
    const auto at = [&](size_t i) { return plan.poses.begin() + static_cast<std::ptrdiff_t>(i); };
    legs.push_back({{at(begin), at(end + 1)}, plan.backs_first != (legs.size() % 2 == 1)});
    begin = end;
  };
  for (const size_t i : plan.reversals) add(i);
  add(plan.poses.size() - 1);
  return legs;
}

CurvePlan search_curves(const CurveSearchConfig& config, const CurveProblem& problem) {
  return CurveSearch(config, problem).run();
}

}  // namespace rover::planning
