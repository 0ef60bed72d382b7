// User maps and paths in ./rover run and ./rover drive: converted to metres in the run folder, or refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "common/bus/config.hpp"
#include "common/geo/elevation_map.hpp"
#include "test/common/temp_folder.hpp"
#include "test/geo/map_files.hpp"
#include "tools/launcher/drive_folder.hpp"
#include "tools/launcher/run_folder.hpp"
#include "wild.hpp"

namespace rover {
namespace {

namespace fs = std::filesystem;
using testing_support::MapFile;

constexpr double kDegree = 180.0 / (3.141592653589793 * testing_support::kMarsRadiusM);

double hills(double x, double y) {
  return 2000.0 + 0.03 * x + 0.5 * std::sin(y / 12.0);
}

class UsersMaps : public testing::Test {
 protected:
  UsersMaps() {
    MapFile degrees;
    degrees.reference = testing_support::kMars;
    degrees.transform = {137.0, kDegree, 0.0, 2.0, 0.0, -kDegree};
    testing_support::write(folder_.file("degrees.tif"), degrees, hills);
    MapFile mercator;
    mercator.reference = "EPSG:3857";
    mercator.transform = {-1.17e7, 1.305, 0.0, 4.8655e6, 0.0, -1.305};
    mercator.unit = "ft";
    testing_support::write(folder_.file("mercator.tif"), mercator, hills);
    testing_support::write(folder_.file("void.tif"), MapFile{},
                           [](int x, int y) { return x < 20 ? -9999.0 : hills(x, y); });
    MapFile globe;
    globe.reference = testing_support::kMars;
    globe.transform = {-180.0, 6.0, 0.0, 83.0, 0.0, -3.0};
    testing_support::write(folder_.file("globe.tif"), globe, hills);
  }

  DriveArguments drive_with(const std::string& map) const {
    DriveArguments arguments;
    arguments.source_dir = ROVER_SOURCE_DIR;
    arguments.ground = ROVER_SOURCE_DIR "/examples/driver/ground.yaml";
    arguments.map = folder_.file(map);
    arguments.out = folder_.file("out");
    return arguments;
  }

  RunArguments run_with(const std::string& map, const std::string& x_m = "10, 40",
                        const std::string& y_m = "20, 20") const {
    std::ofstream(folder_.file("scenario.yaml"))
        << "world: {dtm: " << map << ", rock_area_k: 0}\npath: {x_m: [" << x_m << "], y_m: [" << y_m << "]}\n";
    RunArguments arguments;
    arguments.source_dir = ROVER_SOURCE_DIR;
    arguments.scenario = folder_.file("scenario.yaml");
    arguments.out = folder_.file("out");
    return arguments;
  }

  // One line; no folder remains.
  template <class Make>
  std::string refusal(Make&& make) const {
    std::string line;
    try {
      make();
      ADD_FAILURE() << "accepted";
    } catch (const std::runtime_error& error) {
      line = error.what();
    }
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    EXPECT_FALSE(fs::exists(folder_.file("out")));
    return folder_.short_names(line);
  }

  testing_support::TempFolder folder_;
};

TEST_F(UsersMaps, DriveWritesTheMapInMetres) {
  for (const char* name : {"degrees.tif", "mercator.tif"}) {
    const RunFolder run = make_drive_folder(drive_with(name));
    const ElevationMap given = read_elevation_map(run.dir + "/orbital_map.tif");
    EXPECT_FALSE(given.converted);
    EXPECT_NEAR(given.raster.resolution_m, 1.0, 0.01) << name;
    EXPECT_EQ(given.raster.z_m, read_elevation_map(folder_.file(name)).raster.z_m);
    ASSERT_EQ(run.map_notes.size(), 1u) << name;
    wild_row("Maps: projections and units", std::string("drive --map ") + name,
             "copied as it is: degrees, or Mercator's metres and feet, as metres",
             folder_.short_names(run.map_notes[0]));
    remove_run_folder(run);
  }
}

TEST_F(UsersMaps, DrivePlacesThePictureOnTheMap) {
  MapFile picture;
  picture.type = GDT_Byte;
  picture.bands = 3;
  testing_support::write(folder_.file("map.tif"), MapFile{}, hills);
  testing_support::write(folder_.file("picture.tif"), picture, [](int x, int y) { return 20.0 + x + y; });
  DriveArguments arguments = drive_with("map.tif");
  arguments.picture = folder_.file("picture.tif");
  const RunFolder run = make_drive_folder(arguments);
  const ElevationRaster map = read_elevation_map(run.dir + "/orbital_map.tif").raster;
  const ElevationRaster placed = read_elevation_map(run.dir + "/orbital_picture.tif").raster;
  EXPECT_EQ(placed.west_m, map.west_m);
  EXPECT_NEAR(placed.at(10, 10), 20.0 + 10.0 + 39.0, 0.5);
  remove_run_folder(run);
  arguments.picture = folder_.file("no.tif");
  EXPECT_EQ(refusal([&] { make_drive_folder(arguments); }), "--picture no.tif: not found");
}

// 6,500 x 6,500 pixels of 0 m that take no space.
TEST_F(UsersMaps, DriveRefersToALargeMap) {
  GDALAllRegister();
  CPLStringList options;
  options.SetNameValue("SPARSE_OK", "TRUE");
  const auto large = [&](const std::string& name, const std::string& reference, double pixel) {
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    const std::unique_ptr<GDALDataset> dataset(
        driver->Create(folder_.file(name).c_str(), 6500, 6500, 1, GDT_Float32, options.List()));
    double transform[6] = {0.0, pixel, 0.0, 6500 * pixel, 0.0, -pixel};
    dataset->SetGeoTransform(transform);
    dataset->SetProjection(reference.c_str());
  };
  large("large.tif", testing_support::mars_plane(), 0.25);
  large("degrees.tif", testing_support::kMars, 1e-5);
  const RunFolder run = make_drive_folder(drive_with("large.tif"));
  EXPECT_EQ(fs::read_symlink(run.dir + "/orbital_map.tif"), fs::canonical(folder_.file("large.tif")));
  ASSERT_EQ(run.map_notes.size(), 1u);
  EXPECT_NE(run.map_notes[0].find("not copied"), std::string::npos) << run.map_notes[0];
  remove_run_folder(run);
  EXPECT_TRUE(fs::exists(folder_.file("large.tif")));
  const std::string line = refusal([&] { make_drive_folder(drive_with("degrees.tif")); });
  EXPECT_NE(line.find("--map degrees.tif: is not in metres, north up"), std::string::npos) << line;
}

TEST_F(UsersMaps, RunAcceptsTheSameMaps) {
  for (const char* name : {"degrees.tif", "mercator.tif"}) {
    const RunFolder run = make_run_folder(run_with(name));
    EXPECT_NEAR(read_elevation_map(run.dir + "/orbital_map.tif").raster.resolution_m, 1.0, 0.01) << name;
    ASSERT_EQ(run.map_notes.size(), 1u) << name;
    wild_row("Maps: projections and units", std::string("run with world.dtm: ") + name, "taken as metres",
             folder_.short_names(run.map_notes[0]));
    remove_run_folder(run);
  }
}

TEST_F(UsersMaps, VoidsAreRefused) {
  const std::string by_drive = refusal([&] { make_drive_folder(drive_with("void.tif")); });
  const std::string by_run = refusal([&] { make_run_folder(run_with("void.tif")); });
  for (const std::string& line : {by_drive, by_run}) {
    EXPECT_NE(line.find("void.tif: 1000 of its 3000 heights are no data (1000 undeclared in the file), the first at x "
                        "1.0, y 1.0 m"),
              std::string::npos)
        << line;
    wild_row("Maps: voids", "run, drive --map: undeclared -9999 in the west", "ground at -9999 m", line);
  }
}

TEST_F(UsersMaps, GlobeIsRefusedWithTheUsersFileName) {
  for (const std::string& line : {refusal([&] { make_drive_folder(drive_with("globe.tif")); }),
                                  refusal([&] { make_run_folder(run_with("globe.tif")); })}) {
    EXPECT_NE(line.find("globe.tif: too wide"), std::string::npos) << line;
    EXPECT_NE(line.find("60 x 50 pixels"), std::string::npos) << line;
  }
}

TEST_F(UsersMaps, PathWithoutLengthIsRefused) {
  struct Case {
    const char* x_m;
    const char* y_m;
    const char* says;
    const char* before;
  };
  const Case cases[] = {
      {"10, 10", "20, 20", "points 1 and 2 are the same", "refused"},
      {"10, 10, 40", "20, 20, 20", "points 1 and 2 are the same", "refused"},
      {"10", "20", "at least two points", "refused"},
      {"10, 10.05", "20, 20", "path is shorter than 0.1 m", "the rover stood in STANDBY until the timeout"}};
  for (const Case& c : cases) {
    const std::string line = refusal([&] { make_run_folder(run_with("degrees.tif", c.x_m, c.y_m)); });
    EXPECT_NE(line.find("scenario.yaml"), std::string::npos) << line;
    EXPECT_NE(line.find(c.says), std::string::npos) << line;
    wild_row("Goals", std::string("run: path x [") + c.x_m + "], y [" + c.y_m + "]", c.before, line);
  }
}

}  // namespace
}  // namespace rover
