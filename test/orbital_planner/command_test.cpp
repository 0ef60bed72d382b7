// ./rover plan as a whole: what it writes, what it says to bad input, and the scenario that was made with it.
#include "orbital_planner/command.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <fstream>
#include <lcm/lcm-cpp.hpp>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "common/bus/channels.hpp"
#include "common/bus/config.hpp"
#include "orbital_planner/map_file.hpp"
#include "orbital_planner/picture.hpp"
#include "path_planner/convert.hpp"
#include "rover_simulator/world/dtm_reader.hpp"
#include "rover_simulator/world/geotiff_writer.hpp"
#include "rover_simulator/world/scenario.hpp"
#include "test/common/temp_folder.hpp"

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

  // The written section, as a scenario reads it.
  PlannedPath written_path() const {
    std::ofstream(folder_.file("scenario.yaml")) << "world: {dtm: " << kGale << "}\n"
                                                 << text_of(folder_.file("out/path.yaml"));
    return load_scenario(folder_.file("scenario.yaml")).path;
  }

  // Status and stderr of the program.
  std::pair<int, std::string> execute(const std::string& words) const {
    const std::string command = "cd " + kSource + " && " + kProgram + " " + words + " --out " + folder_.file("out") +
                                " >" + folder_.file("stdout") + " 2>" + folder_.file("stderr");
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(folder_.file("stderr"))};
  }
};

TEST_F(PlanCommand, ThePlannerTakesTheMessage) {
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

TEST_F(PlanCommand, GeojsonMessageAndScenarioSayTheSame) {
  run(arguments());
  const nlohmann::json geojson = nlohmann::json::parse(text_of(folder_.file("out/path.geojson")));
  EXPECT_EQ(geojson["type"], "FeatureCollection");
  const PlannedPath planned = written_path();
  const Geography geography(read_elevation(kGale));
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

TEST_F(PlanCommand, LongitudeAndLatitudeGiveTheSamePlan) {
  run(arguments());
  const PlannedPath by_metres = written_path();
  const Geography geography(read_elevation(kGale));
  const auto place = [&](double x, double y) {
    const Eigen::Vector2d p = geography.to_lon_lat({x, y});
    std::ostringstream text;
    text.precision(12);
    text << p.x() << "," << p.y();
    return text.str();
  };
  Arguments by_degrees = arguments(place(60.5, 270.5), place(120.5, 60.5));
  by_degrees.lon_lat = true;
  run(by_degrees);
  const PlannedPath same = written_path();
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
    // The legend alone has less than 300 pixels of it.
    EXPECT_GT(cv::countNonZero(mask), 600) << static_cast<int>(level);
  }
}

TEST_F(PlanCommand, TheSameCommandWritesTheSameBytes) {
  run(arguments());
  std::vector<std::string> first;
  for (const char* name : {"path.geojson", "path.yaml", "path.lcm", "path.png", "terrain.tif"})
    first.push_back(text_of(folder_.file(std::string("out/") + name)));
  run(arguments());
  size_t i = 0;
  for (const char* name : {"path.geojson", "path.yaml", "path.lcm", "path.png", "terrain.tif"}) {
    EXPECT_FALSE(first[i].empty());
    EXPECT_EQ(text_of(folder_.file(std::string("out/") + name)), first[i++]) << name;
  }
}

// config/scenarios/combined_500.yaml says in its head how its path was made.
TEST_F(PlanCommand, TheScenarioCombined500IsWhatThePlannerGives) {
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
  // Rocks are as dense as on hard ground where the path wants Full.
  for (size_t i = 0; i + 1 < scenario.path.x_m.size(); ++i) {
    const std::vector<RockZone>& zones = scenario.world.rocks.zones;
    const bool dense = std::any_of(zones.begin(), zones.end(), [&](const RockZone& zone) {
      return zone.contains(scenario.path.x_m[i], scenario.path.y_m[i]);
    });
    EXPECT_TRUE(dense || scenario.path.level[i] == 0) << i;
  }
}

TEST_F(PlanCommand, BadInputEndsWithStatus2AndOneLine) {
  ElevationRaster raster = read_elevation(kGale);
  for (int y = 0; y < raster.height; ++y) raster.at(100, y) = std::numeric_limits<float>::quiet_NaN();
  write_geotiff(folder_.file("split.tif"), raster);
  raster.projection_wkt.clear();
  write_geotiff(folder_.file("nowhere.tif"), raster);
  std::ofstream(folder_.file("cut.tif"), std::ios::binary) << text_of(kGale).substr(0, 90000);
  const std::pair<std::string, std::string> cases[] = {
      {folder_.file("none.tif") + " --start 60,270 --goal 120,60", "none.tif: orbital map not found"},
      {folder_.file("cut.tif") + " --start 60,270 --goal 120,60", "cut.tif: "},
      {folder_.file("nowhere.tif") + " --start 60,270 --goal 120,60", "nowhere.tif: orbital map has no georeference"},
      {kGale + " --start -3,270 --goal 120,60", "--start -3,270: lies outside of the map"},
      {kGale + " --start 60,270 --goal 400,60", "--goal 400,60: lies outside of the map"},
      {folder_.file("split.tif") + " --start 100.5,270 --goal 120,60",
       "--start 100.5,270: lies where the map has no data"},
      {folder_.file("split.tif") + " --start 60,270 --goal 200,270", "--goal 200,270: cannot be reached"},
      {kGale + " --start 60,270 --via 180,300 --goal 120,60", "--via 180,300: lies 1.0 m from an obstacle"},
      {kGale + " --start 60:270 --goal 120,60", "--start '60:270': two numbers"},
      {kGale + " --start nan,270 --goal 120,60", "--start 'nan,270': two numbers"},
      {kGale + " --start 137.4,-4.6 --goal 120,600 --lonlat", "--goal 120,600: no longitude and latitude"},
      {kGale + " --start 60,270 --goal 120,60 --config " + folder_.file("none"), "none/orbital_planner.yaml"},
  };
  for (const auto& [words, expected] : cases) {
    const auto [status, line] = execute(words);
    EXPECT_EQ(status, 2) << words;
    EXPECT_NE(line.find(expected), std::string::npos) << line;
    EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1) << line;
  }
  EXPECT_EQ(execute(kGale).first, 2);
  const auto [status, errors] = execute(kGale + " --start 60,270 --goal 120,60");
  EXPECT_EQ(status, 0) << errors;
  EXPECT_EQ(errors, "");
}

TEST_F(PlanCommand, AWrongConfigurationIsNamed) {
  const std::string good = text_of(kSource + "/config/orbital_planner.yaml");
  const auto complaint = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    std::ofstream(folder_.file("orbital_planner.yaml")) << text.replace(at, from.size(), to);
    Arguments wrong = arguments();
    wrong.config_dir = folder_.path();
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
  EXPECT_NE(complaint("efficient_below: 0.40", "efficient_below: 0.70").find("efficient_below"), std::string::npos);
  EXPECT_NE(complaint("risk_distance_m: 6.0", "risk_distance_m: 1.0").find("risk_distance_m"), std::string::npos);
  EXPECT_NE(complaint("steep_deg: 10.0", "steep_deg: 20.0").find("steep_deg"), std::string::npos);
}

}  // namespace
}  // namespace rover::orbital
