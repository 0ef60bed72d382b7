#include "rover_simulator/world/rocks.hpp"

#include <algorithm>
#include <cmath>

#include "common/core/check.hpp"
#include "rover_simulator/world/noise.hpp"

namespace rover {
namespace {

constexpr double kCellM = 1.0;
constexpr int kQuantiles = 2048;
constexpr int kIntegrationSteps = 400;
constexpr double kMaxElongation = 1.6;  // long over short axis

double q_of(double k) {
  return 1.79 + 0.152 / k;
}

// Rocks per square metre of diameter >= D.
double density_above(double k, double max_diameter_m, double diameter_m) {
  if (k <= 0.0 || diameter_m >= max_diameter_m) return 0.0;
  const double q = q_of(k);
  // Trapezoids in log D, where the integrand k q exp(-q D) * 4 / (pi D^2) * D is smooth.
  const double a = std::log(diameter_m), step = (std::log(max_diameter_m) - a) / kIntegrationSteps;
  double sum = 0.0;
  for (int i = 0; i <= kIntegrationSteps; ++i) {
    const double d = std::exp(a + i * step);
    const double value = k * q * std::exp(-q * d) * 4.0 / (M_PI * d);
    sum += (i == 0 || i == kIntegrationSteps) ? 0.5 * value : value;
  }
  return sum * step;
}

int poisson(double mean, HashStream& stream) {
  // Poisson sample by Knuth's product of uniforms; the mean is a few rocks per cell.
  const double limit = std::exp(-mean);
  int count = 0;
  for (double product = stream.unit(); product > limit; product *= stream.unit()) ++count;
  return count;
}

bool is_kept_clear(const Rock& rock, std::span<const KeepClear> circles) {
  const double reach = 0.5 * rock.diameter_m * std::sqrt(kMaxElongation);
  return std::any_of(circles.begin(), circles.end(), [&](const KeepClear& circle) {
    return rock.height_m >= circle.height_m &&
           std::hypot(rock.x_m - circle.x_m, rock.y_m - circle.y_m) < circle.radius_m + reach;
  });
}

}  // namespace

bool RockZone::contains(double px_m, double py_m) const {
  for (size_t i = 0; i < x_m.size(); ++i) {
    const size_t next = std::min(i + 1, x_m.size() - 1);
    const double dx = x_m[next] - x_m[i], dy = y_m[next] - y_m[i], squared = dx * dx + dy * dy;
    const double along = squared > 0.0 ? ((px_m - x_m[i]) * dx + (py_m - y_m[i]) * dy) / squared : 0.0;
    const double t = std::clamp(along, 0.0, 1.0);
    if (std::hypot(px_m - x_m[i] - t * dx, py_m - y_m[i] - t * dy) <= half_width_m) return true;
  }
  return false;
}

double rock_density_above(const RockConfig& config, double diameter_m) {
  return density_above(config.k, config.max_diameter_m, diameter_m);
}

RockField::RockField(const RockConfig& config, double width_m, double height_m, std::span<const KeepClear> keep_clear,
                     std::uint64_t seed)
    : config_(config), width_m_(width_m), height_m_(height_m), laws_{law_of(config, config.k)} {
  for (const RockZone& zone : config.zones) laws_.push_back(law_of(config, zone.k));
  cells_x_ = static_cast<int>(std::ceil(width_m / kCellM));
  cells_y_ = static_cast<int>(std::ceil(height_m / kCellM));
  for (int cy = 0; cy < cells_y_; ++cy)
    for (int cx = 0; cx < cells_x_; ++cx) draw_cell(cx, cy, keep_clear, seed);
  index_rocks();
}

RockField::Law RockField::law_of(const RockConfig& config, double k) {
  Law law;
  law.per_square_metre = density_above(k, config.max_diameter_m, config.min_diameter_m);
  if (law.per_square_metre <= 0.0) return law;
  // Inverse cumulative distribution of diameters.
  const double ratio = std::pow(config.max_diameter_m / config.min_diameter_m, 1.0 / kQuantiles), q = q_of(k);
  double diameter = config.min_diameter_m, above = law.per_square_metre;
  for (int i = 0; i <= kQuantiles; ++i) {
    const double wanted = law.per_square_metre * (1.0 - static_cast<double>(i) / kQuantiles);
    while (above > wanted && diameter < config.max_diameter_m) {
      const double next = diameter * ratio, mid = diameter * std::sqrt(ratio);
      above -= k * q * std::exp(-q * mid) * 4.0 / (M_PI * mid * mid) * (next - diameter);
      diameter = next;
    }
    law.quantile_diameter_m.push_back(diameter);
  }
  return law;
}

const RockField::Law& RockField::law_at(double x_m, double y_m) const {
  for (size_t i = 0; i < config_.zones.size(); ++i)
    if (config_.zones[i].contains(x_m, y_m)) return laws_[i + 1];
  return laws_.front();
}

double RockField::draw_diameter_m(const Law& law, double u) {
  const double place = u * kQuantiles;
  const int i = std::min(static_cast<int>(place), kQuantiles - 1);
  return std::lerp(law.quantile_diameter_m[i], law.quantile_diameter_m[i + 1], place - i);
}

void RockField::draw_cell(int cx, int cy, std::span<const KeepClear> keep_clear, std::uint64_t seed) {
  const Law& law = law_at((cx + 0.5) * kCellM, (cy + 0.5) * kCellM);
  if (law.per_square_metre <= 0.0) return;
  HashStream stream(hash_cell(seed, cx, cy));
  const int count = poisson(law.per_square_metre * kCellM * kCellM, stream);
  for (int i = 0; i < count; ++i) {
    Rock rock;
    rock.x_m = (cx + stream.unit()) * kCellM;
    rock.y_m = (cy + stream.unit()) * kCellM;
    rock.diameter_m = draw_diameter_m(law, stream.unit());
    // Triangular distribution: most rocks near the mean ratio, none beyond the limits.
    const double spread = 0.5 * (stream.unit() + stream.unit());
    rock.height_m = rock.diameter_m * std::lerp(config_.min_height_ratio, config_.max_height_ratio, spread);
    rock.shape_seed = stream.bits();
    if (rock.x_m >= width_m_ || rock.y_m >= height_m_ || is_kept_clear(rock, keep_clear)) continue;
    rock.id = static_cast<int>(rocks_.size());
    rocks_.push_back(rock);
  }
}

RockField::Shape RockField::shape_of(const Rock& rock) const {
  HashStream stream(rock.shape_seed);
  Shape shape{};
  shape.x_m = static_cast<float>(rock.x_m);
  shape.y_m = static_cast<float>(rock.y_m);
  shape.height_m = static_cast<float>(rock.height_m);
  const double elongation = stream.range(1.0, kMaxElongation), heading = stream.range(0.0, M_PI);
  const double long_axis = 0.5 * rock.diameter_m * std::sqrt(elongation);
  const double short_axis = 0.5 * rock.diameter_m / std::sqrt(elongation);
  shape.reach_m = static_cast<float>(long_axis);
  shape.axis_x = static_cast<float>(std::cos(heading));
  shape.axis_y = static_cast<float>(std::sin(heading));
  shape.inverse_long = static_cast<float>(1.0 / long_axis);
  shape.inverse_short = static_cast<float>(1.0 / short_axis);
  shape.dome = static_cast<float>(stream.range(0.05, 0.5));
  const double tilt = stream.range(0.0, 0.5), tilt_heading = stream.range(0.0, 2.0 * M_PI);
  shape.tilt_x = static_cast<float>(tilt * std::cos(tilt_heading));
  shape.tilt_y = static_cast<float>(tilt * std::sin(tilt_heading));
  for (int i = 0; i < kFlanks; ++i) {
    const double angle = 2.0 * M_PI * (i + stream.range(0.15, 0.85)) / kFlanks;
    const double offset = stream.range(0.72, 1.0);
    // Flank slope 58-77 degrees, in units of height over semi-axis, with a minimum that reaches the top.
    const double slope = stream.range(1.6, 4.3) * 0.5 * rock.diameter_m / rock.height_m;
    shape.flank_x[i] = static_cast<float>(std::cos(angle));
    shape.flank_y[i] = static_cast<float>(std::sin(angle));
    shape.flank_offset[i] = static_cast<float>(offset);
    shape.flank_rise[i] = static_cast<float>(std::max(slope, 1.1 / offset));
  }
  return shape;
}

// Profile in ellipse coordinates (u, v), |(u, v)| <= 1: minimum of dome, tilted top, flank planes and rim. Continuous,
// 1 at the centre, 0 from the rim outwards.
float RockField::profile_m(const Shape& shape, float dx_m, float dy_m) {
  const float u = (shape.axis_x * dx_m + shape.axis_y * dy_m) * shape.inverse_long;
  const float v = (shape.axis_x * dy_m - shape.axis_y * dx_m) * shape.inverse_short;
  const float r2 = u * u + v * v;
  if (r2 >= 1.0f) return 0.0f;
  constexpr float kTopMargin = 0.15f;  // the tilted top lowers one side but not the summit
  float top = std::min(1.0f - shape.dome * r2, 1.0f + kTopMargin * 0.5f - shape.tilt_x * u - shape.tilt_y * v);
  top = std::min(top, (1.0f - r2) * 2.5f);
  for (int i = 0; i < kFlanks; ++i)
    top = std::min(top, (shape.flank_offset[i] - shape.flank_x[i] * u - shape.flank_y[i] * v) * shape.flank_rise[i]);
  return top > 0.0f ? top * shape.height_m : 0.0f;
}

// Calls f(cell) for each cell that the shape overlaps.
template <class F>
void RockField::for_cells_of(const Shape& shape, F&& f) const {
  const auto cell = [](float m, int cells) {
    return std::clamp(static_cast<int>(std::floor(m / static_cast<float>(kCellM))), 0, cells - 1);
  };
  const int x0 = cell(shape.x_m - shape.reach_m, cells_x_), x1 = cell(shape.x_m + shape.reach_m, cells_x_);
  const int y0 = cell(shape.y_m - shape.reach_m, cells_y_), y1 = cell(shape.y_m + shape.reach_m, cells_y_);
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) f(y * cells_x_ + x);
}

void RockField::index_rocks() {
  shapes_.reserve(rocks_.size());
  for (const Rock& rock : rocks_) shapes_.push_back(shape_of(rock));
  cell_start_.assign(static_cast<size_t>(cells_x_) * cells_y_ + 1, 0);
  for (const Shape& shape : shapes_) for_cells_of(shape, [&](int cell) { ++cell_start_[cell + 1]; });
  for (size_t c = 1; c < cell_start_.size(); ++c) cell_start_[c] += cell_start_[c - 1];
  cell_rocks_.resize(static_cast<size_t>(cell_start_.back()));
  std::vector<int> next(cell_start_.begin(), cell_start_.end() - 1);
  for (size_t i = 0; i < shapes_.size(); ++i)
    for_cells_of(shapes_[i], [&](int cell) { cell_rocks_[next[cell]++] = static_cast<int>(i); });
}

RockField::Hit RockField::at(double x_m, double y_m) const {
  Hit hit;
  if (!(x_m >= 0.0 && y_m >= 0.0 && x_m < width_m_ && y_m < height_m_) || rocks_.empty()) return hit;
  const int cell = static_cast<int>(y_m / kCellM) * cells_x_ + static_cast<int>(x_m / kCellM);
  for (int i = cell_start_[cell]; i < cell_start_[cell + 1]; ++i) {
    const Shape& shape = shapes_[cell_rocks_[i]];
    const auto dx = static_cast<float>(x_m - shape.x_m), dy = static_cast<float>(y_m - shape.y_m);
    if (dx * dx + dy * dy >= shape.reach_m * shape.reach_m) continue;
    const double height = profile_m(shape, dx, dy);
    if (height > hit.height_m) hit = {cell_rocks_[i], height};
  }
  return hit;
}

std::vector<Rock> RockField::in(double x0_m, double y0_m, double x1_m, double y1_m) const {
  std::vector<Rock> found;
  const int cx0 = std::max(0, static_cast<int>(std::floor(x0_m / kCellM)));
  const int cy0 = std::max(0, static_cast<int>(std::floor(y0_m / kCellM)));
  const int cx1 = std::min(cells_x_ - 1, static_cast<int>(std::floor(x1_m / kCellM)));
  const int cy1 = std::min(cells_y_ - 1, static_cast<int>(std::floor(y1_m / kCellM)));
  for (int cy = cy0; cy <= cy1; ++cy)
    for (int cx = cx0; cx <= cx1; ++cx)
      for (int i = cell_start_[cy * cells_x_ + cx]; i < cell_start_[cy * cells_x_ + cx + 1]; ++i) {
        const Rock& rock = rocks_[cell_rocks_[i]];
        const bool own_cell = static_cast<int>(rock.x_m / kCellM) == cx && static_cast<int>(rock.y_m / kCellM) == cy;
        if (own_cell && rock.x_m >= x0_m && rock.x_m <= x1_m && rock.y_m >= y0_m && rock.y_m <= y1_m)
          found.push_back(rock);
      }
  std::sort(found.begin(), found.end(), [](const Rock& a, const Rock& b) { return a.id < b.id; });
  return found;
}

}  // namespace rover
