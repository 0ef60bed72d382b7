// Maps in many formats and projections, compared with known heights as a function of longitude and latitude.
#include "common/geo/elevation_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "common/core/frames.hpp"
#include "common/geo/geography.hpp"
#include "common/geo/geotiff_writer.hpp"
#include "common/geo/projections.hpp"
#include "map_files.hpp"
#include "test/common/temp_folder.hpp"
#include "wild.hpp"

namespace rover {
namespace {

namespace fs = std::filesystem;
using testing_support::kGale;
using testing_support::kMars;
using testing_support::kMarsRadiusM;
using testing_support::MapFile;
using testing_support::mars_plane;
using testing_support::write;

constexpr double kEarthRadiusM = 6378137.0;

// Smooth hills about a place on a body.
struct Truth {
  double radius_m = kMarsRadiusM;
  double lon_deg = 137.0;
  double lat_deg = 40.0;

  double height_m(const Eigen::Vector2d& lon_lat_deg) const {
    const double east_m = to_rad(lon_lat_deg.x() - lon_deg) * std::cos(to_rad(lat_deg)) * radius_m;
    const double north_m = to_rad(lon_lat_deg.y() - lat_deg) * radius_m;
    return 300.0 + 0.05 * east_m + 0.11 * north_m + 3.0 * std::sin(east_m / 25.0) + 2.0 * std::cos(north_m / 31.0);
  }
};

// Pixels of this size about the known place; the stored values are the height times `factor`.
struct Sample {
  std::string name;
  Truth truth;
  MapFile map;
  double factor = 1.0;
  std::string before;
};

// Columns run along `along` and lines along `down`, in units of the projection.
Sample sample(const std::string& name, const Truth& truth, const std::string& reference, Eigen::Vector2d along,
              Eigen::Vector2d down, const std::string& before) {
  Sample s{name, truth, {}, 1.0, before};
  s.map.reference = reference;
  OGRSpatialReference system;
  EXPECT_EQ(system.SetFromUserInput(reference.c_str()), OGRERR_NONE);
  system.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const Eigen::Vector2d middle = changed(*change(*geographic_of(system), system), {truth.lon_deg, truth.lat_deg});
  const Eigen::Vector2d corner = middle - 0.5 * s.map.width * along - 0.5 * s.map.height * down;
  s.map.transform = {corner.x(), along.x(), down.x(), corner.y(), along.y(), down.y()};
  return s;
}

class MapFileTest : public testing::Test {
 protected:
  testing_support::TempFolder folder_;

  std::string write_sample(const Sample& s) const {
    const std::string file = folder_.file(s.name + ".tif");
    OGRSpatialReference system;
    system.SetFromUserInput(s.map.reference.c_str());
    system.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const CoordinateChange to_lon_lat = change(system, *geographic_of(system));
    const auto& t = s.map.transform;
    write(file, s.map, [&](double column, double line) {
      const Eigen::Vector2d p(t[0] + t[1] * (column + 0.5) + t[2] * (line + 0.5),
                              t[3] + t[4] * (column + 0.5) + t[5] * (line + 0.5));
      return s.factor * s.truth.height_m(changed(*to_lon_lat, p));
    });
    return file;
  }

  // Checks heights, positions and size. Returns the 95 % quantile of the height error; at the border interpolation is
  // one-sided.
  static double expect_true(const ElevationMap& map, const Truth& truth, const std::string& name, bool whole = true) {
    const ElevationRaster& raster = map.raster;
    const Geography geography(raster);
    EXPECT_TRUE(geography.is_known()) << name;
    std::vector<double> errors_m;
    for (int row = 0; row < raster.height; ++row)
      for (int column = 0; column < raster.width; ++column) {
        const Eigen::Vector2d p(raster.resolution_m * (column + 0.5), raster.resolution_m * (row + 0.5));
        const double error_m = std::abs(raster.at(column, row) - truth.height_m(geography.to_lon_lat(p)));
        EXPECT_TRUE(std::isfinite(error_m) || !whole) << name << " " << column << " " << row;
        if (std::isfinite(error_m)) errors_m.push_back(error_m);
      }
    std::sort(errors_m.begin(), errors_m.end());
    const double p95_m = errors_m[errors_m.size() * 95 / 100];
    EXPECT_LT(p95_m, 0.05) << name;
    EXPECT_LT(errors_m.back(), 0.3) << name;
    const Eigen::Vector2d south = geography.to_lon_lat({0.5 * raster.width_m(), 0.0});
    const Eigen::Vector2d north = geography.to_lon_lat({0.5 * raster.width_m(), raster.height_m()});
    EXPECT_NEAR(to_rad((north - south).y()) * truth.radius_m / raster.height_m(), 1.0, 0.012) << name;
    return p95_m;
  }

  ElevationMap expect_true_file(const Sample& s, bool converted, bool whole = true) const {
    const ElevationMap map = read_elevation_map(write_sample(s));
    EXPECT_EQ(map.converted, converted) << s.name;
    const double p95_m = expect_true(map, s.truth, s.name, whole);
    wild_row("Maps: projections and units", s.name, s.before,
             fmt::format("read as {} x {} pixels of {:.3f} m; 95 % of the heights within {:.2f} m of the truth",
                         map.raster.width, map.raster.height, map.raster.resolution_m, p95_m));
    return map;
  }

  // One line that starts with the file name.
  std::string refusal(const std::string& file) const {
    try {
      read_elevation_map(file);
    } catch (const DtmError& error) {
      const std::string text = error.what();
      EXPECT_EQ(text.rfind(file + ": ", 0), 0u) << text;
      EXPECT_EQ(text.find('\n'), std::string::npos) << text;
      return folder_.short_names(text);
    }
    ADD_FAILURE() << file << " was read";
    return "";
  }

  // The file is refused with one line that contains the remedy.
  void expect_refused(const std::string& what, const std::string& file, const std::string& says,
                      const std::string& before) const {
    const std::string line = refusal(file);
    EXPECT_NE(line.find(says), std::string::npos) << line;
    EXPECT_NE(line.find("; "), std::string::npos) << "what to do? " << line;
    wild_row("Maps: projections and units", what, before, line);
  }
};

const std::string kAsMetres = "`drive --map` and `run` took its units as metres";
const std::string kRefusedBySome = "`plan` warped it to a file, `run` and `drive --map` refused it";

TEST_F(MapFileTest, AMapInMetresIsReadAsItIs) {
  const ElevationMap map = read_elevation_map(kGale);
  EXPECT_FALSE(map.converted);
  EXPECT_TRUE(map.notes.empty());
  EXPECT_EQ(map.raster.width, 348);
  EXPECT_EQ(map.raster.height, 337);
  const Truth moon{1737400.0, 20.0, 88.0};
  const std::string polar =
      "PROJCS[\"Moon south\",GEOGCS[\"Moon\",DATUM[\"D_Moon\",SPHEROID[\"Moon\",1737400,0]],PRIMEM[\"m\",0],"
      "UNIT[\"degree\",0.0174532925199433]],PROJECTION[\"Polar_Stereographic\"],PARAMETER[\"latitude_of_origin\",90],"
      "PARAMETER[\"central_meridian\",20],PARAMETER[\"scale_factor\",1],UNIT[\"metre\",1]]";
  expect_true_file(sample("a polar map of the Moon", moon, polar, {2.0, 0.0}, {0.0, -2.0}, "right"), false);
}

TEST_F(MapFileTest, AnyProjectionIsBroughtToMetres) {
  const double degree = 1.0 / (to_rad(1.0) * kMarsRadiusM);
  const Truth mars;
  expect_true_file(sample("degrees", {kMarsRadiusM, 137.0, 60.0}, kMars, {2.0 * degree, 0.0}, {0.0, -2.0 * degree},
                          "`plan` warped it to a file; `run` took degrees as metres"),
                   true);
  expect_true_file(sample("equidistant, scale not true at 40 deg", mars, mars_plane(0), {2.0, 0.0}, {0.0, -2.0},
                          kAsMetres + ": 0.77 m a pixel eastwards were 1 m"),
                   true);
  expect_true_file(sample("equidistant, scale true at 40 deg", mars, mars_plane(40), {2.0, 0.0}, {0.0, -2.0}, "right"),
                   false);
  expect_true_file(sample("Web Mercator at 40 deg", {kEarthRadiusM, -105.0, 40.0}, "EPSG:3857", {2.6, 0.0}, {0.0, -2.6},
                          kAsMetres + ", 1.31 times too large"),
                   true);
  expect_true_file(
      sample("kilometres", mars, mars_plane(40, "UNIT[\"kilometre\",1000]"), {0.002, 0.0}, {0.0, -0.002}, kAsMetres),
      true);
}

TEST_F(MapFileTest, FeetAreBroughtToMetres) {
  const Truth new_mexico{kEarthRadiusM, -106.25, 35.0};
  Sample feet = sample("State Plane feet, heights in feet by a compound system (gdal#14503)", new_mexico,
                       "EPSG:6529+6360", {6.0, 0.0}, {0.0, -6.0}, kAsMetres + ", heights too");
  feet.factor = 3937.0 / 1200.0;
  expect_true_file(feet, true);
}

TEST_F(MapFileTest, AnyDirectionOfPixelsIsBroughtToNorthUp) {
  const Truth mars;
  const std::string plane = mars_plane(40);
  expect_true_file(sample("south-up, as NetCDF conversions write (jblindsay, whitebox_next_gen#36)", mars, plane,
                          {2.0, 0.0}, {0.0, 2.0}, kRefusedBySome),
                   true);
  expect_true_file(sample("oblong pixels", mars, plane, {3.0, 0.0}, {0.0, -1.5}, kRefusedBySome), true);
  expect_true_file(sample("columns to the north", mars, plane, {0.0, 2.0}, {2.0, 0.0}, kRefusedBySome), true);
  const ElevationMap turned = expect_true_file(
      sample("turned by 30 deg", mars, plane, {1.732, 1.0}, {1.0, -1.732}, kRefusedBySome), true, false);
  EXPECT_TRUE(std::isnan(turned.raster.at(0, 0)));  // outside of the map
  EXPECT_TRUE(std::isfinite(turned.raster.at(turned.raster.width / 2, turned.raster.height / 2)));
}

TEST_F(MapFileTest, PixelIsPointAndPixelIsAreaAreTheSamePlaces) {
  Sample point = sample("pixel is point (hyp3-lib#258)", {}, mars_plane(40), {2.0, 0.0}, {0.0, -2.0}, "right");
  point.map.pixel_is_point = true;
  expect_true_file(point, false);
}

TEST_F(MapFileTest, LatitudeFirstIsNotTakenForLongitude) {
  const double degree = 1.0 / (to_rad(1.0) * kEarthRadiusM);
  const Sample s =
      sample("latitude", {kEarthRadiusM, 8.0, 47.0}, "EPSG:4326", {3.0 * degree, 0.0}, {0.0, -2.0 * degree}, "");
  const std::string file = write_sample(s);
  const auto& t = s.map.transform;
  std::ofstream(folder_.file("first.vrt")) << fmt::format(
      "<VRTDataset rasterXSize=\"{}\" rasterYSize=\"{}\"><SRS dataAxisToSRSAxisMapping=\"1,2\">EPSG:4326"
      "</SRS><GeoTransform>{},0,{},{},{},0</GeoTransform><VRTRasterBand dataType=\"Float32\" band=\"1\">"
      "<SimpleSource><SourceFilename relativeToVRT=\"1\">latitude.tif</SourceFilename>"
      "</SimpleSource></VRTRasterBand></VRTDataset>",
      s.map.width, s.map.height, t[3], t[5], t[0], t[1]);
  const ElevationMap map = read_elevation_map(folder_.file("first.vrt"));
  const double p95_m = expect_true(map, s.truth, "latitude first");
  wild_row("Maps: projections and units", "coordinates with latitude first (a VRT's axis mapping)",
           "right in `plan` alone", fmt::format("right: 95 % of the heights within {:.2f} m of the truth", p95_m));
}

TEST_F(MapFileTest, HeightsAreInMetresWhateverTheirUnit) {
  const std::pair<const char*, double> units[] = {{"m", 1.0},
                                                  {"metre", 1.0},
                                                  {"Meters", 1.0},
                                                  {"ft", 0.3048},
                                                  {"foot", 0.3048},
                                                  {"us-ft", 0.304801},
                                                  {"US survey foot", 0.304801},
                                                  {"US_survey_foot", 0.304801},
                                                  {"km", 1000.0},
                                                  {"cm", 0.01},
                                                  {"mm", 0.001}};
  for (const auto& [unit, metres] : units) {
    const char* before = "taken as metres by `plan`, `run` and `drive --map` (3DEP tiles: uw-cryo/stac-3dep-1m#34)";
    Sample s = sample("heights in " + std::string(unit), {}, mars_plane(40), {2.0, 0.0}, {0.0, -2.0},
                      metres == 1.0 ? "right" : before);
    s.factor = 1.0 / metres;
    s.map.unit = unit;
    expect_true_file(s, metres != 1.0);
  }
  for (const char* unit : {"fathom", "m/s", "DN", "1000 m", "ms"}) {
    Sample s = sample("unit", {}, mars_plane(40), {2.0, 0.0}, {0.0, -2.0}, "");
    s.map.unit = unit;
    expect_refused("heights in '" + std::string(unit) + "'", write_sample(s), std::string("'") + unit + "'",
                   "taken as metres");
  }
}

TEST_F(MapFileTest, ScaleAndOffsetOfIntegersCount) {
  for (const GDALDataType type : {GDT_Int16, GDT_UInt16, GDT_Int32}) {
    Sample s = sample("scaled integers " + std::string(GDALGetDataTypeName(type)), {}, mars_plane(40), {2.0, 0.0},
                      {0.0, -2.0}, "`run` and `drive --map` took the integers as metres");
    s.map.type = type;
    s.map.scale = 0.05;
    s.map.offset = 250.0;
    Sample plain = s;
    plain.map.type = GDT_Float32;
    plain.map.scale = 1.0, plain.map.offset = 0.0;
    const ElevationRaster truth = read_elevation_map(write_sample(plain)).raster;
    const std::string file = folder_.file("scaled.tif");
    write(file, s.map,
          [&](int column, int line) { return std::round((truth.at(column, truth.height - 1 - line) - 250.0) / 0.05); });
    const ElevationMap map = read_elevation_map(file);
    EXPECT_TRUE(map.converted);
    for (size_t i = 0; i < truth.z_m.size(); ++i) EXPECT_NEAR(map.raster.z_m[i], truth.z_m[i], 0.026);
    wild_row("Maps: projections and units", s.name, s.before, "heights within half a step of the integers");
  }
}

TEST_F(MapFileTest, DepthsAreNotHeights) {
  Sample s = sample("depths below the sea", {kEarthRadiusM, -105.0, 35.0}, "EPSG:32613+5715", {2.0, 0.0}, {0.0, -2.0},
                    "taken as heights: hills were hollows");
  s.factor = -1.0;
  expect_true_file(s, true);
}

TEST_F(MapFileTest, ALocalCoordinateSystemIsTakenAsItIs) {
  MapFile map;
  map.reference = "LOCAL_CS[\"site\",UNIT[\"foot\",0.3048]]";
  write(folder_.file("feet.tif"), map, [](int column, int) { return 0.1 * column; });
  const ElevationMap feet = read_elevation_map(folder_.file("feet.tif"));
  EXPECT_NEAR(feet.raster.resolution_m, 2.0 * 0.3048, 1e-12);
  EXPECT_NEAR(feet.raster.west_m, 1000.0 * 0.3048, 1e-9);
  EXPECT_FALSE(Geography(feet.raster).is_known());
  write_geotiff(folder_.file("plane.tif"), plane_raster(40.0, 30.0, 1.0, 0.1, 0.3));
  const ElevationMap plane = read_elevation_map(folder_.file("plane.tif"));
  EXPECT_FALSE(plane.converted);
  EXPECT_EQ(plane.raster.z_m, plane_raster(40.0, 30.0, 1.0, 0.1, 0.3).z_m);
  map.transform = {0.0, 1.0, 0.2, 0.0, 0.2, -1.0};
  write(folder_.file("turned.tif"), map, [](int, int) { return 5.0; });
  expect_refused("a local coordinate system, turned", folder_.file("turned.tif"), "not north-up", "refused");
}

TEST_F(MapFileTest, DeclaredVoidsAreVoidInAnyForm) {
  const double lowest = std::numeric_limits<float>::lowest();
  struct Case {
    const char* name;
    std::optional<double> no_data;
    double value;
    const char* before = "ground: a void was only what equals its tag bit for bit";
  };
  const Case cases[] = {
      {"no-data as the double next to float32's lowest", -3.4028234663852886e38, lowest},
      {"no-data -3.4e38 in decimal, data at the lowest float32 (firelab/windninja#576)", -3.4e38, lowest},
      {"no-data 1.70141e38 of Surfer grids (OSGeo/gdal#2759)", 1.70141000918782799e+38, 1.70141e38},
      {"undeclared -3e38 (dtarb/TauDEM#140)", std::nullopt, -3.0e38},
      {"undeclared float maximum of ENVI", std::nullopt, std::numeric_limits<float>::max()},
      {"no-data NaN", std::nan(""), std::nan(""), "void"},
      {"undeclared infinity", std::nullopt, std::numeric_limits<double>::infinity(), "void"},
      {"declared -9999", -9999.0, -9999.0, "void"}};
  for (const Case& c : cases) {
    MapFile map;
    map.no_data = c.no_data;
    write(folder_.file("void.tif"), map,
          [&](int column, int line) { return column < 20 ? c.value : 300.0 + 0.1 * column + 0.05 * line; });
    const ElevationMap read = read_elevation_map(folder_.file("void.tif"));
    const auto voids =
        std::count_if(read.raster.z_m.begin(), read.raster.z_m.end(), [](float z) { return std::isnan(z); });
    EXPECT_EQ(voids, 20 * 50) << c.name;
    EXPECT_TRUE(read.notes.empty()) << c.name << read.notes.front();
    wild_row("Maps: voids", c.name, c.before, std::to_string(voids) + " of 1000 void pixels are void");
  }
}

TEST_F(MapFileTest, IntegersAtTheLimitOfTheirTypeAreVoid) {
  const std::pair<GDALDataType, double> cases[] = {
      {GDT_Int16, -32768.0}, {GDT_Int16, 32767.0}, {GDT_UInt16, 65535.0}, {GDT_Int32, -2147483648.0}};
  for (const auto& [type, value] : cases) {
    MapFile map;
    map.type = type;
    map.scale = 0.001;  // so that the void has no impossible step
    const double number = value;
    write(folder_.file("limit.tif"), map,
          [&](int column, int line) { return column < 20 ? number : 25000.0 + 20.0 * column + 10.0 * line; });
    const ElevationMap read = read_elevation_map(folder_.file("limit.tif"));
    const auto voids =
        std::count_if(read.raster.z_m.begin(), read.raster.z_m.end(), [](float z) { return std::isnan(z); });
    EXPECT_EQ(voids, 20 * 50) << value;
    wild_row("Maps: voids", fmt::format("undeclared {} in {}, scaled", value, GDALGetDataTypeName(type)), "ground",
             std::to_string(voids) + " of 1000 void pixels are void");
  }
}

TEST_F(MapFileTest, MasksAndAlphaBandsAreVoids) {
  const auto cover = [](GDALRasterBand& mask) {
    std::vector<std::uint8_t> line(60, 255);
    std::fill(line.begin(), line.begin() + 20, std::uint8_t{0});
    for (int y = 0; y < 50; ++y)
      ASSERT_EQ(mask.RasterIO(GF_Write, 0, y, 60, 1, line.data(), 60, 1, GDT_Byte, 0, 0, nullptr), CE_None);
  };
  MapFile masked;
  masked.change = [&](GDALDataset& dataset) {
    ASSERT_EQ(dataset.CreateMaskBand(GMF_PER_DATASET), CE_None);
    cover(*dataset.GetRasterBand(1)->GetMaskBand());
  };
  write(folder_.file("masked.tif"), masked, [](int, int) { return 300.0; });
  MapFile alpha;
  alpha.bands = 2;
  alpha.change = [&](GDALDataset& dataset) {
    dataset.GetRasterBand(2)->SetColorInterpretation(GCI_AlphaBand);
    std::vector<double> line(60, 255.0);
    std::fill(line.begin(), line.begin() + 20, 0.0);
    for (int y = 0; y < 50; ++y)
      ASSERT_EQ(
          dataset.GetRasterBand(2)->RasterIO(GF_Write, 0, y, 60, 1, line.data(), 60, 1, GDT_Float64, 0, 0, nullptr),
          CE_None);
  };
  write(folder_.file("alpha.tif"), alpha, [](int, int) { return 300.0; });
  for (const char* name : {"masked.tif", "alpha.tif"}) {
    const ElevationMap map = read_elevation_map(folder_.file(name));
    EXPECT_TRUE(std::isnan(map.raster.at(19, 10))) << name;
    EXPECT_EQ(map.raster.at(20, 10), 300.0F) << name;
    wild_row("Maps: voids", name, "the mask was not looked at: ground", "void where the mask says so");
  }
}

TEST_F(MapFileTest, WhatIsGuessedToBeVoidIsSaid) {
  MapFile map;
  write(folder_.file("guess.tif"), map,
        [](int column, int line) { return column < 20 ? -9999.0 : 300.0 + 0.1 * column + 0.05 * line; });
  const ElevationMap read = read_elevation_map(folder_.file("guess.tif"));
  ASSERT_EQ(read.notes.size(), 1u);
  EXPECT_NE(read.notes[0].find("1000 pixels of exactly -9999 m"), std::string::npos) << read.notes[0];
  wild_row("Maps: voids", "undeclared -9999", "ground at -9999 m", folder_.short_names(read.notes[0]));
  try {
    require_no_voids(read, "guess.tif");
    ADD_FAILURE();
  } catch (const DtmError& error) {
    EXPECT_NE(
        std::string(error.what())
            .find("1000 of its 3000 heights are no data (1000 undeclared in the file), the first at x 1.0, y 1.0 m"),
        std::string::npos)
        << error.what();
  }
}

TEST_F(MapFileTest, PicturesAndOtherDataAreRefused) {
  MapFile map;
  map.bands = 3;
  const auto level = [](int, int) { return 7.0; };
  write(folder_.file("three.tif"), map, level);
  expect_refused("three bands of data", folder_.file("three.tif"), "3 bands", "the first band was taken");
  map.type = GDT_Byte;
  write(folder_.file("colour.tif"), map, level);
  expect_refused("an RGB orthoimage", folder_.file("colour.tif"), "3 bands", "its red band was taken for heights");
  map.bands = 1;
  write(folder_.file("grey.tif"), map, level);
  expect_refused("an 8-bit picture", folder_.file("grey.tif"), "picture", "its grey values were heights");
  map.type = GDT_CFloat32;
  write(folder_.file("complex.tif"), map, level);
  expect_refused("complex numbers (a radar picture)", folder_.file("complex.tif"), "complex",
                 "its real part was taken");
  map.type = GDT_UInt16;
  write(folder_.file("ortho.tif"), map, [](int x, int y) { return (x * 7919 + y * 104729) % 4000; });
  expect_refused("a 16-bit orthoimage", folder_.file("ortho.tif"), "45 deg", "its grey values were heights");
  map.type = GDT_Byte;
  map.change = [](GDALDataset& dataset) {
    GDALColorTable colours(GPI_RGB);
    const GDALColorEntry red{255, 0, 0, 255};
    colours.SetColorEntry(7, &red);
    dataset.GetRasterBand(1)->SetColorTable(&colours);
  };
  write(folder_.file("palette.tif"), map, level);
  expect_refused("a palette (a land-cover map)", folder_.file("palette.tif"), "picture", "its classes were heights");
}

TEST_F(MapFileTest, APlaceIsDemanded) {
  MapFile map;
  map.reference = "";
  write(folder_.file("nowhere.tif"), map, [](int, int) { return 3.0; });
  expect_refused("no coordinate system", folder_.file("nowhere.tif"), "no georeference", "refused, without what to do");
  std::ofstream(folder_.file("grid.asc")) << "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n4 5 6\n";
  expect_refused("an ASCII grid without .prj", folder_.file("grid.asc"), "no georeference",
                 "refused, without what to do");
  MapFile points;
  points.reference = "";
  points.transform = {};
  points.change = [](GDALDataset& dataset) {
    GDAL_GCP gcps[3] = {};
    for (int i = 0; i < 3; ++i) {
      gcps[i].pszId = gcps[i].pszInfo = const_cast<char*>("");
      gcps[i].dfGCPPixel = i == 1 ? 60.0 : 0.0, gcps[i].dfGCPLine = i == 2 ? 50.0 : 0.0;
      gcps[i].dfGCPX = 10.0 * i, gcps[i].dfGCPY = 5.0 * i * i;
    }
    OGRSpatialReference system;
    system.SetFromUserInput(kMars);
    dataset.SetGCPs(3, gcps, &system);
  };
  write(folder_.file("points.tif"), points, [](int, int) { return 3.0; });
  expect_refused("ground control points alone", folder_.file("points.tif"), "ground control points",
                 "refused, without what to do");
}

TEST_F(MapFileTest, SizeIsJudgedBeforeAnyWork) {
  const auto vrt = [&](const char* name, int width, int height, const std::string& system, const std::string& place) {
    std::ofstream(folder_.file(name)) << "<VRTDataset rasterXSize=\"" << width << "\" rasterYSize=\"" << height
                                      << "\"><SRS>" << system << "</SRS><GeoTransform>" << place
                                      << "</GeoTransform><VRTRasterBand dataType=\"Float32\" band=\"1\"/></VRTDataset>";
    return folder_.file(name);
  };
  expect_refused("3,000 million pixels", vrt("huge.vrt", 60000, 50000, kMars, "137,1e-7,0,-4,0,-1e-7"),
                 "60000 x 50000 pixels", "refused");
  const std::string before = "warped and written (0.4 GB, 16.9 GB) before the size of the copy was refused";
  expect_refused("a near-global map in degrees", vrt("globe.vrt", 8640, 4000, kMars, "-180,0.0416,0,83,0,-0.0416"),
                 "8640 x 4000 pixels", before);
  expect_refused("a near-global map in Mercator", vrt("mercator.vrt", 4000, 4000, "EPSG:3857", "-2e7,1e4,0,2e7,0,-1e4"),
                 "too wide", before);
  expect_refused("a whole globe in degrees", vrt("whole.vrt", 360, 180, kMars, "-180,1,0,90,0,-1"), "too wide", before);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()), 4);
}

TEST_F(MapFileTest, BadFilesAreNamed) {
  EXPECT_NE(refusal(folder_.file("none.tif")).find("not found"), std::string::npos);
  std::ofstream(folder_.file("text.tif")) << "this is no map\n";
  EXPECT_NE(refusal(folder_.file("text.tif")).find("not a readable map"), std::string::npos);
  MapFile empty;
  write(folder_.file("empty.tif"), empty, [](int, int) { return std::nan(""); });
  EXPECT_NE(refusal(folder_.file("empty.tif")).find("no heights"), std::string::npos);
}

// Found by bench fuzz: GDAL repeats the name of a missing part with any characters in it.
TEST_F(MapFileTest, ARefusalIsOneLineWhateverGdalSays) {
  std::ofstream(folder_.file("parts.vrt")) << fmt::format(
      "<VRTDataset rasterXSize=\"8\" rasterYSize=\"6\"><SRS>{}</SRS>"
      "<GeoTransform>0,1,0,6,0,-1</GeoTransform><VRTRasterBand dataType=\"Float32\" band=\"1\"><SimpleSource>"
      "<SourceFilename>a&#13;b&#10;{}.tif</SourceFilename><SourceBand>1</SourceBand>"
      "<SourceProperties RasterXSize=\"8\" RasterYSize=\"6\" DataType=\"Float32\" BlockXSize=\"8\" BlockYSize=\"6\"/>"
      "</SimpleSource></VRTRasterBand></VRTDataset>",
      mars_plane(), std::string(3000, 'c'));
  const std::string said = refusal(folder_.file("parts.vrt"));
  EXPECT_NE(said.find("truncated or damaged"), std::string::npos) << said;
  EXPECT_LT(said.size(), 1000u);
  EXPECT_TRUE(std::none_of(said.begin(), said.end(), [](unsigned char c) { return std::iscntrl(c) != 0; })) << said;
}

TEST_F(MapFileTest, CutFilesAreNoticed) {
  MapFile degrees;
  degrees.reference = kMars;
  degrees.transform = {137.0, 1e-5, 0.0, -4.0, 0.0, -1e-5};
  degrees.width = degrees.height = 400;
  write(folder_.file("degrees.tif"), degrees, [](int column, int line) { return 0.1 * column + 0.2 * line; });
  for (const std::string& whole : {kGale, folder_.file("degrees.tif")})
    for (double share : {0.01, 0.3, 0.9}) {
      fs::copy_file(whole, folder_.file("cut.tif"), fs::copy_options::overwrite_existing);
      fs::permissions(folder_.file("cut.tif"), fs::perms::owner_all);
      fs::resize_file(folder_.file("cut.tif"),
                      static_cast<std::uintmax_t>(share * static_cast<double>(fs::file_size(whole))));
      refusal(folder_.file("cut.tif"));
    }
}

TEST_F(MapFileTest, TheSameFileIsTheSameRasterEachTime) {
  const double degree = 1.0 / (to_rad(1.0) * kMarsRadiusM);
  const std::string file = write_sample(sample("degrees", {}, kMars, {2.0 * degree, 0.0}, {0.0, -2.0 * degree}, ""));
  const ElevationRaster first = read_elevation_map(file).raster, again = read_elevation_map(file).raster;
  EXPECT_EQ(first.z_m, again.z_m);
  // A converted and written map is read without conversion.
  write_geotiff(folder_.file("map.tif"), first);
  const ElevationMap written = read_elevation_map(folder_.file("map.tif"));
  EXPECT_FALSE(written.converted);
  EXPECT_EQ(written.raster.z_m, first.z_m);
}

TEST_F(MapFileTest, LongitudeAndLatitudeLeadThereAndBack) {
  const double degree = 1.0 / (to_rad(1.0) * kMarsRadiusM);
  const std::string file = write_sample(
      sample("degrees", {kMarsRadiusM, -137.0, 60.0}, kMars, {4.0 * degree, 0.0}, {0.0, -4.0 * degree}, ""));
  for (const std::string& name : {kGale, file}) {
    const ElevationRaster raster = read_elevation_map(name).raster;
    const Geography geography(raster);
    for (double u : {0.0, 0.3, 1.0})
      for (double v : {0.0, 0.6, 1.0}) {
        const Eigen::Vector2d p(u * raster.width_m(), v * raster.height_m());
        EXPECT_LT((geography.to_map(geography.to_lon_lat(p)) - p).norm(), 1e-4);
      }
  }
}

TEST_F(MapFileTest, LongitudeAndLatitudeAreThoseOfTheMap) {
  // Gale crater lies at 137.4 deg east, 4.6 deg south.
  const Geography geography(read_elevation_map(kGale).raster);
  const Eigen::Vector2d corner = geography.to_lon_lat({0.0, 0.0});
  EXPECT_NEAR(corner.x(), 137.4, 0.2);
  EXPECT_NEAR(corner.y(), -4.6, 0.2);
  EXPECT_FALSE(geography.to_map({kNaN, 4.0}).allFinite());
  EXPECT_FALSE(geography.to_map({10.0, 400.0}).allFinite());
}

}  // namespace
}  // namespace rover
