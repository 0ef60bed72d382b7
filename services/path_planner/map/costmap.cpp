#include "path_planner/map/costmap.hpp"

#include "common/core/distance_field.hpp"

namespace rover::planning {
namespace {

// A single unknown cell hides nothing that matters: a hazard of 0.15 m is wider than a cell.
constexpr int kKnownNeighbours = 6;
// Ground that cannot be measured from near counts where it is so wide that a rock fits in.
constexpr int kWideCells = 5;
constexpr int kWideCount = 20;          // of 25
constexpr double kBesideTrackM = 0.25;  // backing up, the rover may leave by this what it has driven
constexpr double kLowFraction = 0.3;    // of the cost of a hazard, if the body passes over it

// Fills unknown cells among known ones.
std::vector<std::uint8_t> filled(const std::vector<std::uint8_t>& unknown, int cells) {
  std::vector<std::uint8_t> out = unknown;
  for (int y = 1; y + 1 < cells; ++y)
    for (int x = 1; x + 1 < cells; ++x) {
      const size_t i = static_cast<size_t>(y) * cells + x;
      if (!unknown[i]) continue;
      const auto row = [&](size_t j) { return unknown[j - 1] + unknown[j] + unknown[j + 1]; };
      if (9 - row(i - cells) - row(i) - row(i + cells) >= kKnownNeighbours) out[i] = 0;
    }
  return out;
}

std::vector<std::uint8_t> wide_parts(const std::vector<std::uint8_t>& mask, int cells) {
  if (std::find(mask.begin(), mask.end(), 1) == mask.end()) return mask;
  const int n = cells + 1;
  std::vector<int> sum(static_cast<size_t>(n) * n, 0);
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x)
      sum[(y + 1) * n + x + 1] = mask[y * cells + x] + sum[y * n + x + 1] + sum[(y + 1) * n + x] - sum[y * n + x];
  std::vector<std::uint8_t> out(mask.size(), 0);
  for (int y = 0; y + kWideCells <= cells; ++y)
    for (int x = 0; x + kWideCells <= cells; ++x) {
      const int x1 = x + kWideCells;
      const int y1 = y + kWideCells;
      if (sum[y1 * n + x1] - sum[y * n + x1] - sum[y1 * n + x] + sum[y * n + x] < kWideCount) continue;
      for (int v = y; v < y1; ++v)
        for (int u = x; u < x1; ++u) out[v * cells + u] = mask[v * cells + u];
    }
  return out;
}

// The largest value within so many cells, along rows and columns.
std::vector<float> widened(const std::vector<float>& values, int cells, int reach) {
  const auto n = static_cast<size_t>(cells);
  std::vector<float> along_rows = values;
  for (size_t row = 0; row < n * n; row += n)
    for (size_t by = 1; by <= static_cast<size_t>(reach); ++by)
      for (size_t x = 0; x + by < n; ++x) {
        along_rows[row + x] = std::max(along_rows[row + x], values[row + x + by]);
        along_rows[row + x + by] = std::max(along_rows[row + x + by], values[row + x]);
      }
  std::vector<float> out = along_rows;
  for (size_t by = n; by <= n * static_cast<size_t>(reach); by += n)
    for (size_t i = 0; i + by < n * n; ++i) {
      out[i] = std::max(out[i], along_rows[i + by]);
      out[i + by] = std::max(out[i + by], along_rows[i]);
    }
  return out;
}

}  // namespace

Costmap::Costmap(const CostmapConfig& config, const BeliefMap& belief, Point2 rover, double side_m,
                 const std::vector<Zone>& zones)
    : config_(config),
      cells_(std::min(belief.cells().cells(), static_cast<int>(std::lround(side_m / belief.cells().cell_m())))),
      cell_m_(belief.cells().cell_m()),
      side_m_(cells_ * cell_m_) {
  const GridMap<CellBelief>& map = belief.cells();
  const CellIndex center = map.index_of(rover.x_m, rover.y_m);
  const CellIndex origin{center.ix - cells_ / 2, center.iy - cells_ / 2};
  corner_ = {origin.ix * cell_m_, origin.iy * cell_m_};
  const size_t count = static_cast<size_t>(cells_) * static_cast<size_t>(cells_);
  Cells cells;
  cells.reserve(count);
  for (int iy = 0; iy < cells_; ++iy)
    for (int ix = 0; ix < cells_; ++ix) cells.push_back(&map.get({origin.ix + ix, origin.iy + iy}));
  std::vector<std::uint8_t> unmeasurable(count);
  passed_.resize(count);
  for (size_t i = 0; i < count; ++i) {
    unmeasurable[i] = belief.unmeasurable(*cells[i]) ? 1 : 0;
    passed_[i] = cells[i]->passed ? 1 : 0;
  }
  if (std::any_of(cells.begin(), cells.end(), [](const CellBelief* cell) { return std::isfinite(cell->height_m); }))
    for (const CellBelief* cell : cells) height_m_.push_back(cell->height_m);
  set_unknown(cells, unmeasurable);
  set_hazards(cells, belief, unmeasurable, walls_of(zones));
}

void Costmap::set_unknown(const Cells& cells, const std::vector<std::uint8_t>& unmeasurable) {
  const std::vector<std::uint8_t> wide = wide_parts(unmeasurable, cells_);
  unknown_.resize(cells.size());
  for (size_t i = 0; i < cells.size(); ++i) unknown_[i] = cells[i]->known && !wide[i] ? 0 : 1;
  unknown_ = filled(unknown_, cells_);
  if (backing_up()) know_track();
  unknown_distance_ = distance_field(unknown_, cells_, cells_, cell_m_);
}

void Costmap::set_hazards(const Cells& cells, const BeliefMap& belief, const std::vector<std::uint8_t>& unmeasurable,
                          const std::vector<std::uint8_t>& walls) {
  std::vector<std::uint8_t> hazard(cells.size(), 0);
  own_cost_.resize(cells.size());
  for (size_t i = 0; i < cells.size(); ++i) {
    if (i % static_cast<size_t>(cells_) == 0) row_begin_.push_back(hazards_.size());
    const CellBelief& cell = *cells[i];
    const bool judged = cell.known && !(backing_up() && cell.passed);
    const double p = judged ? belief.probability(cell) : 0.0;
    const bool unmeasured = unknown_[i] && unmeasurable[i];
    const bool low = !unmeasured && !walls[i] && belief.low(cell);
    own_cost_[i] =
        static_cast<float>((low ? kLowFraction : 1.0) * config_.hazard_cost * p + config_.difficulty_cost * cell.cost);
    hazard[i] = p >= config_.hazard_probability || unmeasured || walls[i] ? 1 : 0;
    if (hazard[i]) hazards_.push_back({center_of(static_cast<int>(i)), low});
  }
  row_begin_.push_back(hazards_.size());
  hazard_distance_ = distance_field(hazard, cells_, cells_, cell_m_);
}

double Costmap::height_m(Point2 p) const {
  const double x = (p.x_m - corner_.x_m) / cell_m_ - 0.5;
  const double y = (p.y_m - corner_.y_m) / cell_m_ - 0.5;
  if (!(x >= 0.0 && y >= 0.0 && x < cells_ - 1 && y < cells_ - 1)) return kNaN;
  const auto ix = static_cast<int>(x);
  const auto iy = static_cast<int>(y);
  const float* row = &height_m_[static_cast<size_t>(iy) * cells_ + ix];
  const double u = x - ix;
  const double low = (1.0 - u) * row[0] + u * row[1];
  const double high = (1.0 - u) * row[cells_] + u * row[cells_ + 1];
  return low + (y - iy) * (high - low);
}

void Costmap::know_track() {
  const std::vector<double> beside_m = distance_field(passed_, cells_, cells_, cell_m_);
  for (size_t i = 0; i < unknown_.size(); ++i)
    if (beside_m[i] <= kBesideTrackM)
      unknown_[i] = 0;
    else if (config_.use == CostmapUse::kBackingUpOnTrack)
      unknown_[i] = 1;
}

std::vector<float> Costmap::costs() const {
  std::vector<float> out = widened(own_cost_, cells_, static_cast<int>(config_.wheel_reach_m / cell_m_));
  for (size_t i = 0; i < out.size(); ++i)
    out[i] += static_cast<float>(1.0 + (unknown_[i] ? config_.unknown_cost : 0.0));
  return out;
}

// The part of the side from a along `along` that lies within the window, as fractions; none: first > second.
std::pair<double, double> Costmap::within(const Eigen::Vector2d& a, const Eigen::Vector2d& along) const {
  double from = 0.0, to = 1.0;
  const Eigen::Vector2d low(corner_.x_m, corner_.y_m);
  for (int axis = 0; axis < 2; ++axis) {
    const double at = a[axis] - low[axis];
    if (along[axis] == 0.0) {
      if (at < 0.0 || at > side_m_) return {1.0, 0.0};
      continue;
    }
    const double u = -at / along[axis], v = (side_m_ - at) / along[axis];
    from = std::max(from, std::min(u, v));
    to = std::min(to, std::max(u, v));
  }
  return {from, to};
}

// The border of a keep-in is no wall where another keep-in contains it.
std::vector<std::uint8_t> Costmap::walls_of(const std::vector<Zone>& zones) const {
  std::vector<std::uint8_t> walls(static_cast<size_t>(cells_) * static_cast<size_t>(cells_), 0);
  for (const Zone& zone : zones) {
    std::vector<Zone> others;
    for (const Zone& other : zones)
      if (zone.keep_in && other.keep_in && &other != &zone) others.push_back(other);
    for (size_t i = 0; i < zone.points.size(); ++i) {
      const Eigen::Vector2d a = zone.points[i], along = zone.points[(i + 1) % zone.points.size()] - a;
      const auto [from, to] = within(a, along);
      const int steps = 1 + static_cast<int>(std::max(0.0, to - from) * along.norm() / (0.5 * cell_m_));
      for (int k = 0; from <= to && k <= steps; ++k) {
        const Eigen::Vector2d p = a + (from + (to - from) * k / steps) * along;
        const bool inner = !others.empty() && forbidding_zone(others, p) == nullptr;
        if (!inner && contains({p.x(), p.y()})) walls[static_cast<size_t>(cell_of({p.x(), p.y()}))] = 1;
      }
    }
  }
  return walls;
}

std::span<const Hazard> Costmap::hazards_near(Point2 p, double reach_m) const {
  const auto row = [&](double y_m) {
    return std::clamp(static_cast<int>(std::floor((y_m - corner_.y_m) / cell_m_)), 0, cells_ - 1);
  };
  const size_t begin = row_begin_[row(p.y_m - reach_m)];
  return {hazards_.data() + begin, row_begin_[row(p.y_m + reach_m) + 1] - begin};
}

}  // namespace rover::planning
