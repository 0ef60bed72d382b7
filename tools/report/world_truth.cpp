#include "tools/report/world_truth.hpp"

#include <cstdio>
#include <memory>

#include "common/geo/elevation_map.hpp"
#include "common/geo/elevation_map_file.hpp"
#include "rover_simulator/world/scenario.hpp"

namespace rover::report {
namespace {

TrueWorld true_world(const RunFolder& folder, const Box& around) {
  const Scenario scenario = load_scenario(folder.scenario);
  const auto world =
      std::make_shared<const World>(scenario.world, scenario.dtm, static_cast<std::uint64_t>(*folder.info.seed));
  TrueWorld truth;
  for (const rover::Rock& rock : world->rocks_in(around.x0_m, around.y0_m, around.x1_m, around.y1_m))
    truth.rocks.push_back({rock.x_m, rock.y_m, 0.5 * rock.diameter_m, rock.height_m});
  truth.height_m = [world](double x_m, double y_m) { return world->height_m(x_m, y_m); };
  truth.ground_m = [world](double x_m, double y_m) { return world->ground_height_m(x_m, y_m); };
  truth.width_m = world->width_m();
  truth.length_m = world->length_m();
  truth.goal_tolerance_m = scenario.path.goal_tolerance_m;
  truth.corridor_half_width_m = scenario.path.corridor_half_width_m;
  return truth;
}

}  // namespace

std::optional<TrueWorld> load_true_world(const RunFolder& folder, const Box& around) {
  if (folder.scenario.empty() || !folder.info.seed) {
    std::fprintf(stderr, "%s: no scenario or no seed: rocks are not evaluated\n", folder.dir.c_str());
    return std::nullopt;
  }
  try {
    return true_world(folder, around);
  } catch (const std::runtime_error& error) {
    std::fprintf(stderr, "%s: rocks are not evaluated\n", error.what());
    return std::nullopt;
  }
}

HeightRaster load_orbital_map(const RunFolder& folder) {
  if (folder.orbital_map.empty()) return {};
  try {
    ElevationRaster raster = read_for_display(folder.orbital_map);
    return {raster.width, raster.height, raster.resolution_m, std::move(raster.z_m)};
  } catch (const DtmError& error) {
    std::fprintf(stderr, "%s: the map has no hill shading\n", error.what());
    return {};
  }
}

}  // namespace rover::report
