#include "tools/orbital_planner/terrain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace rover::orbital {
namespace {

constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

struct Plane {
  double gradient_x = 0.0;  // per cell
  double gradient_y = 0.0;
  double rms_m = 0.0;
};

// Sums over the known cells of a square, relative to its centre, in cells and metres.
struct Moments {
  double n = 0, x = 0, y = 0, z = 0, xx = 0, xy = 0, yy = 0, xz = 0, yz = 0, zz = 0;

  void add(double dx, double dy, double dz) {
    n += 1.0;
    x += dx, y += dy, z += dz;
    xx += dx * dx, xy += dx * dy, yy += dy * dy;
    xz += dx * dz, yz += dy * dz, zz += dz * dz;
  }

  // Empty if the cells are collinear.
  std::optional<Plane> plane() const {
    const double cxx = xx - x * x / n, cxy = xy - x * y / n, cyy = yy - y * y / n;
    const double cxz = xz - x * z / n, cyz = yz - y * z / n, czz = zz - z * z / n;
    const double det = cxx * cyy - cxy * cxy;
    if (!(det > 1e-6 * std::max(1.0, cxx * cyy))) return std::nullopt;
    const double gx = (cyy * cxz - cxy * cyz) / det, gy = (cxx * cyz - cxy * cxz) / det;
    return Plane{gx, gy, std::sqrt(std::max(0.0, (czz - gx * cxz - gy * cyz) / n))};
  }
};

class Window {
 public:
  Window(const ElevationRaster& map, const TerrainConfig& config)
      : map_(map),
        half_width_(std::max(1, static_cast<int>(std::lround(0.5 * config.window_m / map.resolution_m - 0.5)))),
        min_known_(config.min_known_fraction * (2 * half_width_ + 1) * (2 * half_width_ + 1)) {}

  std::optional<Plane> plane_at(int column, int row) const {
    const float middle = map_.at(column, row);
    if (!std::isfinite(middle)) return std::nullopt;
    Moments moments;
    for_known(column, row, half_width_, [&](int dx, int dy, float z) { moments.add(dx, dy, z - middle); });
    return moments.n < min_known_ ? std::nullopt : moments.plane();
  }

  // NaN if the pixel is void.
  double step_m(int column, int row, const Plane& plane) const {
    const float middle = map_.at(column, row);
    if (!std::isfinite(middle)) return kNaN;
    double largest = 0.0;
    for_known(column, row, 1, [&](int dx, int dy, float z) {
      largest = std::max(largest, std::abs(z - middle - plane.gradient_x * dx - plane.gradient_y * dy));
    });
    return largest;
  }

  double pixel_m() const { return map_.resolution_m; }

 private:
  template <class F>
  void for_known(int column, int row, int half_width, F&& f) const {
    for (int y = std::max(0, row - half_width); y <= std::min(map_.height - 1, row + half_width); ++y)
      for (int x = std::max(0, column - half_width); x <= std::min(map_.width - 1, column + half_width); ++x)
        if (const float z = map_.at(x, y); std::isfinite(z)) f(x - column, y - row, z);
  }

  const ElevationRaster& map_;
  int half_width_;
  double min_known_;
};

TerrainClass classify(double slope_rad, double roughness_m, double step_m, const TerrainConfig& config) {
  if (slope_rad > config.max_slope_rad || roughness_m > config.max_roughness_m || step_m > config.max_step_m)
    return TerrainClass::kObstacle;
  if (slope_rad > config.steep_rad) return TerrainClass::kSteep;
  if (roughness_m > config.rough_m) return TerrainClass::kRough;
  return slope_rad > config.sloping_rad ? TerrainClass::kSloping : TerrainClass::kLevel;
}

// NaN if a pixel of the block is void.
double largest_step_m(const Window& window, int column, int row, int n, const Plane& plane) {
  double largest = 0.0;
  for (int y = row; y < row + n; ++y)
    for (int x = column; x < column + n; ++x) {
      const double step = window.step_m(x, y, plane);
      if (std::isnan(step)) return kNaN;
      largest = std::max(largest, step);
    }
  return largest;
}

void classify_cell(const Window& window, int column, int row, int n, const TerrainConfig& config,
                   TerrainLayers& layers) {
  const std::optional<Plane> plane = window.plane_at(column * n + n / 2, row * n + n / 2);
  if (!plane) return;
  const double step = largest_step_m(window, column * n, row * n, n, *plane);
  if (std::isnan(step)) return;
  const size_t i = static_cast<size_t>(row) * layers.width + column;
  const double slope = std::atan(std::hypot(plane->gradient_x, plane->gradient_y) / window.pixel_m());
  const double worst =
      std::max({slope / config.max_slope_rad, plane->rms_m / config.max_roughness_m, step / config.max_step_m});
  layers.slope_rad[i] = static_cast<float>(slope);
  layers.roughness_m[i] = static_cast<float>(plane->rms_m);
  layers.step_m[i] = static_cast<float>(step);
  layers.difficulty[i] = static_cast<float>(std::min(1.0, worst));
  layers.terrain_class[i] = classify(slope, plane->rms_m, step, config);
}

}  // namespace

const char* name_of(TerrainClass c) {
  static constexpr std::array<const char*, kTerrainClasses> kNames = {"unknown", "level", "sloping",
                                                                      "steep",   "rough", "obstacle"};
  return kNames[static_cast<size_t>(c)];
}

TerrainLayers analyse(const ElevationRaster& map, const TerrainConfig& config, int n) {
  TerrainLayers layers;
  layers.width = map.width / n;
  layers.height = map.height / n;
  layers.cell_m = map.resolution_m * n;
  const size_t cells = static_cast<size_t>(layers.width) * layers.height;
  for (std::vector<float>* layer : {&layers.slope_rad, &layers.roughness_m, &layers.step_m, &layers.difficulty})
    layer->assign(cells, kNoValue);
  layers.terrain_class.assign(cells, TerrainClass::kUnknown);
  const Window window(map, config);
  for (int row = 0; row < layers.height; ++row)
    for (int column = 0; column < layers.width; ++column) classify_cell(window, column, row, n, config, layers);
  return layers;
}

std::array<double, kTerrainClasses> class_fractions(const TerrainLayers& layers) {
  std::array<double, kTerrainClasses> fractions{};
  for (TerrainClass c : layers.terrain_class)
    fractions[static_cast<size_t>(c)] += 1.0 / static_cast<double>(layers.terrain_class.size());
  return fractions;
}

}  // namespace rover::orbital
