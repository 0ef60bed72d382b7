#include "path_planner/heading_field.hpp"

#include <array>
#include <limits>

namespace rover::planning {
namespace {

constexpr float kNone = std::numeric_limits<float>::infinity();
constexpr double kBucketM = 0.05;
constexpr float kMostCost = 200.0F;
constexpr std::array<int, 5> kTurns = {0, 1, -1, 2, -2};  // headings by which an arc turns
constexpr double kShortestM = 0.35;
constexpr double kLongestM = 0.62;
constexpr double kLengthStepM = 0.01;
constexpr double kEndBandM = 0.7;  // past the goal line

// The rover may stand closer to a hazard than it would go: one as near to it as the margin and that much does not close
// its place.
constexpr double kSparedM = 0.10;
// Of the cost from the rover by a place to the goal line, past the least of all: until there the field is laid.
constexpr double kBeyond = 4.0;
constexpr float kAtLeast = 0.9F;  // of what fast marching says: its circles are wider than round, its cells coarse

int wrapped(int heading) {
  return (heading % HeadingField::kHeadings + HeadingField::kHeadings) % HeadingField::kHeadings;
}

}  // namespace

HeadingField::HeadingField(const DrivingPrices& prices, const HeadingQuery& query)
    : prices_(prices),
      query_(query),
      terrain_(query.terrain),
      cells_(terrain_.cells()),
      count_(static_cast<size_t>(cells_) * static_cast<size_t>(cells_)) {
  make_arcs();
  lay_rooms();
  cost_.assign(kMotions * count_ * kHeadings, kNone);
  done_.assign(cost_.size(), false);
  buckets_.resize(static_cast<size_t>(kMostCost / kBucketM) + 1);
  seed();
  spread();
}

// Of each heading and turn the arc whose end lies closest to a cell's centre.
void HeadingField::make_arcs() {
  arcs_to_.resize(kHeadings);
  arcs_from_.resize(kHeadings);
  const double bin = yaw_of(1);
  for (int heading = 0; heading < kHeadings; ++heading)
    for (const int turn : kTurns) {
      const double shortest = std::max(kShortestM, std::abs(turn) * bin / prices_.max_curvature_per_m);
      double least = kInfinity;
      Arc best{};
      for (double length = shortest; length <= kLongestM; length += kLengthStepM) {
        const double curvature = turn * bin / length;
        const Pose2 start{0.0, 0.0, yaw_of(heading)};
        const Pose2 end = advanced(start, length, curvature);
        const Pose2 middle = advanced(start, 0.5 * length, curvature);
        const auto to_cells = [&](double v) { return static_cast<int>(std::lround(v / terrain_.cell_m())); };
        const double miss = std::hypot(end.x_m - to_cells(end.x_m) * terrain_.cell_m(),
                                       end.y_m - to_cells(end.y_m) * terrain_.cell_m());
        if (miss >= least) continue;
        least = miss;
        const double share = curvature / prices_.max_curvature_per_m;
        best = {heading,
                wrapped(heading + turn),
                to_cells(end.x_m),
                to_cells(end.y_m),
                to_cells(middle.x_m),
                to_cells(middle.y_m),
                wrapped(heading + turn / 2),
                static_cast<float>(length),
                static_cast<float>(prices_.curvature_cost * share * share * length)};
      }
      arcs_to_[best.to_heading].push_back(best);
      arcs_from_[heading].push_back(best);
    }
}

void HeadingField::lay_rooms() {
  ground_.resize(count_);
  from_rover_.resize(count_);
  for (size_t i = 0; i < count_; ++i) {
    const int cell = static_cast<int>(i);
    ground_[i] = static_cast<float>(query_.goal.cost_per_m(terrain_.center_of(cell)));
    from_rover_[i] = kAtLeast * static_cast<float>(query_.goal.from_rover(cell));
  }
  RoomLayers layers(kRoomHeadings, std::vector<std::uint8_t>(count_, kRoomy));
  stamp(query_.roomy_margin_m - query_.slack_m, kTight, layers);
  stamp(query_.turn_margin_m - query_.slack_m, kTurnless, layers);
  stamp(query_.tight_margin_m - query_.slack_m, kSqueezed, layers);
  stamp(query_.squeeze_margin_m - query_.slack_m, kBlocked, layers);
  rooms_.resize(count_ * kRoomHeadings);
  for (size_t cell = 0; cell < count_; ++cell)
    for (size_t heading = 0; heading < kRoomHeadings; ++heading)
      rooms_[cell * kRoomHeadings + heading] = layers[heading][cell];
}

void HeadingField::stamp(double margin_m, Room room, RoomLayers& layers) const {
  std::vector<int> hazards;
  for (const HazardSpot& hazard : terrain_.hazards())
    if (query_.footprint.distance_m(query_.rover, hazard.p) > margin_m + kSparedM)
      hazards.push_back(terrain_.cell_of(hazard.p));
  for (int heading = 0; heading < kRoomHeadings; ++heading)
    stamp_heading(heading, margin_m, room, hazards, layers[heading]);
}

// Every pose whose rectangle, widened by the margin, holds the hazard: the rectangle about the hazard, row by row.
void HeadingField::stamp_heading(int heading, double margin_m, Room room, const std::vector<int>& hazards,
                                 std::vector<std::uint8_t>& layer) const {
  const double c = std::cos(yaw_of(heading));
  const double s = std::sin(yaw_of(heading));
  const double half_length = query_.footprint.half_length_m + margin_m;
  const double half_width = query_.footprint.half_width_m + margin_m;
  const int reach = static_cast<int>(std::hypot(half_length, half_width) / terrain_.cell_m()) + 1;
  struct Row {
    int dy;
    int from;
    int to;
  };
  std::vector<Row> rows;
  for (int dy = -reach; dy <= reach; ++dy) {
    Row row{dy, reach + 1, -reach - 1};
    for (int dx = -reach; dx <= reach; ++dx) {
      const double x = dx * terrain_.cell_m();
      const double y = dy * terrain_.cell_m();
      if (std::abs(c * x + s * y) >= half_length || std::abs(c * y - s * x) >= half_width) continue;
      row.from = std::min(row.from, dx);
      row.to = std::max(row.to, dx);
    }
    if (row.from <= row.to) rows.push_back(row);
  }
  for (const int hazard : hazards) {
    const int ix = hazard % cells_;
    const int iy = hazard / cells_;
    for (const Row& row : rows) {
      const int y = iy + row.dy;
      if (y < 0 || y >= cells_) continue;
      const int from = std::max(0, ix + row.from);
      const int to = std::min(cells_ - 1, ix + row.to);
      if (from <= to) std::fill(layer.begin() + y * cells_ + from, layer.begin() + y * cells_ + to + 1, room);
    }
  }
}

float HeadingField::metre_cost(int cell, int heading) const {
  const Room here = room(cell, heading);
  if (here == kBlocked) return kNone;
  if (here == kRoomy) return ground_[cell];
  return static_cast<float>(here == kSqueezed ? prices_.squeeze_factor : prices_.tight_factor) * ground_[cell];
}

void HeadingField::seed() {
  for (size_t i = 0; i < count_; ++i) {
    const int cell = static_cast<int>(i);
    if (std::isinf(ground_[i])) continue;
    const Point2 p = terrain_.center_of(cell);
    if (query_.goal.past_line_m(p) > kEndBandM) continue;
    for (int heading = 0; heading < kHeadings; ++heading) {
      const double cost = query_.goal.end_cost({p.x_m, p.y_m, yaw_of(heading)});
      if (std::isinf(cost)) break;
      if (room(cell, heading) != kBlocked)
        offer(state_of(Motion::kDrive, cell, heading), static_cast<float>(std::max(0.0, cost)));
    }
  }
}

void HeadingField::offer(size_t state, float cost) {
  if (!(cost < cost_[state])) return;
  const float through = cost + from_rover_[state / kHeadings / kMotions];
  if (!(through < kMostCost)) return;
  cost_[state] = cost;
  done_[state] = false;
  // The way from the rover is estimated over places, the way to the goal over poses: what is found now may have to be
  // worked off before.
  buckets_[std::max(bucket_, static_cast<size_t>(through / kBucketM))].push_back(static_cast<std::uint32_t>(state));
}

void HeadingField::spread() {
  double last = kInfinity;
  for (; bucket_ < buckets_.size() && kBucketM * static_cast<double>(bucket_) <= last; ++bucket_) {
    // A bucket may grow while it is worked off.
    for (size_t k = 0; k < buckets_[bucket_].size(); ++k) {
      const size_t state = buckets_[bucket_][k];
      if (done_[state]) continue;
      done_[state] = true;
      ++settled_;
      const float cost = cost_[state];
      const auto motion = static_cast<Motion>(state / kHeadings % kMotions);
      const int cell = static_cast<int>(state / kHeadings / kMotions);
      const int heading = static_cast<int>(state % kHeadings);
      if (motion == Motion::kDrive)
        spread_driving(cell, heading, cost);
      else if (motion == Motion::kTurn)
        spread_turning(cell, heading, cost);
      else
        spread_backing(cell, heading, cost);
    }
    if (std::isinf(last) && std::isfinite(to_go(query_.rover))) last = to_go(query_.rover) + kBeyond;
  }
}

float HeadingField::arc_cost(int cell, const Arc& arc) const {
  const int x = cell % cells_ + arc.dx;
  const int y = cell / cells_ + arc.dy;
  if (x < 0 || y < 0 || x >= cells_ || y >= cells_) return kNone;
  const float here = metre_cost(cell, arc.from_heading);
  const float between = metre_cost(cell + arc.middle_dy * cells_ + arc.middle_dx, arc.middle_heading);
  const float there = metre_cost(y * cells_ + x, arc.to_heading);
  return arc.length_m * 0.25F * (here + 2.0F * between + there) + arc.extra;
}

// To the poses from which an arc ends here, to the end of a point turn, and to that of a way stern first.
void HeadingField::spread_driving(int cell, int heading, float cost) {
  for (const Arc& arc : arcs_to_[heading]) {
    const int x = cell % cells_ - arc.dx;
    const int y = cell / cells_ - arc.dy;
    if (x < 0 || y < 0 || x >= cells_ || y >= cells_) continue;
    const int from = y * cells_ + x;
    offer(state_of(Motion::kDrive, from, arc.from_heading), cost + arc_cost(from, arc));
  }
  offer(state_of(Motion::kTurn, cell, heading), cost);
  if (query_.may_back)
    offer(state_of(Motion::kBack, cell, heading), cost + static_cast<float>(prices_.reversal_cost_m));
}

// Stern first the rover came over the arcs that begin here, against their sense.
void HeadingField::spread_backing(int cell, int heading, float cost) {
  for (const Arc& arc : arcs_from_[heading]) {
    const float way = arc_cost(cell, arc);
    if (way == kNone) continue;
    const int from = cell + arc.dy * cells_ + arc.dx;
    if (terrain_.unseen(from)) continue;
    offer(state_of(Motion::kBack, from, arc.to_heading), cost + static_cast<float>(prices_.back_factor) * way);
  }
  offer(state_of(Motion::kDrive, cell, heading), cost + static_cast<float>(prices_.reversal_cost_m));
}

// Backwards through a point turn: either it goes on, or it began here.
void HeadingField::spread_turning(int cell, int heading, float cost) {
  for (const int turn : {1, -1}) {
    const int from = wrapped(heading + turn);
    const Room there = room(cell, from);
    if (there >= kTurnless) continue;
    const double factor = there == kTight ? prices_.tight_turn_factor : 1.0;
    offer(state_of(Motion::kTurn, cell, from),
          cost + static_cast<float>(factor * prices_.turn_cost_per_rad_m * yaw_of(1)));
  }
  offer(state_of(Motion::kDrive, cell, heading), cost + static_cast<float>(prices_.turn_cost_m));
  if (query_.may_back) offer(state_of(Motion::kBack, cell, heading), cost + static_cast<float>(prices_.turn_cost_m));
}

double HeadingField::least_about(const Pose2& pose, Motion motion) const {
  const Point2 corner = terrain_.center_of(0);
  const int ix = static_cast<int>(std::floor((pose.x_m - corner.x_m) / terrain_.cell_m()));
  const int iy = static_cast<int>(std::floor((pose.y_m - corner.y_m) / terrain_.cell_m()));
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
