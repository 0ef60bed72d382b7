#include "tools/oracle/cost_to_go.hpp"

#include <algorithm>

#include "common/core/fast_marching.hpp"

namespace rover::oracle {
namespace {

// Of half a circle: the footprint is the same after half a turn. Twice as many as the search distinguishes: its arcs
// lead between them.
constexpr int kTriedHeadings = 48;

// The headings are counted from that of the start, as those that the search reaches by point turns.
std::vector<std::uint8_t> fits_at_a_heading(const Region& region, const FootprintCheck& check, double start_yaw_rad) {
  std::vector<std::uint8_t> fits(region.inside.size(), 0);
  double last = start_yaw_rad;  // what fits here fits at the next cell most often
  for (size_t i = 0; i < fits.size(); ++i) {
    if (!region.inside[i]) continue;
    for (int h = 0; h < kTriedHeadings && !fits[i]; ++h) {
      const double yaw = last + h * kPi / kTriedHeadings;
      fits[i] = check.is_free(Pose2{region.x_m(static_cast<int>(i)), region.y_m(static_cast<int>(i)), yaw}) ? 1 : 0;
      if (fits[i]) last = std::fmod(yaw, kPi);
    }
  }
  return fits;
}

// One cell more on each side: a passage narrower than a cell may lie between the centres.
std::vector<double> costs(const Region& region, const std::vector<std::uint8_t>& fits) {
  std::vector<double> cost(fits.size(), kInfinity);
  for (int y = 0; y < region.height; ++y)
    for (int x = 0; x < region.width; ++x) {
      if (!fits[static_cast<size_t>(y) * region.width + x]) continue;
      for (int v = std::max(0, y - 1); v <= std::min(region.height - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(region.width - 1, x + 1); ++u)
          if (region.inside[static_cast<size_t>(v) * region.width + u])
            cost[static_cast<size_t>(v) * region.width + u] = 1.0;
    }
  return cost;
}

}  // namespace

Region region_around(const Points& line, double half_width_m, double map_width_m, double map_length_m) {
  Region region{kInfinity, kInfinity};
  double x1_m = -kInfinity;
  double y1_m = -kInfinity;
  for (const Eigen::Vector2d& p : line) {
    region.x0_m = std::min(region.x0_m, std::max(0.0, p.x() - half_width_m));
    region.y0_m = std::min(region.y0_m, std::max(0.0, p.y() - half_width_m));
    x1_m = std::max(x1_m, std::min(map_width_m, p.x() + half_width_m));
    y1_m = std::max(y1_m, std::min(map_length_m, p.y() + half_width_m));
  }
  region.width = std::max(0, static_cast<int>((x1_m - region.x0_m) / Region::kCellM));
  region.height = std::max(0, static_cast<int>((y1_m - region.y0_m) / Region::kCellM));
  region.inside.assign(static_cast<size_t>(region.width) * region.height, 0);
  const auto mark_disc = [&](const Eigen::Vector2d& p) {
    for (int y = 0; y < region.height; ++y) {
      const double dy = region.y0_m + (y + 0.5) * Region::kCellM - p.y();
      if (std::abs(dy) > half_width_m) continue;
      const double dx = std::sqrt(half_width_m * half_width_m - dy * dy);
      const double from = (p.x() - dx - region.x0_m) / Region::kCellM;
      const double to = (p.x() + dx - region.x0_m) / Region::kCellM;
      const auto row = region.inside.begin() + static_cast<std::ptrdiff_t>(y) * region.width;
      std::fill(row + std::clamp(static_cast<int>(from), 0, region.width),
                row + std::clamp(static_cast<int>(to), 0, region.width), std::uint8_t{1});
    }
  };
  constexpr double kDiscSpacingM = 0.5;
  for (size_t i = 0; i < line.size(); ++i) {
    const Eigen::Vector2d& next = line[std::min(i + 1, line.size() - 1)];
    const int steps = std::max(1, static_cast<int>((next - line[i]).norm() / kDiscSpacingM));
    for (int k = 0; k < steps; ++k) mark_disc(line[i] + (next - line[i]) * k / steps);
  }
  return region;
}

CostToGo::CostToGo(const Region& region, const FootprintCheck& check, const Eigen::Vector2d& goal, double tolerance_m,
                   double start_yaw_rad)
    : region_(region) {
  MarchGrid grid{region.width, region.height, Region::kCellM,
                 costs(region, fits_at_a_heading(region, check, start_yaw_rad))};
  std::vector<Seed> seeds;
  for (int cell = 0; cell < region.width * region.height; ++cell)
    if (std::hypot(region.x_m(cell) - goal.x(), region.y_m(cell) - goal.y()) <= tolerance_m)
      seeds.push_back({cell, 0.0});
  metres_ = march(grid, seeds, -1, 0.0);
}

}  // namespace rover::oracle
