// The planner's memory as bytes: global path, active path, local map, counters. The pose comes anew with the next POSE.
#include "common/core/state_bytes.hpp"
#include "path_planner/path_planner.hpp"

namespace rover::planning {
namespace {

constexpr std::uint32_t kVersion = 4;

void put_points(StateWriter& out, const std::vector<RoutePoint>& points) {
  out.put(static_cast<std::uint64_t>(points.size()));
  for (const RoutePoint& point : points) {
    out.put(point.p);
    out.put(point.global_s_m);
    out.put(point.level);
  }
}

std::vector<RoutePoint> get_points(StateReader& in) {
  std::vector<RoutePoint> points(in.count(sizeof(Point2) + sizeof(double) + 1));
  for (RoutePoint& point : points) {
    point.p = in.get<Point2>();
    point.global_s_m = in.get<double>();
    point.level = in.get<std::int8_t>();
  }
  return points;
}

void put_map(StateWriter& out, const GridMap<GroundCell>& map) {
  out.put(map.origin());
  out.put(map.cells());
  map.for_each([&](CellIndex, const GroundCell& cell) {
    out.put(static_cast<std::uint8_t>(cell.seen));
    out.put(cell.hits);
    out.put(cell.contrary);
    out.put(cell.looks);
    out.put(cell.vain_m);
  });
}

// False where the stored map has another size, or a range that is none.
bool get_map(StateReader& in, GridMap<GroundCell>& map) {
  const CellIndex origin = in.get<CellIndex>();
  if (in.get<int>() != map.cells()) return false;
  const CellIndex center{origin.ix + map.cells() / 2, origin.iy + map.cells() / 2};
  map.move_to(map.center_x_m(center), map.center_y_m(center));
  bool sound = true;
  map.for_each([&](CellIndex, GroundCell& cell) {
    cell.seen = in.get<std::uint8_t>() != 0;
    cell.hits = in.get<std::uint8_t>();
    cell.contrary = in.get<std::uint8_t>();
    cell.looks = in.get<std::uint8_t>();
    cell.vain_m = in.get<float>();
    sound &= cell.vain_m >= 0.0F;
  });
  return sound;
}

}  // namespace

std::vector<std::uint8_t> PathPlanner::save() const {
  StateWriter out;
  out.put(kVersion);
  out.put(next_path_id_);
  out.put(replans_);
  out.put(static_cast<std::uint8_t>(global_.has_value()));
  if (global_) {
    out.put(global_->id);
    out.put(global_->corridor_half_width_m);
    out.put(global_->goal_tolerance_m);
    put_points(out, global_->points);
  }
  put_points(out, active_.route.points());
  out.put(active_.id);
  out.put(active_.kind);
  out.put(active_.repair_end_m);
  out.put(active_.margin_m);
  out.put(active_.corridor_half_width_m);
  out.put(active_.progress_m);
  out.put(static_cast<std::uint8_t>(!legs_.empty()));
  out.put(static_cast<std::uint64_t>(driven_.points().size()));
  for (const Point2& p : driven_.points()) out.put(p);
  put_map(out, memory_.map());
  return out.take();
}

bool PathPlanner::restore(const std::vector<std::uint8_t>& bytes) {
  StateReader in(bytes);
  if (in.get<std::uint32_t>() != kVersion) return false;
  PathPlanner fresh(config_, next_path_id_, maker_);
  fresh.next_path_id_ = std::max(next_path_id_, in.get<std::int64_t>());
  fresh.replans_ = in.get<std::int32_t>();
  if (in.get<std::uint8_t>() != 0) {
    GlobalPath global;
    global.id = in.get<std::int64_t>();
    global.corridor_half_width_m = in.get<double>();
    global.goal_tolerance_m = in.get<double>();
    global.points = get_points(in);
    if (!fresh.set_global_path(global).empty()) return false;
  }
  fresh.active_.route = Route(get_points(in));
  fresh.active_.id = in.get<std::int64_t>();
  fresh.active_.kind = in.get<PathKind>();
  fresh.active_.repair_end_m = in.get<double>();
  fresh.active_.margin_m = in.get<double>();
  fresh.active_.corridor_half_width_m = in.get<double>();
  fresh.active_.progress_m = in.get<double>();
  fresh.replan_wanted_ = in.get<std::uint8_t>() != 0;  // the legs that follow are forgotten
  std::deque<Point2> driven(in.count(sizeof(Point2)));
  for (Point2& p : driven) p = in.get<Point2>();
  fresh.driven_.restore(std::move(driven));
  if (!get_map(in, fresh.memory_.map()) || !in.finished()) return false;
  const bool sound = fresh.active_.route.empty() || (fresh.global_ && fresh.active_.route.points().size() >= 2);
  if (!sound) return false;
  fresh.resumed_ = true;
  fresh.new_ground_ = true;
  *this = std::move(fresh);
  return true;
}

}  // namespace rover::planning
