#include "report/world_truth.hpp"

#include "rover_simulator/world/dtm_reader.hpp"

namespace rover::report {

std::optional<TrueWorld> load_true_world(const RunFolder& folder, const Box& around) {
  (void)folder;
  (void)around;
  return std::nullopt;
}

HeightRaster load_orbital_map(const RunFolder& folder) {
  if (folder.orbital_map.empty()) return {};
  ElevationRaster raster = read_elevation(folder.orbital_map);
  return {raster.width, raster.height, raster.resolution_m, std::move(raster.z_m)};
}

}  // namespace rover::report
