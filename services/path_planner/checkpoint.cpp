// What the planner keeps over a restart, as bytes: global path, active path, belief map, counters. The pose comes with
// the next POSE; a plan in the background is made anew.
#include <array>
#include <numeric>
#include <tuple>

#include "common/core/path_limits.hpp"
#include "common/core/state_bytes.hpp"
#include "path_planner/path_planner.hpp"

namespace rover::planning {
namespace {

constexpr std::uint32_t kVersion = 8;

void put_points(StateWriter& out, const std::vector<RoutePoint>& points) {
  out.put(static_cast<std::uint64_t>(points.size()));
  for (const RoutePoint& point : points) {
    out.put(point.p);
    out.put(point.global_s_m);
    out.put(point.level);
    out.put(static_cast<std::uint8_t>(point.reverse));
  }
}

std::vector<RoutePoint> get_points(StateReader& in) {
  std::vector<RoutePoint> points(in.count(sizeof(Point2) + sizeof(double) + 2));
  for (RoutePoint& point : points) {
    point.p = in.get<Point2>();
    point.global_s_m = in.get<double>();
    point.level = in.get<std::int8_t>();
    point.reverse = in.get<std::uint8_t>() != 0;
  }
  return points;
}

void put_zones(StateWriter& out, const std::vector<Zone>& zones) {
  out.put(static_cast<std::uint64_t>(zones.size()));
  for (const Zone& zone : zones) {
    out.put(static_cast<std::uint64_t>(zone.name.size()));
    for (const char c : zone.name) out.put(c);
    out.put(static_cast<std::uint8_t>(zone.keep_in));
    out.put(static_cast<std::uint64_t>(zone.points.size()));
    for (const Eigen::Vector2d& p : zone.points) out.put(Point2{p.x(), p.y()});
  }
}

std::vector<Zone> get_zones(StateReader& in) {
  std::vector<Zone> zones(in.count(2 * sizeof(std::uint64_t) + 1));
  for (Zone& zone : zones) {
    zone.name.resize(in.count(1));
    for (char& c : zone.name) c = in.get<char>();
    zone.keep_in = in.get<std::uint8_t>() != 0;
    zone.points.resize(in.count(sizeof(Point2)));
    for (Eigen::Vector2d& p : zone.points) {
      const auto corner = in.get<Point2>();
      p = {corner.x_m, corner.y_m};
    }
  }
  return zones;
}

bool is_finite(Point2 p) {
  return std::isfinite(p.x_m) && std::isfinite(p.y_m);
}

// Numbers, on or off the global path, and no longer than a global path may be.
bool is_path(const std::vector<RoutePoint>& points, double global_length_m) {
  double length_m = 0.0;
  for (size_t i = 0; i < points.size(); ++i) {
    const double s_m = points[i].global_s_m;
    if (!is_finite(points[i].p) || s_m < 0.0 || s_m > global_length_m) return false;
    if (i > 0) length_m += distance(points[i - 1].p, points[i].p);
  }
  return points.size() >= 2 && length_m <= kLongestPathM;
}

void put_map(StateWriter& out, const GridMap<CellBelief>& map) {
  out.put(map.origin());
  out.put(map.cells());
  map.for_each([&](CellIndex, const CellBelief& cell) {
    out.put(static_cast<std::uint8_t>((cell.known ? 1 : 0) | (cell.driven ? 2 : 0) | (cell.passed ? 4 : 0)));
    if (!cell.known) return;
    out.put(cell.unmeasured);
    out.put(std::array{cell.unmeasured_range_m, cell.evidence, cell.step_ratio, cell.step_sigma, cell.cost,
                       cell.tall_evidence, cell.tall_fraction});
    out.put(cell.height_m);
  });
}

// False if the stored map has another size, or its origin is out of range.
bool get_map(StateReader& in, GridMap<CellBelief>& map) {
  constexpr int kMaxIndex = 1 << 24;
  const CellIndex origin = in.get<CellIndex>();
  if (in.get<int>() != map.cells()) return false;
  if (std::abs(origin.ix) > kMaxIndex || std::abs(origin.iy) > kMaxIndex) return false;
  const CellIndex center{origin.ix + map.cells() / 2, origin.iy + map.cells() / 2};
  map.move_to(map.center_x_m(center), map.center_y_m(center));
  bool numbers = true;
  map.for_each([&](CellIndex, CellBelief& cell) {
    const auto flags = in.get<std::uint8_t>();
    cell.known = (flags & 1) != 0;
    cell.driven = (flags & 2) != 0;
    cell.passed = (flags & 4) != 0;
    if (!cell.known) return;
    cell.unmeasured = in.get<std::uint8_t>();
    const auto values = in.get<std::array<float, 7>>();
    std::tie(cell.unmeasured_range_m, cell.evidence, cell.step_ratio, cell.step_sigma, cell.cost, cell.tall_evidence,
             cell.tall_fraction) = std::tuple_cat(values);
    cell.height_m = in.get<float>();
    numbers = numbers && std::isfinite(std::accumulate(values.begin(), values.end(), 0.0F)) && cell.step_sigma > 0.0F &&
              !std::isinf(cell.height_m);
  });
  return numbers;
}

}  // namespace

std::vector<std::uint8_t> PathPlanner::save() const {
  StateWriter out;
  out.put(kVersion);
  out.put(next_path_id_);
  out.put(replans_);
  out.put(back_ups_);
  out.put(wanted_back_ups_);
  out.put(furthest_m_);
  out.put(static_cast<std::uint8_t>(full_level_));
  out.put(static_cast<std::uint8_t>(mapped_));
  out.put(static_cast<std::uint8_t>(global_.has_value()));
  if (global_) {
    out.put(global_->id);
    out.put(global_->corridor_half_width_m);
    out.put(global_->goal_tolerance_m);
    put_points(out, global_->points);
    put_zones(out, global_->zones);
  }
  out.put(static_cast<std::uint8_t>(global_odom_ != nullptr));
  out.put(T_map_odom_);
  out.put(global_progress_m_);
  put_points(out, active_.route().points());
  out.put(active_.kind());
  out.put(active_.corridor_half_width_m());
  out.put(active_.progress_m());
  out.put(active_.planned_m());
  out.put(static_cast<std::uint8_t>(turning_));
  out.put(static_cast<std::uint64_t>(breadcrumbs_.points().size()));
  for (const Point2& p : breadcrumbs_.points()) out.put(p);
  put_map(out, belief_.cells());
  return out.take();
}

bool PathPlanner::restore(const std::vector<std::uint8_t>& bytes) {
  StateReader in(bytes);
  if (in.get<std::uint32_t>() != kVersion) return false;
  PathPlanner fresh(config_, next_path_id_, background_);
  fresh.next_path_id_ = std::max(next_path_id_, in.get<std::int64_t>());
  fresh.replans_ = in.get<std::int32_t>();
  const int back_ups = in.get<int>();
  const int wanted_back_ups = in.get<int>();
  const double furthest_m = in.get<double>();
  fresh.full_level_ = in.get<std::uint8_t>() != 0;
  fresh.mapped_ = in.get<std::uint8_t>() != 0;
  if (in.get<std::uint8_t>() != 0) {
    GlobalPath global;
    global.id = in.get<std::int64_t>();
    global.corridor_half_width_m = in.get<double>();
    global.goal_tolerance_m = in.get<double>();
    global.points = get_points(in);
    global.zones = get_zones(in);
    if (!fresh.set_global_path(global).empty()) return false;
  }
  const bool placed = in.get<std::uint8_t>() != 0;
  const auto T_map_odom = in.get<Pose2>();
  const double global_progress_m = in.get<double>();
  if (placed) {
    if (!fresh.global_ || !is_finite(position(T_map_odom)) || !std::isfinite(T_map_odom.yaw_rad + global_progress_m))
      return false;
    fresh.set_global_in_odom(T_map_odom);
    fresh.global_progress_m_ = std::clamp(global_progress_m, 0.0, fresh.global_odom_->length_m());
  }
  std::vector<RoutePoint> points = get_points(in);
  const auto kind = in.get<PathKind>();
  const auto corridor_m = in.get<double>();
  const auto progress_m = in.get<double>();
  const auto planned_m = in.get<double>();
  fresh.turning_ = in.get<std::uint8_t>() != 0;
  std::deque<Point2> crumbs(in.count(sizeof(Point2)));
  for (Point2& p : crumbs) p = in.get<Point2>();
  if (!get_map(in, fresh.belief_.cells()) || !in.finished()) return false;
  if (!std::isfinite(furthest_m) || !std::all_of(crumbs.begin(), crumbs.end(), is_finite)) return false;
  if (!points.empty()) {
    if (!placed || !is_path(points, fresh.global_map_.length_m())) return false;
    if (kind < PathKind::kGlobal || kind > PathKind::kBacktrack) return false;
    if (!(corridor_m > 0.0) || !std::isfinite(corridor_m + progress_m + planned_m)) return false;
    fresh.active_.restore(fresh.next_path_id_++, kind, Route(std::move(points)), corridor_m, progress_m, planned_m);
  }
  fresh.breadcrumbs_.restore(std::move(crumbs));
  fresh.back_ups_ = std::clamp(back_ups, 0, config_.max_back_ups);
  fresh.wanted_back_ups_ = std::max(wanted_back_ups, 0);
  fresh.furthest_m_ = furthest_m;
  fresh.new_ground_ = true;
  *this = std::move(fresh);
  return true;
}

}  // namespace rover::planning
