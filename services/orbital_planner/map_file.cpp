#include "orbital_planner/map_file.hpp"

#include <gdal_utils.h>
#include <ogr_spatialref.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <vector>

#include "common/core/frames.hpp"
#include "rover_simulator/world/dtm_reader.hpp"
#include "rover_simulator/world/gdal_session.hpp"

namespace rover::orbital {
namespace {

using Dataset = std::unique_ptr<GDALDataset>;

constexpr std::int64_t kMostCells = 40'000'000;  // planning takes about 60 bytes for each
constexpr double kMostScaleError = 0.01;         // of the projection's metres against those on the ground

std::string text_of(const OGRSpatialReference& reference) {
  char* text = nullptr;
  reference.exportToWkt(&text);
  const std::string wkt = text == nullptr ? "" : text;
  CPLFree(text);
  return wkt;
}

// With longitude first, whatever order the authority prescribes.
OGRSpatialReference reference_from(const std::string& wkt) {
  OGRSpatialReference reference;
  reference.importFromWkt(wkt.c_str());
  reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return reference;
}

std::unique_ptr<OGRSpatialReference> geographic_of(const OGRSpatialReference& reference) {
  std::unique_ptr<OGRSpatialReference> geographic(reference.CloneGeogCS());
  if (geographic) geographic->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return geographic;
}

// None where GDAL knows no way between the two.
std::unique_ptr<OGRCoordinateTransformation> transformation(const OGRSpatialReference& from,
                                                            const OGRSpatialReference& to) {
  return std::unique_ptr<OGRCoordinateTransformation>(OGRCreateCoordinateTransformation(&from, &to));
}

Eigen::Vector2d transformed(OGRCoordinateTransformation& transformation, Eigen::Vector2d p) {
  int ok = 0;
  if (!transformation.Transform(1, &p.x(), &p.y(), nullptr, &ok) || !ok || !p.allFinite()) return {kNaN, kNaN};
  return p;
}

Dataset open_map(const std::string& file, const GdalSession& gdal) {
  if (!std::filesystem::is_regular_file(file)) throw DtmError(file + ": orbital map not found");
  Dataset dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
  if (!dataset || dataset->GetRasterCount() < 1) throw DtmError(file + ": not a readable map" + gdal.last_error());
  return dataset;
}

struct Placement {
  std::array<double, 6> transform{};
  OGRSpatialReference reference;

  Eigen::Vector2d at(double column, double row) const {
    return {transform[0] + transform[1] * column + transform[2] * row,
            transform[3] + transform[4] * column + transform[5] * row};
  }
};

Placement placement_of(GDALDataset& dataset, const std::string& file) {
  Placement placement;
  const std::string wkt = dataset.GetProjectionRef();
  if (wkt.empty() || dataset.GetGeoTransform(placement.transform.data()) != CE_None)
    throw DtmError(file + ": orbital map has no georeference");
  placement.reference = reference_from(wkt);
  if (!placement.reference.IsProjected() && !placement.reference.IsGeographic())
    throw DtmError(file + ": orbital map has a georeference, but none on a planet");
  return placement;
}

// Longitude and latitude of a pixel.
Eigen::Vector2d lon_lat_of(const Placement& placement, double column, double row, const std::string& file) {
  Eigen::Vector2d p = placement.at(column, row);
  const auto geographic = geographic_of(placement.reference);
  const auto way = geographic ? transformation(placement.reference, *geographic) : nullptr;
  if (way) p = transformed(*way, p);
  if (!way || !p.allFinite())
    throw DtmError(file + ": orbital map's projection does not lead to longitude and latitude");
  return p;
}

// A plane projection that is true about the middle.
OGRSpatialReference local_reference(const Placement& placement, const Eigen::Vector2d& middle) {
  OGRSpatialReference local;
  local.SetProjCS("local stereographic");
  local.CopyGeogCSFrom(&placement.reference);
  local.SetStereographic(middle.y(), middle.x(), 1.0, 0.0, 0.0);
  local.SetLinearUnits(SRS_UL_METER, 1.0);
  local.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return local;
}

// Whether a pixel of the map is a square of its nominal size on the ground, with its sides to the north and east.
bool is_metric(const Placement& placement, GDALDataset& dataset, const std::string& file) {
  const std::array<double, 6>& t = placement.transform;
  if (!placement.reference.IsProjected() || std::abs(placement.reference.GetLinearUnits() - 1.0) > 1e-9) return false;
  if (t[2] != 0.0 || t[4] != 0.0 || t[1] <= 0.0 || std::abs(t[1] + t[5]) > 1e-6 * t[1]) return false;
  const double column = 0.5 * dataset.GetRasterXSize(), row = 0.5 * dataset.GetRasterYSize();
  const Eigen::Vector2d middle = lon_lat_of(placement, column, row, file);
  const OGRSpatialReference local = local_reference(placement, middle);
  const auto way = transformation(placement.reference, local);
  if (!way) return false;
  const Eigen::Vector2d here = transformed(*way, placement.at(column, row));
  const double east = (transformed(*way, placement.at(column + 1.0, row)) - here).norm() / t[1];
  const double north = (transformed(*way, placement.at(column, row - 1.0)) - here).norm() / t[1];
  return std::abs(east - 1.0) < kMostScaleError && std::abs(north - 1.0) < kMostScaleError;
}

bool has_scaled_heights(GDALDataset& dataset) {
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  return band.GetScale() != 1.0 || band.GetOffset() != 0.0;
}

std::vector<char*> arguments(const std::vector<std::string>& words) {
  std::vector<char*> list;
  for (const std::string& word : words) list.push_back(const_cast<char*>(word.c_str()));
  list.push_back(nullptr);
  return list;
}

// The first band with its heights in metres, as a virtual copy.
Dataset unscaled(GDALDataset& dataset) {
  const std::vector<std::string> words = {"-of", "VRT", "-b", "1", "-unscale", "-ot", "Float32"};
  GDALTranslateOptions* options = GDALTranslateOptionsNew(arguments(words).data(), nullptr);
  Dataset copy(static_cast<GDALDataset*>(GDALTranslate("", &dataset, options, nullptr)));
  GDALTranslateOptionsFree(options);
  return copy;
}

Dataset warped(GDALDataset& source, const std::string& copy_file, const std::string& wkt) {
  const std::vector<std::string> words = {"-of", "GTiff",   "-t_srs", wkt,       "-r",         "bilinear",
                                          "-ot", "Float32", "-wt",    "Float32", "-dstnodata", "nan"};
  GDALWarpAppOptions* options = GDALWarpAppOptionsNew(arguments(words).data(), nullptr);
  GDALDatasetH sources[1] = {&source};
  int misused = 0;
  Dataset copy(static_cast<GDALDataset*>(GDALWarp(copy_file.c_str(), nullptr, 1, sources, options, &misused)));
  GDALWarpAppOptionsFree(options);
  return copy;
}

void write_copy(GDALDataset& dataset, const Placement& placement, const std::string& file, const std::string& copy_file,
                const GdalSession& gdal) {
  const Eigen::Vector2d middle =
      lon_lat_of(placement, 0.5 * dataset.GetRasterXSize(), 0.5 * dataset.GetRasterYSize(), file);
  const Dataset heights = unscaled(dataset);
  if (!heights) throw DtmError(file + ": orbital map cannot be read" + gdal.last_error());
  Dataset copy = warped(*heights, copy_file, text_of(local_reference(placement, middle)));
  if (copy) copy->FlushCache();
  if (!copy || gdal.failed()) throw DtmError(file + ": orbital map cannot be reprojected" + gdal.last_error());
}

void check_size(std::int64_t columns, std::int64_t rows, const std::string& file) {
  if (columns * rows > kMostCells)
    throw DtmError(file + ": orbital map of " + std::to_string(columns) + " x " + std::to_string(rows) +
                   " pixels is too large to plan on; cut out a part of up to " +
                   std::to_string(kMostCells / 1'000'000) + " million pixels (gdal_translate -projwin)");
}

void check_heights(const ElevationRaster& raster, const std::string& file) {
  for (float z : raster.z_m)
    if (std::isfinite(z)) return;
  throw DtmError(file + ": orbital map has no heights, all of its pixels are no-data");
}

}  // namespace

OrbitalMap read_map(const std::string& file, const std::string& copy_file) {
  OrbitalMap map;
  {
    const GdalSession gdal;
    const Dataset dataset = open_map(file, gdal);
    check_size(dataset->GetRasterXSize(), dataset->GetRasterYSize(), file);
    const Placement placement = placement_of(*dataset, file);
    map.reprojected = has_scaled_heights(*dataset) || !is_metric(placement, *dataset, file);
    if (map.reprojected) write_copy(*dataset, placement, file, copy_file, gdal);
  }
  map.raster = read_elevation(map.reprojected ? copy_file : file, Voids::kAsNaN);
  check_size(map.raster.width, map.raster.height, file);
  check_heights(map.raster, file);
  return map;
}

struct Geography::Transforms {
  std::unique_ptr<OGRCoordinateTransformation> to_lon_lat, to_projection;
};

Geography::Geography(const ElevationRaster& raster)
    : transforms_(std::make_unique<Transforms>()), corner_m_(raster.west_m, raster.south_m) {
  const GdalSession gdal;
  const OGRSpatialReference projection = reference_from(raster.projection_wkt);
  const auto geographic = geographic_of(projection);
  if (geographic) {
    transforms_->to_lon_lat = transformation(projection, *geographic);
    transforms_->to_projection = transformation(*geographic, projection);
  }
  if (!transforms_->to_lon_lat || !transforms_->to_projection)
    throw DtmError("orbital map's projection does not lead to longitude and latitude" + gdal.last_error());
}

Geography::~Geography() = default;

Eigen::Vector2d Geography::to_map(const Eigen::Vector2d& lon_lat_deg) const {
  const GdalSession gdal;
  return transformed(*transforms_->to_projection, lon_lat_deg) - corner_m_;
}

Eigen::Vector2d Geography::to_lon_lat(const Eigen::Vector2d& map_m) const {
  const GdalSession gdal;
  return transformed(*transforms_->to_lon_lat, map_m + corner_m_);
}

}  // namespace rover::orbital
