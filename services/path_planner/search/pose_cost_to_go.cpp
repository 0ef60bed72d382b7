#include "path_planner/search/pose_cost_to_go.hpp"

#include <limits>

namespace rover::planning {
namespace {

constexpr float kNone = std::numeric_limits<float>::infinity();
constexpr double kBucketS = 0.25;
constexpr double kMaxCostS = 1500.0;                      // above that of the start
constexpr std::array<int, 5> kTurns = {0, 1, -1, 2, -2};  // headings by which an arc turns
constexpr double kMinArcM = 0.35;
constexpr double kMaxArcM = 0.62;
constexpr double kArcSpanM = 0.1;  // of lengths to choose from, if the vehicle turns in wider arcs
constexpr double kArcStepM = 0.01;
constexpr double kBandM = 0.7;           // around the horizon, in which the lattice begins
constexpr double kNearRoverM = 0.10;     // hazards nearer to the rover than the margin and this do not block its place
constexpr int kCoarse = 2;               // cells of the lattice per cell of the march, in x and y
constexpr float kMarchBound = 0.9F;      // of fast marching: its circles are wider than round, its cells coarse
constexpr double kFreeHeadingRad = 0.3;  // at the horizon, between plan and descent
constexpr double kHeadingCostS = 4.0;    // per radian beyond

}  // namespace

PoseCostToGo::PoseCostToGo(const MotionCosts& costs, const RollCosts& roll_costs, const Clearances& clearances,
                           const Footprint& footprint, const PlanRequest& request, const CostToGo& cost_to_go,
                           double horizon_m, const LatticeExtent& extent, double max_cost)
    : costs_(costs),
      clearances_(clearances),
      footprint_(footprint),
      request_(request),
      cost_to_go_(cost_to_go),
      horizon_m_(horizon_m),
      extent_(extent),
      max_cost_(max_cost),
      from_start_to_goal_(kMarchBound * cost_to_go.at(position(request.start))),
      center_(position(request.start)),
      cell_m_(request.costmap->cell_m()),
      cells_(2 * static_cast<int>((horizon_m + kBandM) / request.costmap->cell_m()) + 3),
      roll_(roll_costs, *request.costmap, footprint, request.rover, RollCosts::kToleranceRad) {
  const Point2 middle = request.costmap->center_of(request.costmap->cell_of(center_));
  const double half_m = (0.5 * cells_) * cell_m_;
  corner_ = {middle.x_m - half_m, middle.y_m - half_m};
  make_arcs();
  classify();
  const size_t states = kMotions * static_cast<size_t>(cells_) * cells_ * kHeadings;
  cost_.assign(states, kNone);
  closed_.assign(states, false);
  buckets_.resize(static_cast<size_t>(kMaxCostS / kBucketS) + 1);
  seed();
  spread();
}

// For each heading and turn the arc that ends closest to the centre of a cell.
void PoseCostToGo::make_arcs() {
  arcs_to_.resize(kHeadings);
  arcs_from_.resize(kHeadings);
  const auto cells = [&](double v) { return static_cast<int>(std::lround(v / cell_m_)); };
  // Only the ends of an arc are checked to lie inside.
  const auto between = [&](double v, double end) {
    return std::clamp(cells(v), std::min(0, cells(end)), std::max(0, cells(end)));
  };
  for (int heading = 0; heading < kHeadings; ++heading)
    for (const int turn : kTurns) {
      double least = kInfinity;
      Arc best{};
      const double min_m = std::max(kMinArcM, std::abs(turn) * yaw_of(1) / costs_.max_curvature_per_m);
      const double max_m = std::max(kMaxArcM, min_m + kArcSpanM);
      for (double length = min_m; length <= max_m; length += kArcStepM) {
        const double curvature = turn * yaw_of(1) / length;
        const Pose2 start{0.0, 0.0, yaw_of(heading)};
        const Pose2 end = advanced(start, length, curvature);
        const Pose2 middle = advanced(start, 0.5 * length, curvature);
        const double miss = std::hypot(end.x_m - cells(end.x_m) * cell_m_, end.y_m - cells(end.y_m) * cell_m_);
        if (miss >= least) continue;
        least = miss;
        const double relative = curvature / costs_.max_curvature_per_m;
        best = {heading,
                wrapped(heading + turn),
                cells(end.x_m),
                cells(end.y_m),
                cells(end.y_m) * cells_ + cells(end.x_m),
                between(middle.y_m, end.y_m) * cells_ + between(middle.x_m, end.x_m),
                wrapped(heading + turn / 2),
                static_cast<float>(length),
                static_cast<float>(MotionCosts::kCurvature * costs_.seconds_per_m * relative * relative * length)};
      }
      arcs_to_[best.to_heading].push_back(best);
      arcs_from_[heading].push_back(best);
    }
}

void PoseCostToGo::classify() {
  const size_t count = static_cast<size_t>(cells_) * cells_;
  const int coarse_cells = (cells_ + kCoarse - 1) / kCoarse;
  const auto coarse = [&](size_t i) {
    const int cell = static_cast<int>(i);
    return static_cast<size_t>(cell / cells_ / kCoarse * coarse_cells + cell % cells_ / kCoarse);
  };
  MarchGrid grid{coarse_cells, coarse_cells, kCoarse * cell_m_, {}};
  grid.cost_per_m.assign(static_cast<size_t>(coarse_cells) * coarse_cells, kInfinity);
  ground_.assign(count, kNone);
  for (size_t i = 0; i < count; ++i) {
    const Point2 p = center_of(static_cast<int>(i));
    if (!request_.costmap->contains(p)) continue;
    const double cost = cost_to_go_.cost_per_m(request_.costmap->cell_of(p));
    ground_[i] = static_cast<float>(cost);
    grid.cost_per_m[coarse(i)] = std::min(grid.cost_per_m[coarse(i)], cost);
  }
  const std::vector<double> from_start = march(grid, {{static_cast<int>(coarse(count / 2)), 0.0}}, -1, 0.0);
  from_start_.resize(count);
  for (size_t i = 0; i < count; ++i) from_start_[i] = kMarchBound * static_cast<float>(from_start[coarse(i)]);
  classes_.assign(count * kClearanceHeadings, kComfort);
  if (request_.costmap->has_heights()) roll_factor_.assign(classes_.size(), 0.0F);
  rasterise(clearances_.comfort_m - extent_.slack_m, kTight);
  rasterise(clearances_.turn_m - extent_.slack_m, kNoTurn);
  rasterise(clearances_.min_m - extent_.slack_m, kBlocked);
}

// Every pose whose footprint, widened by the margin, covers the hazard; of a low one, whose wheels do.
void PoseCostToGo::rasterise(double margin_m, Clearance value) {
  const int reach = static_cast<int>((footprint_.radius_m() + 2.0 * margin_m) / cell_m_) + 1;
  for (const bool low : {false, true}) {
    std::vector<std::pair<int, int>> hazards;
    for (const Hazard& hazard : request_.costmap->hazards()) {
      const int ix = static_cast<int>(std::floor((hazard.p.x_m - corner_.x_m) / cell_m_));
      const int iy = static_cast<int>(std::floor((hazard.p.y_m - corner_.y_m) / cell_m_));
      if (hazard.low != low || std::min(ix, iy) < -reach || std::max(ix, iy) >= cells_ + reach) continue;
      if (footprint_.hazard_distance_m(request_.rover, hazard.p, low) > margin_m + kNearRoverM)
        hazards.emplace_back(ix, iy);
    }
    for (int heading = 0; heading < kClearanceHeadings; ++heading)
      for (int dy = -reach; dy <= reach; ++dy)
        for (int dx = -reach; dx <= reach; ++dx) {
          const auto covers = [&] {
            const Pose2 pose{dx * cell_m_, dy * cell_m_, yaw_of(heading)};
            return footprint_.hazard_distance_m(pose, {}, low) < margin_m;
          };
          const int from = dx;
          while (dx <= reach && covers()) ++dx;
          if (dx == from) continue;
          for (const auto& [hx, hy] : hazards) mark(heading, hy + dy, hx + from, hx + dx, value);
        }
  }
}

// Cells [from, to) of the row.
void PoseCostToGo::mark(int heading, int row, int from, int to, Clearance value) {
  if (row < 0 || row >= cells_) return;
  const auto begin =
      classes_.begin() + static_cast<std::ptrdiff_t>((static_cast<size_t>(heading) * cells_ + row) * cells_);
  const int first = std::max(from, 0);
  if (first < std::min(to, cells_)) std::fill(begin + first, begin + std::min(to, cells_), value);
}

PoseCostToGo::End PoseCostToGo::end_at(Point2 p) const {
  const double beyond = cost_to_go_.end_cost(p) - common_;
  if (std::isfinite(cost_to_go_.goal_cost(p))) return {beyond, kNaN};
  if (!at_horizon(p)) return {};
  return {beyond, cost_to_go_.descent_rad(p)};
}

double PoseCostToGo::End::cost(double yaw_rad) const {
  if (std::isnan(best_yaw_rad)) return any_heading;
  return any_heading + kHeadingCostS * std::max(0.0, std::abs(wrap_angle(best_yaw_rad - yaw_rad)) - kFreeHeadingRad);
}

void PoseCostToGo::seed() {
  std::vector<int> ends;
  double least = kInfinity;
  for (int cell = 0; cell < cells_ * cells_; ++cell) {
    if (ground_[cell] == kNone) continue;
    const Point2 p = center_of(cell);
    const bool ring = at_horizon(p) && distance(p, center_) <= horizon_m_ + kBandM;
    if (!ring && std::isinf(cost_to_go_.goal_cost(p))) continue;
    ends.push_back(cell);
    least = std::min(least, cost_to_go_.end_cost(p));
  }
  if (std::isinf(least)) return;
  common_ = least;
  from_start_to_goal_ -= least;
  for (const int cell : ends) {
    const End end = end_at(center_of(cell));
    if (std::isinf(end.any_heading)) continue;
    for (int heading = 0; heading < kHeadings; ++heading)
      if (clearance(cell, heading) != kBlocked) {
        offer(kForward, cell, heading, static_cast<float>(end.cost(yaw_of(heading))));
        if (!request_.back_to.empty()) offer(kReverse, cell, heading, static_cast<float>(end.cost(yaw_of(heading))));
      }
  }
}

void PoseCostToGo::offer(Motion motion, int cell, int heading, float cost) {
  const size_t state = state_of(motion, cell, heading);
  if (!(cost < cost_[state])) return;
  const float through = cost + from_start_[cell] - static_cast<float>(from_start_to_goal_);
  if (!(through < kMaxCostS)) return;
  cost_[state] = cost;
  closed_[state] = false;
  // The cost from the start is a bound over places, the cost-to-go one over poses: what is found now may have to be
  // expanded earlier.
  const auto bucket = static_cast<size_t>(std::max(0.0, through / kBucketS));
  buckets_[std::max(bucket_, bucket)].push_back(static_cast<std::uint32_t>(state));
}

void PoseCostToGo::spread() {
  double last = std::isinf(max_cost_) ? kInfinity : max_cost_ - common_ - from_start_to_goal_;
  bool reached = false;
  for (; bucket_ < buckets_.size() && kBucketS * static_cast<double>(bucket_) <= last; ++bucket_) {
    // A bucket may grow while it is expanded.
    for (size_t k = 0; k < buckets_[bucket_].size(); ++k) {
      const size_t state = buckets_[bucket_][k];
      if (closed_[state]) continue;
      closed_[state] = true;
      const int cell = static_cast<int>(state / kHeadings / kMotions);
      const int heading = static_cast<int>(state % kHeadings);
      switch (static_cast<Motion>(state / kHeadings % kMotions)) {
        case kForward:
          spread_forward(cell, heading, cost_[state]);
          break;
        case kTurn:
          spread_turn(cell, heading, cost_[state]);
          break;
        case kReverse:
          spread_reverse(cell, heading, cost_[state]);
          break;
      }
    }
    const double best = reached ? kInfinity : std::min(forward(request_.start), turning(request_.start));
    if (std::isinf(best)) continue;
    reached = true;
    last = std::min(last, best - from_start_to_goal_ + extent_.beyond_s);
  }
}

bool PoseCostToGo::inside(int cell, int dx, int dy) const {
  const int x = cell % cells_ + dx;
  const int y = cell / cells_ + dy;
  return x >= 0 && y >= 0 && x < cells_ && y < cells_;
}

float PoseCostToGo::cost_per_m(int cell, int heading) {
  const Clearance here = clearance(cell, heading);
  if (here == kBlocked) return kNone;
  const float tight = here == kComfort ? 1.0F : static_cast<float>(costs_.tight_factor);
  return tight * roll_factor(cell, heading) * ground_[cell];
}

float PoseCostToGo::roll_factor(int cell, int heading) {
  if (roll_factor_.empty()) return 1.0F;
  float& factor = roll_factor_[class_of(cell, heading)];
  if (factor == 0.0F) {
    const Point2 p = center_of(cell);
    factor = static_cast<float>(roll_.factor({p.x_m, p.y_m, yaw_of(heading)}));
  }
  return factor;
}

// Of the arc from the cell; both ends lie inside.
float PoseCostToGo::arc_cost(int cell, const Arc& arc) {
  const float here = cost_per_m(cell, arc.from_heading);
  const float between = cost_per_m(cell + arc.to_middle, arc.middle_heading);
  const float there = cost_per_m(cell + arc.to_end, arc.to_heading);
  return arc.length_m * 0.25F * (here + 2.0F * between + there) + arc.extra;
}

// To the poses from which an arc ends here, and to the end of a point turn or of a path in reverse.
void PoseCostToGo::spread_forward(int cell, int heading, float cost) {
  for (const Arc& arc : arcs_to_[heading]) {
    const int from = cell - arc.to_end;
    if (inside(cell, -arc.dx, -arc.dy) && cost < cost_[state_of(kForward, from, arc.from_heading)])
      offer(kForward, from, arc.from_heading, cost + arc_cost(from, arc));
  }
  offer(kTurn, cell, heading, cost);
  offer(kReverse, cell, heading, cost + static_cast<float>(costs_.cusp_s));
}

// In reverse the rover came over the arcs that begin here, over known ground.
void PoseCostToGo::spread_reverse(int cell, int heading, float cost) {
  for (const Arc& arc : arcs_from_[heading]) {
    const int from = cell + arc.to_end;
    if (!inside(cell, arc.dx, arc.dy) || !(cost < cost_[state_of(kReverse, from, arc.to_heading)])) continue;
    const float length_cost = arc_cost(cell, arc);
    if (length_cost != kNone && !request_.costmap->unknown(center_of(from)))
      offer(kReverse, from, arc.to_heading, cost + static_cast<float>(costs_.reverse_factor) * length_cost);
  }
  offer(kForward, cell, heading, cost + static_cast<float>(costs_.cusp_s));
}

// Backwards through a point turn: either it goes on, or it began here.
void PoseCostToGo::spread_turn(int cell, int heading, float cost) {
  for (const int turn : {1, -1}) {
    const int from = wrapped(heading + turn);
    const Clearance there = clearance(cell, from);
    if (there >= kNoTurn) continue;
    const double factor = (there == kTight ? costs_.tight_factor : 1.0) * roll_factor(cell, from);
    offer(kTurn, cell, from, cost + static_cast<float>(factor * costs_.point_turn_s_per_rad * yaw_of(1)));
  }
  offer(kForward, cell, heading, cost + static_cast<float>(costs_.point_turn_s));
  offer(kReverse, cell, heading, cost + static_cast<float>(costs_.point_turn_s));
}

double PoseCostToGo::nearby(const Pose2& pose, Motion motion) const {
  const int ix = static_cast<int>(std::floor((pose.x_m - corner_.x_m) / cell_m_ - 0.5));
  const int iy = static_cast<int>(std::floor((pose.y_m - corner_.y_m) / cell_m_ - 0.5));
  const int heading = static_cast<int>(std::floor(pose.yaw_rad / yaw_of(1)));
  if (ix < 0 || iy < 0 || ix + 1 >= cells_ || iy + 1 >= cells_) return kInfinity;
  float least = kNone;
  for (int h = 0; h < 2; ++h)
    for (int dy = 0; dy < 2; ++dy)
      for (int dx = 0; dx < 2; ++dx)
        least = std::min(least, cost_[state_of(motion, (iy + dy) * cells_ + ix + dx, wrapped(heading + h))]);
  return least;
}

}  // namespace rover::planning
