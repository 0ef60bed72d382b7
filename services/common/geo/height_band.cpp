#include "common/geo/height_band.hpp"

#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "common/core/frames.hpp"
#include "common/geo/elevation_map.hpp"
#include "common/geo/gdal_session.hpp"

namespace rover {
namespace {

constexpr double kMaxHeightM = 1e7;  // more than the radius of any solid body of the solar system

// "USSurveyFoot", "US_survey_foot" and "us survey foot" are equal.
std::string bare(const std::string& text) {
  std::string letters;
  for (const unsigned char c : text)
    if (std::string(" _-.").find(static_cast<char>(c)) == std::string::npos)
      letters += static_cast<char>(std::tolower(c));
  return letters;
}

std::optional<double> metres_of_unit(const std::string& name) {
  using Unit = std::pair<const char*, double>;
  static constexpr double kFoot = 0.3048, kSurveyFoot = 1200.0 / 3937.0;
  static constexpr std::array kUnits = {Unit{"m", 1.0},
                                        Unit{"meter", 1.0},
                                        Unit{"metre", 1.0},
                                        Unit{"mm", 1e-3},
                                        Unit{"millimeter", 1e-3},
                                        Unit{"millimetre", 1e-3},
                                        Unit{"cm", 1e-2},
                                        Unit{"centimeter", 1e-2},
                                        Unit{"centimetre", 1e-2},
                                        Unit{"dm", 0.1},
                                        Unit{"decimeter", 0.1},
                                        Unit{"decimetre", 0.1},
                                        Unit{"km", 1e3},
                                        Unit{"kilometer", 1e3},
                                        Unit{"kilometre", 1e3},
                                        Unit{"ft", kFoot},
                                        Unit{"foot", kFoot},
                                        Unit{"feet", kFoot},
                                        Unit{"internationalfoot", kFoot},
                                        Unit{"usft", kSurveyFoot},
                                        Unit{"ftus", kSurveyFoot},
                                        Unit{"footus", kSurveyFoot},
                                        Unit{"ussurveyfoot", kSurveyFoot},
                                        Unit{"ussurveyfeet", kSurveyFoot},
                                        Unit{"surveyfoot", kSurveyFoot}};
  const std::string wanted = bare(name);
  const auto unit = std::find_if(kUnits.begin(), kUnits.end(), [&](const Unit& u) {
    return wanted == u.first || (wanted.size() > 4 && wanted == std::string(u.first) + "s");
  });
  if (unit == kUnits.end()) return std::nullopt;
  return unit->second;
}

// From the band's unit, else from the vertical axis of the coordinate system. Negative for depths.
double metres_of_height(GDALDataset& dataset, GDALRasterBand& band, const std::string& file) {
  const OGRSpatialReference* reference = dataset.GetSpatialRef();
  const bool has_axis = reference != nullptr && reference->IsCompound() != 0;
  OGRAxisOrientation direction = OAO_Up;
  if (has_axis) reference->GetAxis("VERT_CS", 0, &direction);
  const double up = direction == OAO_Down ? -1.0 : 1.0;
  const std::string name = band.GetUnitType();
  if (name.empty()) return up * (has_axis ? reference->GetTargetLinearUnits("VERT_CS") : 1.0);
  const auto metres = metres_of_unit(name);
  if (!metres)
    throw DtmError(file + ": heights are in '" + name + "', an unknown unit; set another with gdal_edit.py -unit");
  return up * *metres;
}

std::vector<GDALRasterBand*> bands_of(GDALDataset& dataset, bool alpha) {
  std::vector<GDALRasterBand*> bands;
  for (GDALRasterBand* band : dataset.GetBands())
    if ((band->GetColorInterpretation() == GCI_AlphaBand) == alpha) bands.push_back(band);
  return bands;
}

GDALRasterBand* alpha_band(GDALDataset& dataset) {
  const std::vector<GDALRasterBand*> bands = bands_of(dataset, true);
  return bands.empty() ? nullptr : bands.front();
}

std::vector<GDALRasterBand*> data_bands(GDALDataset& dataset, const std::string& file, RasterKind kind) {
  std::vector<GDALRasterBand*> bands = bands_of(dataset, false);
  if (kind == RasterKind::kHeights && bands.size() != 1)
    throw DtmError(file + ": has " + std::to_string(bands.size()) +
                   " bands of data; one height band is expected, extract it with gdal_translate -b NUMBER");
  if (bands.empty()) throw DtmError(file + ": has no picture");
  if (kind == RasterKind::kPicture && bands.front()->GetColorTable() != nullptr)
    throw DtmError(file + ": has a palette; expand it with gdal_translate -expand gray");
  return bands;
}

void require_heights(GDALRasterBand& band, const std::string& file) {
  const GDALColorInterp colour = band.GetColorInterpretation();
  const GDALDataType type = band.GetRasterDataType();
  const bool is_coloured = (colour != GCI_GrayIndex && colour != GCI_Undefined) || band.GetColorTable() != nullptr;
  if (is_coloured || type == GDT_Byte)
    throw DtmError(file + ": is a picture (" + GDALGetDataTypeName(type) + ", " +
                   GDALGetColorInterpretationName(colour) + "); a height map of 16 bits or more is expected");
  if (GDALDataTypeIsComplex(type) != 0) throw DtmError(file + ": has complex values; a height map is expected");
}

template <class T>
std::pair<double, double> limits() {
  constexpr double kNone = -kInfinity;  // 0 is a height for unsigned numbers
  using Limits = std::numeric_limits<T>;
  return {std::is_signed_v<T> ? static_cast<double>(Limits::lowest()) : kNone, static_cast<double>(Limits::max())};
}

std::pair<double, double> limits_of(GDALDataType type) {
  switch (type) {
    case GDT_Int16:
      return limits<std::int16_t>();
    case GDT_UInt16:
      return limits<std::uint16_t>();
    case GDT_Int32:
      return limits<std::int32_t>();
    case GDT_UInt32:
      return limits<std::uint32_t>();
    case GDT_Int64:
      return limits<std::int64_t>();
    case GDT_UInt64:
      return limits<std::uint64_t>();
    default:  // beyond any height
      return limits<double>();
  }
}

CPLErr read_line(GDALRasterBand& band, int column, int line, std::vector<double>& values) {
  const int width = static_cast<int>(values.size());
  return band.RasterIO(GF_Read, column, line, width, 1, values.data(), width, 1, GDT_Float64, 0, 0, nullptr);
}

}  // namespace

HeightBand::HeightBand(GDALDataset& dataset, const std::string& file, RasterKind kind)
    : file_(file), bands_(data_bands(dataset, file, kind)), alpha_(alpha_band(dataset)) {
  if (kind == RasterKind::kPicture) {
    scale_ = 1.0 / static_cast<double>(bands_.size());
    lowest_ = -kInfinity;  // black and white are brightness, too
    highest_ = kInfinity;
    return;
  }
  GDALRasterBand& band = *bands_.front();
  require_heights(band, file);
  const double metres = metres_of_height(dataset, band, file);
  scale_ = band.GetScale() * metres;
  offset_ = band.GetOffset() * metres;
  if (!std::isfinite(scale_) || !std::isfinite(offset_) || scale_ == 0.0)
    throw DtmError(file + ": scale or offset of its heights is invalid");
  std::tie(lowest_, highest_) = limits_of(band.GetRasterDataType());
}

float HeightBand::height_of(double value, bool masked) const {
  const double z_m = scale_ * value + offset_;
  const bool known = !masked && value > lowest_ && value < highest_ && std::abs(z_m) < kMaxHeightM;
  return known ? static_cast<float>(z_m) : std::numeric_limits<float>::quiet_NaN();
}

ElevationRaster HeightBand::read(const PixelBox& box) const {
  const GdalSession gdal;
  ElevationRaster raster;
  raster.width = box.width;
  raster.height = box.height;
  raster.z_m.resize(static_cast<size_t>(raster.width) * raster.height);
  if (raster.z_m.empty()) return raster;
  std::vector<double> values(box.width), more(box.width), valid(box.width, 255.0);
  GDALRasterBand& band = *bands_.front();
  GDALRasterBand* mask = alpha_;
  if (mask == nullptr && (band.GetMaskFlags() & GMF_ALL_VALID) == 0) mask = band.GetMaskBand();
  const int last_line = band.GetYSize() - 1 - box.row;  // GDAL's lines run from the north
  for (int row = box.height - 1; row >= 0; --row) {
    CPLErr error = read_line(band, box.column, last_line - row, values);
    for (size_t k = 1; k < bands_.size() && error == CE_None; ++k) {
      error = read_line(*bands_[k], box.column, last_line - row, more);
      std::transform(values.begin(), values.end(), more.begin(), values.begin(), std::plus<>());
    }
    if (mask != nullptr && error == CE_None) error = read_line(*mask, box.column, last_line - row, valid);
    if (error != CE_None) throw DtmError(file_ + ": truncated or damaged" + gdal.last_error());
    for (int column = 0; column < box.width; ++column)
      raster.at(column, row) = height_of(values[column], valid[column] == 0.0);
  }
  return raster;
}

}  // namespace rover
