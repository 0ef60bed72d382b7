#include "test/global_localization/bench_world.hpp"

#include <cmath>

#include "common/core/frames.hpp"
#include "rover_simulator/world/noise.hpp"

namespace rover::global::test {
namespace {

constexpr double kUnitSlope = 1.0;

// On an inclined plane the map's height error gives its horizontal shift.
ElevationRaster shift_of(const WorldConfig& config, const ElevationRaster& dtm, std::uint64_t seed, double resolution_m,
                         double toward_rad) {
  WorldConfig bare = config;
  bare.rocks.k = 0.0;
  bare.rocks.zones.clear();
  bare.roughness.rms_m = 0.0;
  bare.orbital.smoothing_px = 0.0;
  bare.orbital.vertical_noise_m = 0.0;
  const ElevationRaster plane =
      plane_raster(dtm.width_m(), dtm.height_m(), dtm.resolution_m, std::atan(kUnitSlope), toward_rad);
  const World world(bare, plane, seed);
  ElevationRaster map = world.orbital_map(resolution_m);
  for (int row = 0; row < map.height; ++row)
    for (int column = 0; column < map.width; ++column)
      map.at(column, row) -=
          static_cast<float>(world.smooth_height_m((column + 0.5) * resolution_m, (row + 0.5) * resolution_m));
  return map;
}

double steepest(const World& world, const Line& line, double length_m) {
  double most = 0.0;
  for (double s = -1.0; s < length_m + 1.0; s += 0.5) {
    const Eigen::Vector2d p = line.at(s);
    const double dx = world.smooth_height_m(p.x() + 0.75, p.y()) - world.smooth_height_m(p.x() - 0.75, p.y());
    const double dy = world.smooth_height_m(p.x(), p.y() + 0.75) - world.smooth_height_m(p.x(), p.y() - 0.75);
    most = std::max(most, std::atan(std::hypot(dx, dy) / 1.5));
  }
  return most;
}

bool within(const World& world, const Eigen::Vector2d& p, double margin_m) {
  return p.x() > margin_m && p.y() > margin_m && p.x() < world.width_m() - margin_m &&
         p.y() < world.length_m() - margin_m;
}

}  // namespace

HeightGrid grid_of(const ElevationRaster& raster) {
  HeightGrid grid;
  grid.lattice = {raster.width, raster.height, raster.resolution_m, 0.0, 0.0};
  for (float z : raster.z_m) {
    grid.z_m.push_back(std::isfinite(z) ? z : 0.0f);
    grid.weight.push_back(std::isfinite(z) ? 1.0f : 0.0f);
  }
  return grid;
}

MapDistortion::MapDistortion(const WorldConfig& config, const ElevationRaster& dtm, std::uint64_t seed,
                             double resolution_m)
    : east_(shift_of(config, dtm, seed, resolution_m, 0.0)),
      north_(shift_of(config, dtm, seed, resolution_m, kPi / 2)) {}

// The map's pixel q shows the ground at q + shift(q).
Eigen::Vector2d MapDistortion::at(const Eigen::Vector2d& p) const {
  const int column = std::clamp(static_cast<int>(p.x() / east_.resolution_m), 0, east_.width - 1);
  const int row = std::clamp(static_cast<int>(p.y() / east_.resolution_m), 0, east_.height - 1);
  return p - Eigen::Vector2d(east_.at(column, row), north_.at(column, row));
}

// Least-squares rigid transform in 2-D.
Eigen::Isometry2d MapDistortion::rigid(const std::vector<Eigen::Vector2d>& ground) const {
  Eigen::Vector2d from = Eigen::Vector2d::Zero(), to = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : ground) {
    from += p / static_cast<double>(ground.size());
    to += at(p) / static_cast<double>(ground.size());
  }
  double along = 0.0, across = 0.0;
  for (const Eigen::Vector2d& p : ground) {
    const Eigen::Vector2d a = p - from, b = at(p) - to;
    along += a.dot(b);
    across += a.x() * b.y() - a.y() * b.x();
  }
  Eigen::Isometry2d T = Eigen::Isometry2d::Identity();
  T.translate(to).rotate(Eigen::Rotation2Dd(std::atan2(across, along))).translate(-from);
  return T;
}

std::vector<Line> drivable_lines(const World& world, double length_m, int count, std::uint64_t seed) {
  HashStream random(seed);
  std::vector<Line> lines;
  for (int tries = 0; tries < 100'000 && static_cast<int>(lines.size()) < count; ++tries) {
    Line line;
    line.start = {random.range(0.0, world.width_m()), random.range(0.0, world.length_m())};
    line.heading_rad = random.range(-kPi, kPi);
    if (!within(world, line.start, 45.0) || !within(world, line.at(length_m), 45.0)) continue;
    if (steepest(world, line, length_m) <= to_rad(15.0)) lines.push_back(line);
  }
  return lines;
}

}  // namespace rover::global::test
