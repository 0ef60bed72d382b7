#include "path_planner/map/belief_map.hpp"

namespace rover::planning {
namespace {

constexpr double kViewRimM = 0.15;        // near the rim of the view, pitch and roll decide what is in the picture
constexpr double kMaxInnovation = 2.0;    // in standard deviations
constexpr double kImpassableRatio = 1.2;  // an impassable cell of the NavCam's map does not say how tall it is

// Calls f(cell, centre) for the cells that the box touches.
template <class F>
void for_cells_in(GridMap<CellBelief>& map, Point2 low, Point2 high, F&& f) {
  const CellIndex a = map.index_of(low.x_m, low.y_m);
  const CellIndex b = map.index_of(high.x_m, high.y_m);
  const CellIndex o = map.origin();
  for (int iy = std::max(a.iy, o.iy); iy <= std::min(b.iy, o.iy + map.cells() - 1); ++iy)
    for (int ix = std::max(a.ix, o.ix); ix <= std::min(b.ix, o.ix + map.cells() - 1); ++ix) {
      const CellIndex i{ix, iy};
      f(map.at(i), Point2{map.center_x_m(i), map.center_y_m(i)});
    }
}

// Ground plane of the body to odom, seen from above: an affine map.
struct PlaneMap {
  Eigen::Matrix2d A;
  Eigen::Vector2d b;
  explicit PlaneMap(const Eigen::Isometry3d& T) : A(T.linear().topLeftCorner<2, 2>()), b(T.translation().head<2>()) {}
  Eigen::Vector2d operator()(double x_m, double y_m) const { return A * Eigen::Vector2d(x_m, y_m) + b; }
};

// In the picture at any attitude that the rover may have.
bool surely_in_view(const ViewArea& view, double range_m, Point2 in_body) {
  return in_body.x_m <= range_m && view.sees({in_body.x_m - kViewRimM, in_body.y_m}) &&
         view.sees({in_body.x_m, std::abs(in_body.y_m) + kViewRimM});
}

bool is_hit(int cell) {
  return cell == HazardGrid::kObstacle || cell == HazardGrid::kHole || cell == HazardGrid::kLow;
}

// Whether an obstacle of the frame lies between the camera and the point.
bool hidden(const HazardGrid& grid, Point2 camera, Point2 in_body) {
  const int steps = static_cast<int>(distance(camera, in_body) / (0.5 * grid.cell_m));
  for (int i = 1; i < steps; ++i) {
    const double u = static_cast<double>(i) / steps;
    if (is_hit(grid.at({camera.x_m + u * (in_body.x_m - camera.x_m), camera.y_m + u * (in_body.y_m - camera.y_m)})))
      return true;
  }
  return false;
}

// Log-odds that the step is above the limit, N(mean, sigma) > 1: logistic approximation of the distribution function.
double navcam_evidence(const CellBelief& cell) {
  if (cell.step_sigma == CellBelief::kNoSigma) return BeliefConfig::kPrior;
  return 1.702 * (cell.step_ratio - 1.0) / cell.step_sigma;
}

double probability_of(double log_odds) {
  return 1.0 / (1.0 + std::exp(-log_odds));
}

}  // namespace

void BeliefMap::add(const HazardGrid& grid, const Eigen::Isometry3d& T_odom_ground) {
  frame_ = static_cast<std::uint16_t>(frame_ == 0xffff ? 1 : frame_ + 1);
  const PlaneMap to_odom(T_odom_ground);
  const Eigen::Matrix2d to_grid = to_odom.A.inverse();
  Eigen::AlignedBox2d box;
  for (const double x : {grid.origin_x_m, grid.origin_x_m + grid.cells_x * grid.cell_m})
    for (const double y : {grid.origin_y_m, grid.origin_y_m + grid.cells_y * grid.cell_m}) box.extend(to_odom(x, y));
  for_cells_in(map_, {box.min().x(), box.min().y()}, {box.max().x(), box.max().y()}, [&](CellBelief& cell, Point2 p) {
    const Eigen::Vector2d b = to_grid * (Eigen::Vector2d(p.x_m, p.y_m) - to_odom.b);
    const int value = grid.at({b.x(), b.y()});
    if (value == HazardGrid::kUnseen) add_unmeasured(cell, grid, {b.x(), b.y()});
    if (value == HazardGrid::kFree) add_miss(cell, b.norm());
    // The margin about a hazard was seen; the planner keeps margins of its own.
    if (value == HazardGrid::kMargin) add_seen(cell, b.norm());
  });
  // From the side of the frame, so that no hit falls between the cells of the turned grid.
  for (int iy = 0; iy < grid.cells_y; ++iy)
    for (int ix = 0; ix < grid.cells_x; ++ix) {
      const int value = grid.cells[static_cast<size_t>(iy) * grid.cells_x + ix];
      if (!is_hit(value)) continue;
      const Eigen::Vector2d b(grid.origin_x_m + (ix + 0.5) * grid.cell_m, grid.origin_y_m + (iy + 0.5) * grid.cell_m);
      const Eigen::Vector2d p = to_odom(b.x(), b.y());
      add_hit(map_.index_of(p.x(), p.y()), value == HazardGrid::kLow, b.norm());
    }
}

// A low hazard was seen to be low. Of another the top may lie above the picture, unless it is near; as long as nothing
// says that it is low it counts as tall.
void BeliefMap::add_hit(CellIndex index, bool low, double range_m) {
  if (!map_.contains(index)) return;
  CellBelief& cell = map_.at(index);
  if (cell.last_hit == frame_) return;
  cell.last_hit = frame_;
  cell.known = true;
  cell.unmeasured = 0;
  cell.evidence = static_cast<float>(std::min(config_.max_evidence, cell.evidence + config_.hit));
  const double tall = low ? -config_.miss : range_m <= config_.near_range_m ? config_.hit : 0.0;
  cell.tall_evidence =
      static_cast<float>(std::clamp(cell.tall_evidence + tall, -config_.max_evidence, config_.max_evidence));
}

void BeliefMap::add_miss(CellBelief& cell, double range_m) const {
  add_seen(cell, range_m);
  const double weight = std::min(1.0, config_.near_range_m / range_m);
  cell.evidence = static_cast<float>(std::max(-config_.max_evidence, cell.evidence - weight * config_.miss));
}

void BeliefMap::add_seen(CellBelief& cell, double range_m) const {
  cell.known = true;
  const double near_m = unmeasurable(cell) ? cell.unmeasured_range_m : config_.near_range_m;
  if (static_cast<float>(range_m) <= near_m) cell.unmeasured = 0;
}

void BeliefMap::add_unmeasured(CellBelief& cell, const HazardGrid& grid, Point2 in_body) const {
  if (cell.driven || !surely_in_view(config_.view, config_.near_range_m, in_body)) return;
  if (hidden(grid, config_.view.camera, in_body)) return;
  const auto range_m = static_cast<float>(std::hypot(in_body.x_m, in_body.y_m));
  cell.unmeasured_range_m = cell.unmeasured == 0 ? range_m : std::min(cell.unmeasured_range_m, range_m);
  if (cell.unmeasured < config_.unmeasured_frames) ++cell.unmeasured;
}

// Successive maps share their heights, so a look as good as the last one replaces half of it and never makes it surer.
// No camera sees the ground under the rover.
void BeliefMap::add(const TraversabilityGrid& grid, const Pose2& rover, const Footprint& footprint) {
  const Point2 high{grid.origin_x_m + grid.cells_x * grid.cell_m, grid.origin_y_m + grid.cells_y * grid.cell_m};
  for_cells_in(map_, {grid.origin_x_m, grid.origin_y_m}, high, [&](CellBelief& cell, Point2 p) {
    const std::ptrdiff_t i = grid.index_of(p);
    if (i < 0) return;
    if (const float height_m = grid.height_m[static_cast<size_t>(i)]; std::isfinite(height_m)) cell.height_m = height_m;
    const int cost = grid.cells[static_cast<size_t>(i)];
    if (cost == TraversabilityGrid::kUnknown) return;
    if (footprint.distance_m(rover, p) <= 0.0) return;
    const bool impassable = cost >= TraversabilityGrid::kLow;
    const double relative = static_cast<double>(cost) / TraversabilityGrid::kLow;
    const double ratio = impassable ? kImpassableRatio : 0.01 * grid.step_percent[static_cast<size_t>(i)];
    const double sigma = config_.sigma + config_.sigma_per_m * distance(p, position(rover));
    const double before = static_cast<double>(cell.step_sigma) * cell.step_sigma;
    const double variance = before + sigma * sigma;
    const auto weight = static_cast<float>(before / variance);
    // A look from afar that contradicts nearer ones by more than its noise is an outlier: it moves the mean only so
    // far.
    const double bound = sigma * sigma > before ? kMaxInnovation * std::sqrt(variance) : kInfinity;
    const double innovation = std::clamp(ratio - cell.step_ratio, -bound, bound);
    cell.step_ratio += weight * static_cast<float>(innovation);
    cell.cost += weight * (static_cast<float>(impassable ? 0.0 : relative) - cell.cost);
    if (impassable)
      cell.tall_fraction += weight * ((cost == TraversabilityGrid::kLow ? 0.0F : 1.0F) - cell.tall_fraction);
    cell.step_sigma = static_cast<float>(std::min(std::sqrt(before), sigma));
    cell.known = true;
  });
}

// In cells: within one a step ends.
void BeliefMap::add_drift(double dead_reckoned_m) {
  if (!(dead_reckoned_m > 0.0)) return;
  const double drift = BeliefConfig::kDriftPerM * dead_reckoned_m / BeliefConfig::kCellM;
  map_.for_each([&](CellIndex, CellBelief& cell) {
    if (cell.step_sigma < CellBelief::kNoSigma)
      cell.step_sigma = static_cast<float>(std::hypot(cell.step_sigma, drift));
    cell.evidence /= static_cast<float>(1.0 + drift * drift);
  });
}

double BeliefMap::probability(const CellBelief& cell) const {
  if (cell.driven) return 0.0;
  const double bound = config_.max_navcam_evidence;
  return probability_of(cell.evidence + std::clamp(navcam_evidence(cell), -bound, bound));
}

// Where the LocCam measures nothing it has no sharper picture than the NavCam, whose evidence then counts in full.
bool BeliefMap::unmeasurable(const CellBelief& cell) const {
  return cell.unmeasured >= config_.unmeasured_frames &&
         probability_of(cell.evidence + navcam_evidence(cell)) >= BeliefConfig::kSurelyFree;
}

void BeliefMap::mark_driven(const Pose2& pose, const Footprint& footprint) {
  const double rim = 0.5 * std::numbers::sqrt2 * BeliefConfig::kCellM;  // cells that the edge passes through
  const double r = footprint.radius_m() + rim;
  for_cells_in(map_, {pose.x_m - r, pose.y_m - r}, {pose.x_m + r, pose.y_m + r}, [&](CellBelief& cell, Point2 p) {
    const double d = footprint.distance_m(pose, p);
    // A wheel is on it, or the body above it; between the wheels of a side there may be a rock.
    if (footprint.wheel_is_on(pose, p))
      cell = {.known = true, .driven = true, .passed = true, .height_m = cell.height_m};
    if (d <= 0.0) cell.known = cell.passed = true, cell.unmeasured = 0, cell.tall_evidence = cell.tall_fraction = 0.0F;
    if (d <= rim) cell.known = true, cell.unmeasured = 0;
  });
}

void BeliefMap::mark_known(Point2 center, double radius_m) {
  for_cells_in(map_, {center.x_m - radius_m, center.y_m - radius_m}, {center.x_m + radius_m, center.y_m + radius_m},
               [&](CellBelief& cell, Point2 p) { cell.known = cell.known || distance(p, center) <= radius_m; });
}

}  // namespace rover::planning
