#include "common/geo/elevation_map.hpp"

#include <fmt/format.h>
#include <gdal_utils.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "common/geo/gdal_session.hpp"
#include "common/geo/open_map.hpp"
#include "common/geo/undeclared_voids.hpp"

namespace rover {
namespace {

using Dataset = std::unique_ptr<GDALDataset>;

std::int64_t pixels_of(const OpenMap& map) {
  return static_cast<std::int64_t>(map.dataset->GetRasterXSize()) * map.dataset->GetRasterYSize();
}

void check_size(const OpenMap& map, const TargetGrid& grid) {
  if (std::max(pixels_of(map), grid.width * grid.height) > kMaxPixelsInMemory)
    throw DtmError(
        fmt::format("{}: too large ({}); cut out a part of up to {} million pixels (gdal_translate -projwin)", map.file,
                    map.placement.size(), kMaxPixelsInMemory / 1'000'000));
}

ElevationRaster whole(const HeightBand& band) {
  return band.read(band.all());
}

bool has_values(const ElevationRaster& raster) {
  return std::any_of(raster.z_m.begin(), raster.z_m.end(), [](float value) { return std::isfinite(value); });
}

void remove_voids(const Placement& placement, const std::string& file, ElevationMap& map) {
  const UndeclaredVoids found = remove_undeclared_voids(map.raster, placement.pixel_m());
  if (!found.problem.empty()) throw DtmError(file + ": " + found.problem);
  for (const auto& plateau : found.plateaus)
    map.notes.push_back(
        fmt::format("{}: {} pixels of exactly {} m are treated as no data (undeclared; declare them with "
                    "gdal_edit.py -a_nodata)",
                    file, plateau.pixels, plateau.height_m));
  map.undeclared_voids = found.interpolated;
  for (const auto& plateau : found.plateaus) map.undeclared_voids += plateau.pixels;
  if (found.interpolated > 0)
    map.notes.push_back(
        fmt::format("{}: {} pixels beside impossible steps are treated as no data", file, found.interpolated));
  if (!has_values(map.raster)) throw DtmError(file + ": has no heights, all of its pixels are no data");
}

void place(const TargetGrid& grid, ElevationRaster& raster) {
  raster.west_m = grid.west_m;
  raster.south_m = grid.south_m;
  raster.resolution_m = grid.resolution_m;
  raster.projection_wkt = grid.wkt;
}

// GDAL dataset that refers to the raster's memory. Row 0 is the last line of the file.
Dataset in_memory(GDALDataset& file, ElevationRaster& raster) {
  Dataset dataset(
      GetGDALDriverManager()->GetDriverByName("MEM")->Create("", raster.width, raster.height, 0, GDT_Float32, nullptr));
  char pointer[64] = {};
  CPLPrintPointer(pointer, raster.z_m.data(), sizeof pointer - 1);
  CPLStringList options;
  options.SetNameValue("DATAPOINTER", pointer);
  double t[6] = {};
  file.GetGeoTransform(t);
  double turned[6] = {t[0] + t[2] * raster.height, t[1], -t[2], t[3] + t[5] * raster.height, t[4], -t[5]};
  if (!dataset || dataset->AddBand(GDT_Float32, options.List()) != CE_None) return nullptr;
  dataset->SetGeoTransform(turned);
  OGRSpatialReference flat = *file.GetSpatialRef();
  flat.StripVertical();
  dataset->SetSpatialRef(&flat);
  dataset->GetRasterBand(1)->SetNoDataValue(std::numeric_limits<double>::quiet_NaN());
  return dataset;
}

Dataset warped(GDALDataset& source, const TargetGrid& grid) {
  const auto text = [](double value) { return fmt::format("{}", value); };
  const double east_m = grid.west_m + grid.resolution_m * static_cast<double>(grid.width);
  const double north_m = grid.south_m + grid.resolution_m * static_cast<double>(grid.height);
  const std::vector<std::string> words = {
      "-of", "MEM", "-t_srs", grid.wkt, "-r", "bilinear", "-ot", "Float32", "-dstnodata", "nan",
      // Accuracy of 0.01 pixels; one thread, for reproducible bytes.
      "-et", "0.01", "-wo", "NUM_THREADS=1", "-te", text(grid.west_m), text(grid.south_m), text(east_m), text(north_m),
      "-ts", std::to_string(grid.width), std::to_string(grid.height)};
  CPLStringList list;
  for (const std::string& word : words) list.AddString(word.c_str());
  GDALWarpAppOptions* options = GDALWarpAppOptionsNew(list.List(), nullptr);
  GDALDatasetH sources[1] = {&source};
  int misused = 0;
  Dataset result(static_cast<GDALDataset*>(GDALWarp("", nullptr, 1, sources, options, &misused)));
  GDALWarpAppOptionsFree(options);
  return result;
}

ElevationRaster reprojected(GDALDataset& file, ElevationRaster raster, const TargetGrid& grid,
                            const std::string& name) {
  const GdalSession gdal;
  const Dataset source = in_memory(file, raster);
  const Dataset target = source ? warped(*source, grid) : nullptr;
  if (!target || gdal.failed()) throw DtmError(name + ": cannot be reprojected to metres" + gdal.last_error());
  ElevationRaster result = whole(HeightBand(*target, name));
  place(grid, result);
  return result;
}

ElevationMap read(const std::string& file) {
  const OpenMap open(file);
  const bool metric = open.placement.is_metric();
  const TargetGrid grid = metric ? open.placement.own_grid() : open.placement.plane_grid();
  check_size(open, grid);
  ElevationMap map;
  map.raster = whole(open.band);
  remove_voids(open.placement, file, map);
  map.converted = !metric || !open.band.is_metres();
  if (metric)
    place(grid, map.raster);
  else
    map.raster = reprojected(*open.dataset, std::move(map.raster), grid, file);
  if (map.converted)
    map.notes.push_back(fmt::format("{}: converted to metres, north up, {:.4g} m per pixel", file, grid.resolution_m));
  return map;
}

ElevationRaster read_over(const std::string& file, const ElevationRaster& map) {
  const OpenMap open(file, RasterKind::kPicture);
  TargetGrid grid{map.projection_wkt, map.west_m, map.south_m, open.placement.pixel_m(), 0, 0};
  grid.width = static_cast<std::int64_t>(map.width_m() / grid.resolution_m);
  grid.height = static_cast<std::int64_t>(map.height_m() / grid.resolution_m);
  check_size(open, grid);
  ElevationRaster picture = reprojected(*open.dataset, whole(open.band), grid, file);
  if (!has_values(picture)) throw DtmError(file + ": shows nothing of the map's ground");
  return picture;
}

}  // namespace

ElevationRaster read_picture(const std::string& file, const ElevationRaster& map) {
  return naming_errors(file, [&] { return read_over(file, map); });
}

ElevationMap read_elevation_map(const std::string& file) {
  return naming_errors(file, [&] { return read(file); });
}

bool is_large_map(const std::string& file, std::int64_t max_pixels) {
  return naming_errors(file, [&] { return pixels_of(OpenMap(file)) > max_pixels; });
}

void require_no_voids(const ElevationMap& map, const std::string& file) {
  const ElevationRaster& raster = map.raster;
  std::int64_t voids = 0;
  size_t first = 0;
  for (size_t i = 0; i < raster.z_m.size(); ++i)
    if (!std::isfinite(raster.z_m[i]) && voids++ == 0) first = i;
  if (voids == 0) return;
  const auto width = static_cast<size_t>(raster.width);
  const auto centre = [&](size_t cell) { return (static_cast<double>(cell) + 0.5) * raster.resolution_m; };
  const std::string undeclared =
      map.undeclared_voids == 0 ? "" : fmt::format(" ({} undeclared in the file)", map.undeclared_voids);
  throw DtmError(
      fmt::format("{}: {} of its {} heights are no data{}, the first at x {:.1f}, y {:.1f} m; cut out a part "
                  "without (gdal_translate -projwin) or fill them (gdal_fillnodata.py)",
                  file, voids, raster.z_m.size(), undeclared, centre(first % width), centre(first / width)));
}

}  // namespace rover
