#include "global_localization/orbital_map_file.hpp"

#include <cmath>

#include "common/geo/elevation_map.hpp"

namespace rover::global {
namespace {

constexpr double kFinestM = 0.1, kCoarsestM = 5.0;  // pixel size

}  // namespace

HeightGrid load_orbital_map(const std::string& run_dir) {
  if (run_dir.empty()) throw DtmError("no run folder, so no orbital map");
  const std::string file = run_dir + "/orbital_map.tif";
  const ElevationRaster raster = read_elevation_map(file).raster;
  if (!(raster.resolution_m >= kFinestM && raster.resolution_m <= kCoarsestM))
    throw DtmError(file + ": orbital pixels must be 0.1 to 5 m wide; resample with gdalwarp -tr");
  HeightGrid grid;
  grid.lattice = {raster.width, raster.height, raster.resolution_m, 0.0, 0.0};
  for (float z : raster.z_m) {
    grid.z_m.push_back(std::isfinite(z) ? z : 0.0f);
    grid.weight.push_back(std::isfinite(z) ? 1.0f : 0.0f);
  }
  return grid;
}

}  // namespace rover::global
