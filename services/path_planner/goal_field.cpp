#include "path_planner/goal_field.hpp"

namespace rover::planning {
namespace {

constexpr double kStationStepM = 0.25;
constexpr double kStationsBehindM = 5.0;
constexpr double kStationsBeyondM = 5.0;  // the goal line
constexpr double kMapRimM = 0.3;          // of the map, where nothing ends
constexpr double kLineBandM = 0.3;        // of the cells that stand for the goal line
constexpr double kRimBandM = 0.3;         // likewise of the map's rim
constexpr double kByRoverM = 1.2;         // the rover may stand closer to a hazard than it would go
constexpr double kSqueezeCost = 6.0;      // per metre there
constexpr double kScrapeM = 0.05;
constexpr double kHalfDiagonal = 0.71;
constexpr double kFreeHeadingRad = 0.3;
constexpr double kEverywhere = 1e6;

}  // namespace

GoalField::GoalField(const GoalFieldConfig& config, const GoalQuery& query)
    : config_(config), query_(query), terrain_(query.terrain) {
  const double length = query_.global.length_m();
  goal_ = query_.global.point_at(length);
  const double horizon_m = query_.from_m + query_.back_m + config_.horizon_m;
  goal_in_sight_ = horizon_m >= length && terrain_.inside_m(goal_) >= kMapRimM;
  line_m_ = std::min(horizon_m, length);
  line_in_sight_ = !goal_in_sight_ && line_m_ < length;
  lay_stations();
  lay_costs();
  march_from_goal();
  march_from_rover();
}

void GoalField::lay_stations() {
  struct Station {
    Point2 p;
    double s_m;
  };
  std::vector<Station> stations;
  const double end = std::min(line_m_ + kStationsBeyondM, query_.global.length_m());
  for (double s = std::max(0.0, query_.from_m - kStationsBehindM); s <= end; s += kStationStepM)
    stations.push_back({query_.global.point_at(s), s});
  const size_t count = static_cast<size_t>(terrain_.cells()) * static_cast<size_t>(terrain_.cells());
  station_.resize(count);
  offset_.resize(count);
  for (size_t i = 0; i < count; ++i) {
    const Point2 p = terrain_.center_of(static_cast<int>(i));
    double least = kInfinity;
    for (const Station& station : stations) {
      const double dx = p.x_m - station.p.x_m;
      const double dy = p.y_m - station.p.y_m;
      const double d2 = dx * dx + dy * dy;
      if (d2 >= least) continue;
      least = d2;
      station_[i] = station.s_m;
    }
    offset_[i] = std::sqrt(least);
  }
}

void GoalField::lay_costs() {
  cost_ = {terrain_.cells(), terrain_.cells(), terrain_.cell_m(), std::vector<double>(station_.size(), kInfinity)};
  const double slack = kHalfDiagonal * terrain_.cell_m();
  const double most = std::max(config_.max_deviation_m,
                               terrain_.contains(query_.rover) ? offset_[terrain_.cell_of(query_.rover)] + 1.0 : 0.0);
  for (size_t i = 0; i < cost_.cost_per_m.size(); ++i) {
    const int cell = static_cast<int>(i);
    if (offset_[i] > most) continue;
    const Point2 p = terrain_.center_of(cell);
    const double room = terrain_.hazard_distance_m(cell) - query_.half_width_m;
    const bool near = distance(p, query_.rover) < kByRoverM;
    double cost = 1.0 + difficulty_cost(terrain_.difficulty(cell));
    if (room < query_.margin_m - slack) {
      if (!near || room < -kScrapeM) continue;
      cost = kSqueezeCost;
    } else {
      const double lack = std::clamp(1.0 - (room - query_.margin_m) / config_.risk_distance_m, 0.0, 1.0);
      cost += config_.risk_cost * lack * lack;
    }
    if (terrain_.unseen(cell)) cost += config_.unknown_cost;
    for (const DeadEnd& end : query_.dead_ends)
      if (distance(p, end.p) < config_.dead_end_reach_m) cost += end.cost_per_m;
    cost_.cost_per_m[i] = cost;
  }
}

double GoalField::difficulty_cost(double difficulty) const {
  const double doubt = std::max(0.0, difficulty - config_.doubt_from) / (1.0 - config_.doubt_from);
  return config_.difficulty_cost * difficulty + config_.doubt_cost * doubt;
}

double GoalField::off_path_m(Point2 p, double station_m) const {
  return distance(p, query_.global.point_at(station_m));
}

// The global path is come back to on the way that follows; what lies past the line is gained.
double GoalField::line_cost(Point2 p) const {
  const double station = station_m(p);
  const double off = off_path_m(p, station);
  return std::hypot(off, config_.return_way_m) - config_.return_way_m - (station - line_m_);
}

void GoalField::march_from_goal() {
  std::vector<Seed> seeds;
  for (size_t i = 0; i < station_.size(); ++i) {
    const int cell = static_cast<int>(i);
    const Point2 p = terrain_.center_of(cell);
    if (std::isinf(cost_.cost_per_m[i]) || terrain_.inside_m(p) < kMapRimM) continue;
    if (goal_in_sight_) {
      const double miss = distance(p, goal_);
      if (miss <= query_.goal_reach_m) seeds.push_back({cell, config_.goal_miss_cost * miss});
    } else if (at_rim(p)) {
      seeds.push_back({cell, rim_cost(p)});
    } else if (line_in_sight_ && station_[i] >= line_m_ && station_[i] < line_m_ + kLineBandM) {
      seeds.push_back({cell, std::max(0.0, line_cost(p))});
    }
  }
  reachable_ = !seeds.empty();
  travel_ = reachable_ ? march(cost_, seeds, -1, kEverywhere) : std::vector<double>(station_.size(), kInfinity);
}

void GoalField::march_from_rover() {
  if (terrain_.contains(query_.rover))
    from_rover_ = march(cost_, {{terrain_.cell_of(query_.rover), 0.0}}, -1, kEverywhere);
  else
    from_rover_.assign(station_.size(), 0.0);
}

// Where all ways through the map are closed, one may lead out of it; so does each where the goal lies beyond it, for a
// place beside a goal far off is none.
bool GoalField::at_rim(Point2 p) const {
  const double inside = terrain_.inside_m(p);
  return inside >= kMapRimM && inside < kMapRimM + kRimBandM && (!line_in_sight_ || station_m(p) < line_m_);
}

// Straight on over unknown ground, from the map's rim to where the global path is to be come back to.
double GoalField::rim_cost(Point2 p) const {
  return (1.0 + config_.unknown_cost) * distance(p, query_.global.point_at(line_m_));
}

double GoalField::end_cost(const Pose2& pose) const {
  const Point2 p = position(pose);
  if (terrain_.inside_m(p) < kMapRimM) return kInfinity;
  if (goal_in_sight_) {
    const double miss = distance(p, goal_);
    return miss <= query_.goal_reach_m ? config_.goal_miss_cost * miss : kInfinity;
  }
  if (at_rim(p)) return rim_cost(p);
  const double station = station_m(p);
  if (!line_in_sight_ || station < line_m_) return kInfinity;
  const double turn = std::abs(wrap_angle(query_.global.pose_at(station).yaw_rad - pose.yaw_rad));
  return line_cost(p) + config_.heading_cost_m * std::max(0.0, turn - kFreeHeadingRad);
}

}  // namespace rover::planning
