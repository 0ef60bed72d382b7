// Compares traversability of SLAM maps from simulated drives with the true terrain:
//   traversability_study [K [SEEDS [LENGTH_M [SHOWN_SHARE]]]]
#include <fmt/format.h>

#include <cstdlib>
#include <string>

#include "common/geo/elevation_map.hpp"
#include "rover_simulator/world/world.hpp"
#include "slam/slam.hpp"
#include "test/slam/study_drive.hpp"
#include "traversability/difficulty.hpp"

namespace rover::trav::study {
namespace {

const std::string kDtm = std::string(ROVER_SOURCE_DIR) + "/config/terrain/gale/gale_hirise_dtm_1m_348x337.tif";
constexpr double kRockM = 0.20;
constexpr double kRimM = 0.25;  // blurred rim of an obstacle

struct Tally {
  long maps = 0, seen = 0, unknown = 0, uncertain = 0, impassable = 0;
  long rock_cells = 0, rock_passable = 0;  // cells higher than kRockM above the ground
  long rocks = 0, rocks_missed = 0;        // from kRockM, at least half seen; missed: all seen cells passable
  long low_rocks = 0, low_rocks_hit = 0;   // 0.08 - 0.12 m; hit: with an impassable cell
  long plain_cells = 0, plain_impassable = 0;
  double sigma_m = 0.0, worst_sigma_m = 0.0, difficulty = 0.0, cost = 0.0;
  long difficulty_known = 0, easy = 0, passable = 0;
};

TerrainGrid grid_of(const slam::OdomElevation& map) {
  return {{map.cells, map.cells, map.cell_m, map.corner.ix * map.cell_m, map.corner.iy * map.cell_m},
          map.height_m,
          map.sigma_m};
}

double rise_m(const World& world, double x, double y) {
  return world.height_m(x, y) - world.ground_height_m(x, y);
}

// Highest rock within `reach_m`.
double highest_m(const World& world, double x, double y, double reach_m) {
  double high = 0.0;
  for (double dy = -reach_m; dy <= reach_m; dy += 0.05)
    for (double dx = -reach_m; dx <= reach_m; dx += 0.05)
      if (std::hypot(dx, dy) <= reach_m) high = std::max(high, rise_m(world, x + dx, y + dy));
  return high;
}

// Calls f for each seen cell within `reach_m`.
template <class F>
void for_each_seen(const TerrainGrid& grid, double x_m, double y_m, double reach_m, F&& f) {
  const int reach = static_cast<int>(reach_m / grid.shape.cell_m) + 1;
  const int cx = static_cast<int>((x_m - grid.shape.origin_x_m) / grid.shape.cell_m);
  const int cy = static_cast<int>((y_m - grid.shape.origin_y_m) / grid.shape.cell_m);
  for (int iy = cy - reach; iy <= cy + reach; ++iy)
    for (int ix = cx - reach; ix <= cx + reach; ++ix) {
      if (!grid.shape.contains(ix, iy) || std::isnan(grid.height_m[grid.shape.at(ix, iy)])) continue;
      if (std::hypot(grid.shape.x_m(ix) - x_m, grid.shape.y_m(iy) - y_m) <= reach_m) f(grid.shape.at(ix, iy));
    }
}

void compare_rocks(const World& world, const TerrainGrid& grid, const TraversabilityMap& map, Tally& tally) {
  const double x0 = grid.shape.origin_x_m, y0 = grid.shape.origin_y_m;
  for (const Rock& rock : world.rocks_in(x0, y0, x0 + 20.0, y0 + 20.0)) {
    const bool low = rock.height_m >= 0.08 && rock.height_m <= 0.12;
    if (rock.height_m < kRockM && !low) continue;
    int cells = 0, passable = 0, impassable = 0;
    for_each_seen(grid, rock.x_m, rock.y_m, 0.4 * rock.diameter_m, [&](std::size_t i) {
      ++cells;
      passable += map.cells[i] < kLow;
      impassable += map.cells[i] >= kLow && map.cells[i] != kUnknown;
    });
    const double whole_cells = kPi * std::pow(0.4 * rock.diameter_m / grid.shape.cell_m, 2);
    if (cells == 0 || cells < 0.5 * whole_cells) continue;
    (low ? tally.low_rocks : tally.rocks) += 1;
    if (low)
      tally.low_rocks_hit += impassable > 0;
    else
      tally.rocks_missed += passable == cells;
  }
}

void compare(const World& world, const TerrainGrid& grid, const TraversabilityMap& map, Tally& tally) {
  for (int iy = 0; iy < grid.shape.cells_y; ++iy)
    for (int ix = 0; ix < grid.shape.cells_x; ++ix) {
      const std::size_t i = grid.shape.at(ix, iy);
      if (std::isnan(grid.height_m[i])) continue;
      const double x = grid.shape.x_m(ix), y = grid.shape.y_m(iy);
      const std::uint8_t cost = map.cells[i];
      ++tally.seen;
      tally.sigma_m += grid.sigma_m[i];
      tally.worst_sigma_m = std::max<double>(tally.worst_sigma_m, grid.sigma_m[i]);
      tally.unknown += cost == kUnknown;
      tally.uncertain += cost == kUnknown && grid.sigma_m[i] <= 0.06F;
      tally.impassable += cost == kImpassable || cost == kLow;
      if (cost < kLow) tally.cost += cost, ++tally.passable;
      if (rise_m(world, x, y) >= kRockM) {
        ++tally.rock_cells;
        tally.rock_passable += cost < kLow;
      } else if (highest_m(world, x, y, kRimM) < 0.08) {
        ++tally.plain_cells;
        tally.plain_impassable += cost == kImpassable || cost == kLow;
      }
    }
}

// Perfect odometry: odom equals the world frame.
void drive(double k, std::uint64_t seed, double length_m, const TraversabilityConfig& config, Tally& tally) {
  const auto stations = slam::study::simulated_drive({.length_m = length_m, .rock_k = k, .seed = seed}, kDtm);
  WorldConfig world_config;
  world_config.rocks.k = k;
  const World world(world_config, read_elevation_map(kDtm).raster, seed);
  slam::Slam slam{slam::SlamConfig{}};
  for (std::size_t i = 0; i < stations.size(); ++i) {
    slam.step(stations[i].cloud, {stations[i].T_map_body, 0.0, 0.0});
    if (i < 16) continue;  // until the map has filled
    const TerrainGrid grid = grid_of(slam.elevation());
    const TraversabilityMap map = compute_traversability(grid, config);
    const double difficulty = difficulty_ahead(map, planar(stations[i].T_map_body), config.ahead);
    ++tally.maps;
    if (!std::isnan(difficulty)) {
      ++tally.difficulty_known;
      tally.difficulty += difficulty;
      tally.easy += difficulty < 0.25;
    }
    if (i % 10 != 0) continue;
    compare(world, grid, map, tally);
    compare_rocks(world, grid, map, tally);
  }
}

void print(double k, const Tally& t) {
  const auto share = [](double part, long whole) {
    return whole > 0 ? 100.0 * part / static_cast<double>(whole) : 0.0;
  };
  fmt::print("k {:.2f}: {} maps, sigma mean {:.4f} worst {:.4f} m\n", k, t.maps, t.sigma_m / double(t.seen),
             t.worst_sigma_m);
  fmt::print(
      "  of the seen cells {:.2f} % unknown ({:.2f} % for an uncertain step or slope), {:.2f} % impassable; mean cost "
      "{:.0f}\n",
      share(double(t.unknown), t.seen), share(double(t.uncertain), t.seen), share(double(t.impassable), t.seen),
      t.cost / double(t.passable));
  fmt::print(
      "  on rocks of {:.2f} m and more {} of {} cells passable ({:.2f} %); on plain ground {} of {} impassable ({:.3f} "
      "%)\n",
      kRockM, t.rock_passable, t.rock_cells, share(double(t.rock_passable), t.rock_cells), t.plain_impassable,
      t.plain_cells, share(double(t.plain_impassable), t.plain_cells));
  fmt::print(
      "  {} of {} rocks of that height passable in all that was seen of them; {} of {} of 0.08 - 0.12 m impassable\n",
      t.rocks_missed, t.rocks, t.low_rocks_hit, t.low_rocks);
  fmt::print("  difficulty ahead {:.3f} on average, easy in {:.0f} % of {} maps, not judged in {}\n",
             t.difficulty / double(t.difficulty_known), share(double(t.easy), t.difficulty_known), t.difficulty_known,
             t.maps - t.difficulty_known);
}

}  // namespace
}  // namespace rover::trav::study

int main(int argc, char** argv) {
  const double k = argc > 1 ? std::atof(argv[1]) : 0.12;
  const int seeds = argc > 2 ? std::atoi(argv[2]) : 2;
  const double length_m = argc > 3 ? std::atof(argv[3]) : 40.0;
  rover::trav::TraversabilityConfig config;
  if (argc > 4) config.step.mean_height_ratio = std::atof(argv[4]);
  rover::trav::study::Tally tally;
  for (int seed = 1; seed <= seeds; ++seed)
    rover::trav::study::drive(k, static_cast<std::uint64_t>(seed), length_m, config, tally);
  rover::trav::study::print(k, tally);
}
