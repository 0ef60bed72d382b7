#include "global_localization/orbital_map_file.hpp"

#include <algorithm>
#include <cmath>

#include "rover_simulator/world/dtm_reader.hpp"

namespace rover::global {
namespace {

constexpr double kFinestM = 0.1, kCoarsestM = 5.0;  // of a pixel; degrees are far below

}  // namespace

HeightGrid load_orbital_map(const std::string& run_dir) {
  if (run_dir.empty()) throw DtmError("no run folder, so no orbital map");
  const std::string file = run_dir + "/orbital_map.tif";
  const ElevationRaster raster = read_elevation(file, Voids::kAsNaN);
  if (!(raster.resolution_m >= kFinestM && raster.resolution_m <= kCoarsestM))
    throw DtmError(file + ": orbital map's pixels are not of 0.1 to 5 metres");
  HeightGrid grid;
  grid.lattice = {raster.width, raster.height, raster.resolution_m, 0.0, 0.0};
  for (float z : raster.z_m) {
    grid.z_m.push_back(std::isfinite(z) ? z : 0.0f);
    grid.weight.push_back(std::isfinite(z) ? 1.0f : 0.0f);
  }
  if (*std::max_element(grid.weight.begin(), grid.weight.end()) == 0.0f)
    throw DtmError(file + ": orbital map has no heights, all of its pixels are no-data");
  return grid;
}

}  // namespace rover::global
