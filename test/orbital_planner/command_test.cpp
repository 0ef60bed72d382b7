// ./rover plan: output files, reaction to bad input, and the scenario made with it.
#include "tools/orbital_planner/command.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <lcm/lcm-cpp.hpp>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <random>
#include <sstream>

#include "common/bus/channels.hpp"
#include "common/bus/config.hpp"
#include "common/geo/elevation_map.hpp"
#include "common/geo/geography.hpp"
#include "common/geo/geotiff_writer.hpp"
#include "path_planner/convert.hpp"
#include "rover_simulator/world/scenario.hpp"
#include "test/common/temp_folder.hpp"
#include "test/geo/map_files.hpp"
#include "tools/orbital_planner/picture.hpp"
#include "tools/orbital_planner/planning_map.hpp"
#include "wild.hpp"

namespace rover::orbital {
namespace {

const std::string kSource = ROVER_SOURCE_DIR;
const std::string kGale = kSource + "/config/terrain/gale/gale_hirise_dtm_1m_348x337.tif";
const std::string kProgram = std::string(ROVER_BINARY_DIR) + "/bin/rover_orbital_planner";

std::string text_of(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::string yaml_path_of(const std::string& scenario_text) {
  const size_t from = scenario_text.find("path:\n");
  const size_t to = scenario_text.find("\nsun:", from);
  return scenario_text.substr(from, to + 1 - from);
}

TEST(PlanningMap, StripsGiveTheTerrainOfTheWhole) {
  for (const int n : {1, 2, 3}) {
    const ElevationRaster whole = read_elevation_map(kGale).raster;
    const TerrainLayers expected = analyse(whole, {}, n);
    const PlanningMap strips = read_planning_map(kGale, {}, {0, expected.width * expected.height + 500});
    EXPECT_EQ(strips.map.raster.width, expected.width);
    EXPECT_DOUBLE_EQ(strips.map.raster.resolution_m, n * whole.resolution_m);
    ASSERT_EQ(strips.terrain.terrain_class, expected.terrain_class);
    for (size_t i = 0; i < expected.terrain_class.size(); ++i) {
      if (expected.terrain_class[i] == TerrainClass::kUnknown) continue;
      ASSERT_EQ(strips.terrain.slope_rad[i], expected.slope_rad[i]) << i;
      ASSERT_EQ(strips.terrain.step_m[i], expected.step_m[i]) << i;
    }
    ASSERT_EQ(strips.map.notes.size(), 1u);
  }
}

class PlanCommand : public testing::Test {
 protected:
  testing_support::TempFolder folder_;

  Arguments arguments(const std::string& start = "60.5,270.5", const std::string& goal = "120.5,60.5") const {
    Arguments arguments;
    arguments.map = kGale;
    arguments.start = start;
    arguments.goal = goal;
    arguments.out = folder_.file("out");
    arguments.config_dir = kSource + "/config";
    return arguments;
  }

  // The written section, parsed as a scenario.
  PlannedPath written_path(const std::string& out = "out", const std::string& map = kGale) const {
    std::ofstream(folder_.file("scenario.yaml")) << "world: {dtm: '" << map << "'}\n"
                                                 << text_of(folder_.file(out + "/path.yaml"));
    return load_scenario(folder_.file("scenario.yaml")).path;
  }

  // Exit status and stderr of the program, run in the test's folder.
  std::pair<int, std::string> execute(const std::string& words, const std::string& out = "out") const {
    const std::string command =
        "cd " + folder_.path().string() + " && " + kProgram + " " + words + " --out " + out + " >stdout 2>stderr";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(folder_.file("stderr"))};
  }

  // Expects exit status 2, one error line, and no output folder.
  std::string refusal(const std::string& words, const std::string& says, const std::string& out = "out") const {
    const auto [status, line] = execute(words, out);
    EXPECT_EQ(status, 2) << words;
    EXPECT_NE(line.find(says), std::string::npos) << line;
    EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1) << line;
    EXPECT_FALSE(std::filesystem::exists(folder_.file("out"))) << words;
    return folder_.short_names(line.substr(0, line.size() - 1));
  }
};

TEST_F(PlanCommand, PathPlannerAcceptsTheMessage) {
  run(arguments());
  lcm::LogFile log(folder_.file("out/path.lcm"), "r");
  ASSERT_TRUE(log.good());
  const lcm::LogEvent* event = log.readNextEvent();
  ASSERT_NE(event, nullptr);
  EXPECT_EQ(event->channel, channel::kGlobalPath);
  path_t message{};
  ASSERT_GT(message.decode(event->data, 0, event->datalen), 0);
  planning::GlobalPath path;
  EXPECT_EQ(planning::global_path_from(message, path), "");
  EXPECT_EQ(message.kind, path_t::GLOBAL + 0);
  EXPECT_EQ(message.x_m.front(), 60.5);
  EXPECT_EQ(message.y_m.back(), 60.5);
  EXPECT_EQ(message.corridor_half_width_m, 1.5);
  EXPECT_TRUE(std::count(message.level.begin(), message.level.end(), path_t::FULL + 0) > 0);
  EXPECT_TRUE(std::count(message.level.begin(), message.level.end(), path_t::EFFICIENT + 0) > 0);
  EXPECT_EQ(log.readNextEvent(), nullptr);
}

TEST_F(PlanCommand, GeojsonMessageAndScenarioAgree) {
  run(arguments());
  const nlohmann::json geojson = nlohmann::json::parse(text_of(folder_.file("out/path.geojson")));
  EXPECT_EQ(geojson["type"], "FeatureCollection");
  const PlannedPath planned = written_path();
  const Geography geography(read_elevation_map(kGale).raster);
  size_t at = 0, points = 0;
  for (const nlohmann::json& feature : geojson["features"]) {
    if (feature["geometry"]["type"] == "Point") {
      ++points;
      continue;
    }
    const auto& lon_lat = feature["geometry"]["coordinates"];
    for (size_t i = 0; i < lon_lat.size(); ++i) {
      const size_t k = at + i;
      const Eigen::Vector2d on_map =
          geography.to_map(Eigen::Vector2d(lon_lat[i][0].get<double>(), lon_lat[i][1].get<double>()));
      EXPECT_NEAR(on_map.x(), planned.x_m[k], 1e-3);
      EXPECT_NEAR(on_map.y(), planned.y_m[k], 1e-3);
      if (i + 1 == lon_lat.size()) continue;
      EXPECT_EQ(planned.level[k], feature["properties"]["level"] == "FULL" ? 1 : 0) << k;
    }
    at += lon_lat.size() - 1;
  }
  EXPECT_EQ(at + 1, planned.x_m.size());
  EXPECT_EQ(points, 2u);
}

TEST_F(PlanCommand, ZonesAreAvoidedAndGoIntoEveryFile) {
  Arguments without = arguments();
  without.out = folder_.file("free");
  run(without);
  const PlannedPath free = written_path("free");
  const size_t middle = free.x_m.size() / 2;
  const double x = free.x_m[middle], y = free.y_m[middle];
  std::ofstream(folder_.file("zones.geojson")) << fmt::format(
      R"({{"type": "FeatureCollection", "features": [
          {{"type": "Feature", "properties": {{"name": "dune \"A\""}},
            "geometry": {{"type": "Polygon", "coordinates": [[[{0}, {2}], [{1}, {2}], [{1}, {3}], [{0}, {3}], [{0}, {2}]]]}}}}]}})",
      x - 10.0, x + 10.0, y - 10.0, y + 10.0);
  Arguments with_zone = arguments();
  with_zone.zones = folder_.file("zones.geojson");
  with_zone.out = folder_.file("around");
  run(with_zone);
  const PlannedPath around = written_path("around");
  for (size_t i = 0; i < around.x_m.size(); ++i)
    EXPECT_GT(std::max(std::abs(around.x_m[i] - x), std::abs(around.y_m[i] - y)), 10.0 + 2.0) << i;
  const Scenario scenario = load_scenario(folder_.file("scenario.yaml"));
  ASSERT_EQ(scenario.zones.size(), 1u);
  EXPECT_EQ(scenario.zones[0].name, "dune \"A\"");
  EXPECT_NEAR(scenario.zones[0].points[2].x(), x + 10.0, 1e-3);
  EXPECT_EQ(scenario.zones[0].points.size(), 4u);
  lcm::LogFile log(folder_.file("around/path.lcm"), "r");
  path_t message{};
  const lcm::LogEvent* event = log.readNextEvent();
  ASSERT_GT(message.decode(event->data, 0, event->datalen), 0);
  ASSERT_EQ(message.zone_count, 1);
  EXPECT_EQ(message.zones[0].kind, zone_t::KEEP_OUT + 0);
  planning::GlobalPath path;
  EXPECT_EQ(planning::global_path_from(message, path), "");
  const nlohmann::json geojson = nlohmann::json::parse(text_of(folder_.file("around/path.geojson")));
  EXPECT_EQ(geojson["features"].back()["geometry"]["type"], "Polygon");
  EXPECT_EQ(geojson["features"].back()["properties"]["kind"], "keep_out");
  refusal(kGale + fmt::format(" --start 60.5,270.5 --goal {:.3f},{:.3f} --zones {}", x, y, with_zone.zones),
          "lies in keep-out 'dune \"A\"'", "out2");
}

TEST_F(PlanCommand, LongitudeAndLatitudeGiveTheSamePlan) {
  run(arguments());
  const PlannedPath by_metres = written_path();
  const Geography geography(read_elevation_map(kGale).raster);
  const auto place = [&](double x, double y) {
    const Eigen::Vector2d p = geography.to_lon_lat({x, y});
    std::ostringstream text;
    text.precision(12);
    text << p.x() << "," << p.y();
    return text.str();
  };
  Arguments by_degrees = arguments(place(60.5, 270.5), place(120.5, 60.5));
  by_degrees.lon_lat = true;
  by_degrees.out = folder_.file("again");
  run(by_degrees);
  const PlannedPath same = written_path("again");
  ASSERT_EQ(same.x_m.size(), by_metres.x_m.size());
  EXPECT_EQ(same.level, by_metres.level);
  for (size_t i = 0; i < same.x_m.size(); ++i) {
    EXPECT_NEAR(same.x_m[i], by_metres.x_m[i], 1e-3);
    EXPECT_NEAR(same.y_m[i], by_metres.y_m[i], 1e-3);
  }
}

TEST_F(PlanCommand, ThePictureShowsBothLevels) {
  run(arguments());
  const cv::Mat picture = cv::imread(folder_.file("out/path.png"));
  ASSERT_FALSE(picture.empty());
  for (Level level : {Level::kEfficient, Level::kFull}) {
    cv::Mat mask;
    cv::inRange(picture, colour_of(level), colour_of(level), mask);
    // The legend alone has less than 300 pixels of this colour.
    EXPECT_GT(cv::countNonZero(mask), 600) << static_cast<int>(level);
  }
}

TEST_F(PlanCommand, TheSameCommandWritesTheSameBytes) {
  Arguments again = arguments();
  again.out = folder_.file("again");
  run(arguments());
  run(again);
  for (const char* name : {"path.geojson", "path.yaml", "path.lcm", "path.png", "terrain.tif"}) {
    EXPECT_FALSE(text_of(folder_.file(std::string("out/") + name)).empty());
    EXPECT_EQ(text_of(folder_.file(std::string("out/") + name)), text_of(folder_.file(std::string("again/") + name)))
        << name;
  }
}

// The header of config/scenarios/combined_500.yaml holds the command that made its path.
TEST_F(PlanCommand, ScenarioCombined500MatchesPlannerOutput) {
  const std::string file = kSource + "/config/scenarios/combined_500.yaml";
  Arguments made = arguments("284,158", "236,31");
  made.via = {"150,225", "152,180"};
  run(made);
  EXPECT_EQ(text_of(folder_.file("out/path.yaml")), yaml_path_of(text_of(file)));
  const Scenario scenario = load_scenario(file);
  EXPECT_NEAR(scenario.path_length_m(), 500.0, 2.0);
  const long full = std::count(scenario.path.level.begin(), scenario.path.level.end(), 1);
  EXPECT_GT(full, 80);
  EXPECT_LT(full, 200);
  // Full segments have the rock density of hard ground.
  for (size_t i = 0; i + 1 < scenario.path.x_m.size(); ++i) {
    const std::vector<RockZone>& zones = scenario.world.rocks.zones;
    const bool dense = std::any_of(zones.begin(), zones.end(), [&](const RockZone& zone) {
      return zone.contains(scenario.path.x_m[i], scenario.path.y_m[i]);
    });
    EXPECT_TRUE(dense || scenario.path.level[i] == 0) << i;
  }
}

TEST_F(PlanCommand, BadInputPrintsOneLineAndExits2) {
  ElevationRaster raster = read_elevation_map(kGale).raster;
  for (int y = 0; y < raster.height; ++y) raster.at(100, y) = std::numeric_limits<float>::quiet_NaN();
  write_geotiff(folder_.file("split.tif"), raster);
  raster.projection_wkt.clear();
  write_geotiff(folder_.file("nowhere.tif"), raster);
  std::ofstream(folder_.file("cut.tif"), std::ios::binary) << text_of(kGale).substr(0, 90000);
  const std::pair<std::string, std::string> cases[] = {
      {folder_.file("none.tif") + " --start 60,270 --goal 120,60", "none.tif: not found"},
      {folder_.file("cut.tif") + " --start 60,270 --goal 120,60", "cut.tif: "},
      {folder_.file("nowhere.tif") + " --start 60,270 --goal 120,60", "nowhere.tif: has no georeference"},
      {kGale + " --start -3,270 --goal 120,60", "--start -3,270: lies outside of the map"},
      {kGale + " --start 60,270 --goal 400,60", "--goal 400,60: lies outside of the map"},
      {folder_.file("split.tif") + " --start 100.5,270 --goal 120,60", "--start 100.5,270: has no map data"},
      {folder_.file("split.tif") + " --start 60,270 --goal 200,270", "--goal 200,270: cannot be reached"},
      {kGale + " --start 60,270 --via 180,300 --goal 120,60", "--via 180,300: lies 1.0 m from an obstacle"},
      {kGale + " --start 60:270 --goal 120,60", "--start '60:270': two numbers"},
      {kGale + " --start nan,270 --goal 120,60", "--start 'nan,270': two numbers"},
      {kGale + " --start 137.4,-4.6 --goal 120,600 --lonlat", "--goal 120,600: no longitude and latitude"},
      {kGale + " --start 60,270 --goal 120,60 --config " + folder_.file("none"), "none/orbital_planner.yaml"},
      {kGale + " --start 60,270 --goal 120,60 --zones " + folder_.file("none"), "none: "},
      {kGale + " --start 60,270 --goal 120,60 --zones " + kGale, "tif: no GeoJSON with polygons"},
  };
  for (const auto& [words, expected] : cases) refusal(words, expected);
  EXPECT_EQ(execute(kGale).first, 2);
  const auto [status, errors] = execute(kGale + " --start 60,270 --goal 120,60");
  EXPECT_EQ(status, 0) << errors;
  EXPECT_EQ(errors, "");
}

// A hilly map whose western 50 m are void, with each encoding of voids.
struct VoidCase {
  const char* name;
  GDALDataType type;
  double scale;
  double value;  // of void cells in the file
  std::optional<double> no_data;
};

TEST_F(PlanCommand, PathNeverCrossesVoidCells) {
  const VoidCase cases[] = {
      {"no-data as float64, voids as float32", GDT_Float32, 1.0, -3.4028234663852886e38, -3.4028234663852886e38},
      {"no-data -3.4e38 in decimal", GDT_Float32, 1.0, -3.4028234663852886e38, -3.4e38},
      {"no-data -32768 beside voids that a scale of 0.1 made -3276.8", GDT_Float32, 1.0, -3276.8, -32768.0},
      {"the float maximum of ENVI, undeclared", GDT_Float32, 1.0, std::numeric_limits<float>::max(), std::nullopt},
      {"integers with a scale, -32768 undeclared", GDT_Int16, 0.1, -32768.0, std::nullopt},
      {"-32768, undeclared", GDT_Float32, 1.0, -32768.0, std::nullopt},
      {"-9999, undeclared", GDT_Float32, 1.0, -9999.0, std::nullopt},
      {"0 beside thousands of metres, undeclared (as mosaics are filled, dea-intertidal#159)", GDT_Float32, 1.0, 0.0,
       std::nullopt}};
  for (const VoidCase& c : cases) {
    testing_support::MapFile map;
    map.reference = testing_support::mars_plane();
    map.transform = {1000.0, 1.0, 0.0, 5000.0, 0.0, -1.0};
    map.width = 200, map.height = 100;
    map.type = c.type, map.scale = c.scale, map.no_data = c.no_data;
    testing_support::write(folder_.file("west.tif"), map, [&](int x, int y) {
      return x < 50 ? c.value : (2000.0 + 0.03 * x + 2.0 * std::sin(y / 20.0)) / c.scale;
    });
    const std::string line = refusal("west.tif --start 20,50 --goal 170,50", "--start 20,50: has no map data");
    EXPECT_EQ(execute("west.tif --start 70,50 --goal 170,50").first, 0) << c.name;
    std::filesystem::remove_all(folder_.file("out"));
    wild_row("Maps: voids", c.name, "`plan` gave a 150 m EFFICIENT path over nothing, exit status 0", line);
  }
}

TEST_F(PlanCommand, RefusesGoalAtStart) {
  const std::pair<std::string, std::string> cases[] = {
      {"--start 60,270 --goal 60,270", "start = goal"},
      {"--start 60,270 --goal 60.3,270.2", "goal within its tolerance of the start"},
      {"--start 60,270 --via 60,270 --goal 120,60", "two equal neighbours"},
      {"--start 60,270 --via 90,200 --via 90.1,200 --goal 120,60", "two via places side by side"}};
  for (const auto& [words, name] : cases)
    wild_row("Goals", "plan: " + name, "planned, exit status 0 (0.0 m from a point to itself, which `run` refused)",
             refusal(kGale + " " + words, "m from --"));
  // A round trip is a drive.
  EXPECT_EQ(execute(kGale + " --start 60,270 --via 90,268 --goal 60,270").first, 0);
}

TEST_F(PlanCommand, RunAcceptsEveryPlan) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> x(5.0, 340.0), y(5.0, 330.0);
  int planned = 0;
  for (int i = 0; i < 25; ++i) {
    Arguments made = arguments(fmt::format("{:.2f},{:.2f}", x(random), y(random)),
                               fmt::format("{:.2f},{:.2f}", x(random), y(random)));
    made.out = folder_.file(std::to_string(i));
    try {
      run(made);
    } catch (const ConfigError&) {  // too close to an obstacle, or unreachable
      continue;
    }
    ++planned;
    EXPECT_GE(written_path(std::to_string(i)).x_m.size(), 2u);
  }
  EXPECT_GT(planned, 5);
}

TEST_F(PlanCommand, NeverOverwritesFiles) {
  std::filesystem::create_directory(folder_.file("X"));
  const std::string before = "overwrote its own input";
  for (const char* name : {"terrain.tif", "map.tif"}) {
    const std::string input = folder_.file(std::string("X/") + name);
    std::filesystem::copy_file(kGale, input);
    std::filesystem::create_directory_symlink("X", folder_.file("link"));
    for (const char* out : {"X", "X/", "./X/../X", "link"}) {
      const std::string line = refusal("X/" + std::string(name) + " --start 60,270 --goal 120,60", "not empty", out);
      EXPECT_EQ(text_of(input), text_of(kGale));
      wild_row("Outputs", "plan X/" + std::string(name) + " --out " + out, before, line);
    }
    std::filesystem::remove(input);
    std::filesystem::remove(folder_.file("link"));
  }
}

TEST_F(PlanCommand, PathsAreTheUsersAndViaLeavesTheMapAlone) {
  std::filesystem::copy_file(kGale, folder_.file("g.tif"));
  const std::string line =
      execute("--start 60,270 --goal 120,60 --via 96,262 --via 118,255 g.tif --config " + kSource + "/config/").second;
  EXPECT_EQ(line, "");
  EXPECT_TRUE(std::filesystem::exists(folder_.file("out/path.yaml")));
  wild_row("Paths", "plan --via 96,262 g.tif --out out, from the user's folder",
           "g.tif: not found; results in the checkout", "planned; the results are in the user's folder");
}

TEST_F(PlanCommand, AMapOnNoPlanetIsPlannedInMetres) {
  write_geotiff(folder_.file("plane.tif"), plane_raster(60.0, 40.0, 1.0, 0.05, 0.0));
  refusal("plane.tif --lonlat --start 1,1 --goal 2,2", "plane.tif has no planet");
  ASSERT_EQ(execute("plane.tif --start 10,20 --goal 50,20").first, 0);
  const nlohmann::json geojson = nlohmann::json::parse(text_of(folder_.file("out/path.geojson")));
  const auto& coordinates = geojson["features"][0]["geometry"]["coordinates"];
  EXPECT_EQ(coordinates[0][0], 10.0);
  EXPECT_EQ(coordinates[0][1], 20.0);
}

TEST_F(PlanCommand, AReprojectedMapIsGivenToTheRoverWithThePath) {
  const double degree = 180.0 / (3.141592653589793 * testing_support::kMarsRadiusM);
  testing_support::MapFile map;
  map.reference = testing_support::kMars;
  map.transform = {137.0, 2.0 * degree, 0.0, 30.0, 0.0, -2.0 * degree};
  map.width = 100, map.height = 80;
  testing_support::write(folder_.file("degrees.tif"), map, [](int x, int y) { return 0.05 * x + std::sin(y / 9.0); });
  ASSERT_EQ(execute("degrees.tif --start 20,40 --goal 130,100").first, 0);
  EXPECT_NE(text_of(folder_.file("stdout")).find("degrees.tif: converted to metres"), std::string::npos);
  const ElevationMap given = read_elevation_map(folder_.file("out/map.tif"));
  EXPECT_FALSE(given.converted);
  EXPECT_EQ(given.raster.z_m, read_elevation_map(folder_.file("degrees.tif")).raster.z_m);
  // `run` accepts both, in the same frame.
  const PlannedPath path = written_path("out", folder_.file("out/map.tif"));
  EXPECT_EQ(written_path("out", folder_.file("degrees.tif")).x_m, path.x_m);
}

TEST_F(PlanCommand, AWrongConfigurationIsNamed) {
  const std::string shared = text_of(kSource + "/config/navigation.yaml");
  const auto complaint = [&](const std::string& from, const std::string& to,
                             const std::string& name = "orbital_planner") {
    std::ofstream(folder_.file("navigation.yaml")) << shared;
    std::ofstream(folder_.file("orbital_planner.yaml")) << text_of(kSource + "/config/orbital_planner.yaml");
    std::string text = text_of(kSource + "/config/" + name + ".yaml");
    const size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    std::ofstream(folder_.file(name + ".yaml")) << text.replace(at, from.size(), to);
    Arguments wrong = arguments();
    wrong.config_dir = folder_.path();
    wrong.out = folder_.file(std::to_string(std::hash<std::string>{}(to)));
    try {
      run(wrong);
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(complaint("window_m: 5.0", "window_m: 5.0"), "");
  EXPECT_NE(complaint("window_m: 5.0", "windows_m: 5.0").find("terrain.windows_m: unknown key"), std::string::npos);
  EXPECT_NE(complaint("window_m: 5.0", "window_m: .nan").find("terrain.window_m"), std::string::npos);
  EXPECT_NE(complaint("efficient_below: 0.4", "efficient_below: 0.7").find("efficient_below"), std::string::npos);
  EXPECT_NE(complaint("risk_distance_m: 6.0", "risk_distance_m: 1.0").find("risk_distance_m"), std::string::npos);
  EXPECT_NE(complaint("sloping_deg: 5.0", "sloping_deg: 20.0").find("sloping_deg"), std::string::npos);
  EXPECT_NE(complaint("goal_tolerance_m: 0.5", "steep_slope_deg: 20.0", "navigation").find("steep_slope_deg"),
            std::string::npos);
}

}  // namespace
}  // namespace rover::orbital
