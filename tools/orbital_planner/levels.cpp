#include "tools/orbital_planner/levels.hpp"

#include <algorithm>
#include <cmath>

namespace rover::orbital {
namespace {

// Way along the line to each point.
std::vector<double> way_along(const Line& line) {
  std::vector<double> way{0.0};
  for (size_t i = 1; i < line.size(); ++i) way.push_back(way.back() + (line[i] - line[i - 1]).norm());
  return way;
}

// Mean over the cells within the corridor's half width of a place; 1 where nothing is known.
double difficulty_at(const Eigen::Vector2d& p, const TerrainLayers& layers, double radius_m) {
  const auto cell = [&](double m) { return static_cast<int>(std::floor(m / layers.cell_m)); };
  double sum = 0.0;
  int count = 0;
  for (int y = cell(p.y() - radius_m); y <= cell(p.y() + radius_m); ++y)
    for (int x = cell(p.x() - radius_m); x <= cell(p.x() + radius_m); ++x) {
      const Eigen::Vector2d center((x + 0.5) * layers.cell_m, (y + 0.5) * layers.cell_m);
      if (x < 0 || y < 0 || x >= layers.width || y >= layers.height) continue;
      if ((center - p).norm() > std::max(radius_m, layers.cell_m)) continue;
      const float value = layers.difficulty[static_cast<size_t>(y) * layers.width + x];
      sum += std::isfinite(value) ? value : 1.0;
      ++count;
    }
  return count > 0 ? sum / count : 1.0;
}

struct HardStretch {
  double from_m, to_m;
};

std::vector<HardStretch> hard_stretches(const std::vector<double>& way, const std::vector<double>& difficulty,
                                        const LevelConfig& config) {
  std::vector<HardStretch> hard;
  bool full = false;
  for (size_t i = 0; i < way.size(); ++i) {
    const bool was = full;
    full = difficulty[i] > (full ? config.efficient_below : config.full_above);
    if (full && !was) hard.push_back({way[i], way[i]});
    if (full) hard.back().to_m = i + 1 < way.size() ? way[i + 1] : way[i];
  }
  return hard;
}

void lengthen(HardStretch& stretch, double way_m, const LevelConfig& config) {
  stretch.from_m = std::max(0.0, stretch.from_m - config.lead_m);
  const double missing = config.least_stretch_m - (stretch.to_m - stretch.from_m);
  if (missing <= 0.0) return;
  stretch.from_m = std::max(0.0, stretch.from_m - 0.5 * missing);
  stretch.to_m = std::min(way_m, stretch.from_m + config.least_stretch_m);
  stretch.from_m = std::max(0.0, stretch.to_m - config.least_stretch_m);
}

// Full where what is left between two of them, or at an end, would be too short for Efficient.
std::vector<HardStretch> joined(const std::vector<HardStretch>& stretches, double way_m, double least_m) {
  std::vector<HardStretch> all;
  for (const HardStretch& s : stretches) {
    if (!all.empty() && s.from_m - all.back().to_m < least_m)
      all.back() = {std::min(all.back().from_m, s.from_m), std::max(all.back().to_m, s.to_m)};
    else
      all.push_back(s);
  }
  if (!all.empty() && all.front().from_m < least_m) all.front().from_m = 0.0;
  if (!all.empty() && way_m - all.back().to_m < least_m) all.back().to_m = way_m;
  return all;
}

}  // namespace

std::vector<double> difficulty_along(const Line& line, const TerrainLayers& layers, const LevelConfig& config) {
  std::vector<double> at(line.size()), mean(line.size());
  std::transform(line.begin(), line.end(), at.begin(),
                 [&](const Eigen::Vector2d& p) { return difficulty_at(p, layers, config.corridor_m); });
  const std::vector<double> way = way_along(line);
  for (size_t i = 0; i < line.size(); ++i) {
    double sum = 0.0;
    int count = 0;
    for (size_t k = 0; k < line.size(); ++k)
      if (std::abs(way[k] - way[i]) <= 0.5 * config.mean_over_m) sum += at[k], ++count;
    mean[i] = sum / count;
  }
  return mean;
}

std::vector<Level> levels_along(const Line& line, const std::vector<double>& difficulty, const LevelConfig& config) {
  const std::vector<double> way = way_along(line);
  std::vector<HardStretch> stretches = hard_stretches(way, difficulty, config);
  for (HardStretch& stretch : stretches) lengthen(stretch, way.back(), config);
  std::vector<Level> levels(line.size(), Level::kEfficient);
  for (const HardStretch& s : joined(stretches, way.back(), config.least_stretch_m))
    for (size_t i = 0; i + 1 < line.size(); ++i)
      if (way[i + 1] > s.from_m && way[i] < s.to_m) levels[i] = Level::kFull;
  if (levels.size() > 1) levels.back() = levels[levels.size() - 2];
  return levels;
}

}  // namespace rover::orbital
