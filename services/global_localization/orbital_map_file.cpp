#include "global_localization/orbital_map_file.hpp"

#include <cmath>
#include <filesystem>
#include <memory>

#include "common/geo/elevation_map.hpp"
#include "common/geo/elevation_map_file.hpp"

namespace rover::global {
namespace {

constexpr double kFinestM = 0.1, kCoarsestM = 5.0;  // pixel size

HeightGrid read(const ElevationMapFile& file, const Lattice& whole, const CellRange& range) {
  const ElevationRaster raster = file.read(
      {range.first_column, range.first_row, range.end_column - range.first_column, range.end_row - range.first_row});
  HeightGrid grid;
  grid.lattice = {raster.width, raster.height, whole.cell_m, whole.x0_m + range.first_column * whole.cell_m,
                  whole.y0_m + range.first_row * whole.cell_m};
  for (float z : raster.z_m) {
    grid.z_m.push_back(std::isfinite(z) ? z : 0.0f);
    grid.weight.push_back(std::isfinite(z) ? 1.0f : 0.0f);
  }
  return grid;
}

// `west_m`, `south_m`: the map frame's origin in the file's projection.
OrbitalMap map_of(const std::shared_ptr<const ElevationMapFile>& file, const std::string& name, double west_m,
                  double south_m) {
  const ElevationRaster& frame = file->frame();
  if (!(frame.resolution_m >= kFinestM && frame.resolution_m <= kCoarsestM))
    throw DtmError(name + ": orbital pixels must be 0.1 to 5 m wide; resample with gdalwarp -tr");
  const Lattice whole{frame.width, frame.height, frame.resolution_m, frame.west_m - west_m, frame.south_m - south_m};
  return {whole, [file, whole](const CellRange& range) { return read(*file, whole, range); }};
}

}  // namespace

OrbitalMap open_orbital_map(const std::string& run_dir) {
  if (run_dir.empty()) throw DtmError("no run folder, so no orbital map");
  const std::string name = run_dir + "/orbital_map.tif";
  const auto file = std::make_shared<const ElevationMapFile>(name);
  return map_of(file, name, file->frame().west_m, file->frame().south_m);
}

std::optional<OrbitalMap> open_orbital_picture(const std::string& run_dir) {
  const std::string name = run_dir + "/orbital_picture.tif";
  if (!std::filesystem::exists(name)) return std::nullopt;
  const ElevationMapFile map(run_dir + "/orbital_map.tif");
  const auto file = std::make_shared<const ElevationMapFile>(name, RasterKind::kPicture);
  return map_of(file, name, map.frame().west_m, map.frame().south_m);
}

}  // namespace rover::global
