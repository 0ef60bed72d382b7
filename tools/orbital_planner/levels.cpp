#include "tools/orbital_planner/levels.hpp"

#include <algorithm>
#include <cmath>

namespace rover::orbital {
namespace {

// Arc length of each point along the line.
std::vector<double> arc_lengths_m(const Line& line) {
  std::vector<double> arc_m{0.0};
  for (size_t i = 1; i < line.size(); ++i) arc_m.push_back(arc_m.back() + (line[i] - line[i - 1]).norm());
  return arc_m;
}

// Mean over the cells within radius_m; unknown cells count as 1.
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

struct HardSegment {
  double from_m, to_m;
};

std::vector<HardSegment> hard_segments(const std::vector<double>& arc_m, const std::vector<double>& difficulty,
                                       const LevelConfig& config) {
  std::vector<HardSegment> hard;
  bool full = false;
  for (size_t i = 0; i < arc_m.size(); ++i) {
    const bool was = full;
    full = difficulty[i] > (full ? config.efficient_below : config.full_above);
    if (full && !was) hard.push_back({arc_m[i], arc_m[i]});
    if (full) hard.back().to_m = i + 1 < arc_m.size() ? arc_m[i + 1] : arc_m[i];
  }
  return hard;
}

void lengthen(HardSegment& segment, double length_m, const LevelConfig& config) {
  segment.from_m = std::max(0.0, segment.from_m - config.lead_distance_m);
  const double missing = config.min_segment_length_m - (segment.to_m - segment.from_m);
  if (missing <= 0.0) return;
  segment.from_m = std::max(0.0, segment.from_m - 0.5 * missing);
  segment.to_m = std::min(length_m, segment.from_m + config.min_segment_length_m);
  segment.from_m = std::max(0.0, segment.to_m - config.min_segment_length_m);
}

// Merges Full segments if the Efficient gap between them, or at an end, is shorter than the minimum.
std::vector<HardSegment> merged(const std::vector<HardSegment>& segments, double length_m, double min_length_m) {
  std::vector<HardSegment> all;
  for (const HardSegment& s : segments) {
    if (!all.empty() && s.from_m - all.back().to_m < min_length_m)
      all.back() = {std::min(all.back().from_m, s.from_m), std::max(all.back().to_m, s.to_m)};
    else
      all.push_back(s);
  }
  if (!all.empty() && all.front().from_m < min_length_m) all.front().from_m = 0.0;
  if (!all.empty() && length_m - all.back().to_m < min_length_m) all.back().to_m = length_m;
  return all;
}

}  // namespace

std::vector<double> difficulty_along(const Line& line, const TerrainLayers& layers, const LevelConfig& config) {
  std::vector<double> at(line.size()), mean(line.size());
  std::transform(line.begin(), line.end(), at.begin(),
                 [&](const Eigen::Vector2d& p) { return difficulty_at(p, layers, config.corridor_half_width_m); });
  const std::vector<double> arc_m = arc_lengths_m(line);
  for (size_t i = 0; i < line.size(); ++i) {
    double sum = 0.0;
    int count = 0;
    for (size_t k = 0; k < line.size(); ++k)
      if (std::abs(arc_m[k] - arc_m[i]) <= 0.5 * config.averaging_distance_m) sum += at[k], ++count;
    mean[i] = sum / count;
  }
  return mean;
}

std::vector<Level> levels_along(const Line& line, const std::vector<double>& difficulty, const LevelConfig& config) {
  const std::vector<double> arc_m = arc_lengths_m(line);
  std::vector<HardSegment> segments = hard_segments(arc_m, difficulty, config);
  for (HardSegment& segment : segments) lengthen(segment, arc_m.back(), config);
  std::vector<Level> levels(line.size(), Level::kEfficient);
  for (const HardSegment& s : merged(segments, arc_m.back(), config.min_segment_length_m))
    for (size_t i = 0; i + 1 < line.size(); ++i)
      if (arc_m[i + 1] > s.from_m && arc_m[i] < s.to_m) levels[i] = Level::kFull;
  if (levels.size() > 1) levels.back() = levels[levels.size() - 2];
  return levels;
}

}  // namespace rover::orbital
