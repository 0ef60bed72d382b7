#include "global_localization/orbital_map_file.hpp"

#include <cmath>
#include <memory>

#include "common/geo/elevation_map.hpp"
#include "common/geo/elevation_map_file.hpp"

namespace rover::global {
namespace {

constexpr double kFinestM = 0.1, kCoarsestM = 5.0;  // pixel size

HeightGrid read(const ElevationMapFile& file, const CellRange& range) {
  const ElevationRaster raster = file.read(
      {range.first_column, range.first_row, range.end_column - range.first_column, range.end_row - range.first_row});
  HeightGrid grid;
  grid.lattice = {raster.width, raster.height, raster.resolution_m, range.first_column * raster.resolution_m,
                  range.first_row * raster.resolution_m};
  for (float z : raster.z_m) {
    grid.z_m.push_back(std::isfinite(z) ? z : 0.0f);
    grid.weight.push_back(std::isfinite(z) ? 1.0f : 0.0f);
  }
  return grid;
}

}  // namespace

OrbitalMap open_orbital_map(const std::string& run_dir) {
  if (run_dir.empty()) throw DtmError("no run folder, so no orbital map");
  const std::string name = run_dir + "/orbital_map.tif";
  const auto file = std::make_shared<const ElevationMapFile>(name);
  const ElevationRaster& frame = file->frame();
  if (!(frame.resolution_m >= kFinestM && frame.resolution_m <= kCoarsestM))
    throw DtmError(name + ": orbital pixels must be 0.1 to 5 m wide; resample with gdalwarp -tr");
  return {{frame.width, frame.height, frame.resolution_m, 0.0, 0.0},
          [file](const CellRange& range) { return read(*file, range); }};
}

}  // namespace rover::global
