#include "tools/campaign/campaign_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "common/bus/config.hpp"
#include "common/bus/yaml_file.hpp"
#include "rover_simulator/world/scenario.hpp"
#include "tools/campaign/folder.hpp"
#include "tools/campaign/job.hpp"
#include "tools/campaign/variant.hpp"

namespace rover::campaign {
namespace {

namespace fs = std::filesystem;
const std::string kConfig = ROVER_SOURCE_DIR "/config";

class CampaignFileTest : public testing::Test {
 protected:
  CampaignFileTest() {
    std::string name = "/tmp/campaign-file-XXXXXX";
    dir_ = mkdtemp(name.data());
  }
  ~CampaignFileTest() override { fs::remove_all(dir_); }

  std::string write(const std::string& text) const {
    std::ofstream(dir_ + "/c.yaml") << text;
    return dir_ + "/c.yaml";
  }
  CampaignFile load(const std::string& text) const { return load_campaign(write(text), kConfig); }
  // The error without the folder.
  std::string error_of(const std::string& text) const try {
    load(text);
    return "none";
  } catch (const ConfigError& error) {
    return std::string(error.what()).substr(dir_.size() + 1);
  }

  const std::string head_ = "scenario: " + kConfig + "/scenarios/enav.yaml\nseeds: 1..3\n";
  std::string dir_;
};

TEST_F(CampaignFileTest, CellsAreTheProductOfTheAxes) {
  const CampaignFile file = load(head_ + "axes:\n  rock_area: [0.05, 0.10]\n  level: [efficient, full]\n");
  EXPECT_EQ(file.name, "c");
  ASSERT_EQ(file.drives.size(), 12U);
  EXPECT_EQ(file.drives[0].cell, (Cell{{"scenario", "enav"}, {"rock_area", "0.05"}, {"level", "efficient"}}));
  // All cells of the first seed come first.
  for (int i = 0; i < 12; ++i) EXPECT_EQ(file.drives[i].seed, 1 + i / 4);
}

TEST_F(CampaignFileTest, FlatGroundHasOneDirection) {
  const CampaignFile file = load(head_ + "axes: {slope_deg: [0.0, 5], slope_direction: [down, up, across]}\n");
  ASSERT_EQ(file.drives.size(), 4U * 3U);
  EXPECT_EQ(file.drives[0].cell.at("slope_direction"), "flat");
  EXPECT_EQ(file.drives[0].cell.at("slope_deg"), "0");
}

TEST_F(CampaignFileTest, BlocksAddToTheCommonAxesAndEqualCellsAreDrivenOnce) {
  const CampaignFile file = load(head_ +
                                 "axes: {level: full}\nblocks:\n  - axes: {rock_area: [0.05, 0.1]}\n"
                                 "  - axes: {rock_area: 0.1}\n    seeds: [3, 4]\n");
  ASSERT_EQ(file.drives.size(), 2U * 3U + 1U);
  for (const Drive& drive : file.drives) EXPECT_EQ(drive.cell.at("level"), "full");
}

TEST_F(CampaignFileTest, TheCampaignOfTheProjectHasItsDrives) {
  // (1 flat + 3 slopes x 3 directions) x (6 + 3 rock areas) x 20 seeds.
  EXPECT_EQ(load_campaign(kConfig + "/campaigns/enav.yaml", kConfig).drives.size(), 10U * 9U * 20U);
}

TEST_F(CampaignFileTest, BadInputIsOneLineWithFileAndLine) {
  EXPECT_EQ(error_of(head_ + "axes:\n  rock_aera: 0.1\n").find("c.yaml:4: axes.rock_aera: unknown axis; known: rock_"),
            0U);
  EXPECT_EQ(error_of(head_ + "axes:\n  rock_area:\n    - 0.1\n    - much\n"),
            "c.yaml:6: axes.rock_area: 'much' is not a number");
  EXPECT_EQ(error_of(head_ + "axes: {rock_area: 0.5}\n"), "c.yaml:3: axes.rock_area: 0.5 is out of range [0, 0.4]");
  EXPECT_EQ(error_of(head_ + "axes: {slope_deg: 5, slope_direction: left}\n"),
            "c.yaml:3: axes.slope_direction: 'left' is not one of down, up, across");
  EXPECT_EQ(error_of(head_ + "axes: {slope_direction: up}\n"),
            "c.yaml:1: axes.slope_direction: requires the axis slope_deg");
  EXPECT_EQ(
      error_of(head_ + "axes: {fault: [none, camera_blind middle]}\n").find("c.yaml:3: axes.fault: 'middle' is not"),
      0U);
  EXPECT_EQ(error_of(head_ + "axes: {fault: camera_rows left much}\n"),
            "c.yaml:3: axes.fault: 'much' is not an amount");
  EXPECT_EQ(error_of(head_ + "axes: {fault: camera_rows left 99}\n"),
            "c.yaml:3: axes.fault: out of range [-50, 50] px");
  EXPECT_EQ(error_of(head_ + "axes: {fault: tilt_roll ground}\n"), "c.yaml:3: axes.fault: out of range [-60, 60] deg")
      << "its amount is required";
  EXPECT_EQ(error_of(head_ + "axes: {rock_area: []}\n"), "c.yaml:3: axes.rock_area: an empty list");
  EXPECT_EQ(error_of(head_ + "blocks: []\n"), "c.yaml:3: blocks: a list of blocks is expected");
  EXPECT_EQ(error_of(head_ + "axis: {}\n"), "c.yaml:3: axis: unknown key");
  EXPECT_EQ(error_of("scenario: none.yaml\nseeds: 1..3\n"), "c.yaml:1: scenario: " + dir_ + "/none.yaml: no such file");
  EXPECT_EQ(error_of("scenario: " + kConfig + "/scenarios/enav.yaml\n"), "c.yaml:1: seeds: missing");
  EXPECT_EQ(error_of("seeds: 5..3\n" + head_.substr(0, head_.find('\n'))),
            "c.yaml:1: seeds: '5..3' is neither a range like 1..20 (of 10,000 at most) nor a list like [1, 4, 7]");
}

// In blocks without a common cell too: each would be driven in the world of the first.
TEST_F(CampaignFileTest, BasesOfTheSameNameAreRefused) {
  fs::create_directory(dir_ + "/other");
  const std::string base = kConfig + "/scenarios/flat.yaml";
  const std::string other = dir_ + "/other/flat.yaml";
  fs::copy_file(base, other);
  const std::string blocks = "seeds: 1\nblocks:\n  - {scenario: " + base + ", axes: {level: full}}\n  - {scenario: ";
  EXPECT_EQ(error_of(blocks + other + ", axes: {level: efficient}}\n"),
            "c.yaml: scenario: " + other + " and " + base + " have the same name");
  EXPECT_EQ(error_of(blocks + base + ", axes: {level: efficient}}\n"), "none");
}

TEST_F(CampaignFileTest, ParametersMustBeInTheConfigurationWithTheirType) {
  EXPECT_EQ(load(head_ + "axes: {recorder.min_free_gb: [0.2, 0.3]}\n").drives.size(), 6U);
  EXPECT_EQ(error_of(head_ + "axes: {planer.x: 1}\n"), "c.yaml:3: axes.planer.x: there is no config/planer.yaml");
  EXPECT_EQ(error_of(head_ + "axes: {recorder.min_gb: 1}\n"),
            "c.yaml:3: axes.recorder.min_gb: config/recorder.yaml has no 'min_gb' there");
  EXPECT_EQ(error_of(head_ + "axes: {recorder.min_free_gb: low}\n"),
            "c.yaml:3: axes.recorder.min_free_gb: 'low' is not a number");
}

TEST_F(CampaignFileTest, AnElevationModelCannotSlope) {
  const std::string gale = kConfig + "/scenarios/full_hard.yaml";
  EXPECT_EQ(error_of("scenario: " + gale + "\nseeds: 1\naxes: {slope_deg: 5}\n"),
            "c.yaml:1: axes.slope_deg: " + gale + " has no plane (world.plane) that could slope");
}

// Height difference along and across the path over 10 m.
std::pair<double, double> slopes(const std::string& direction) {
  const std::string base = kConfig + "/scenarios/enav.yaml";
  const std::string file = "/tmp/campaign-variant-" + std::to_string(getpid()) + ".yaml";
  const Cell cell = {{"scenario", "enav"}, {"slope_deg", "10"}, {"slope_direction", direction}};
  write_yaml(file, make_variant(load_yaml(base), base, cell));
  const Scenario scenario = load_scenario(file);
  fs::remove(file);
  const ElevationRaster& z = scenario.dtm;
  return {z.at(60, 40) - z.at(50, 40), z.at(50, 50) - z.at(50, 40)};  // the path leads to the east
}

TEST(Variant, DirectionOfTheSlopeIsThatOfThePath) {
  const double rise_m = 10.0 * std::tan(10.0 * M_PI / 180.0);
  EXPECT_NEAR(slopes("up").first, rise_m, 1e-3);
  EXPECT_NEAR(slopes("down").first, -rise_m, 1e-3);
  EXPECT_NEAR(slopes("across").first, 0.0, 1e-3);
  EXPECT_NEAR(slopes("across").second, rise_m, 1e-3);
}

TEST(Variant, RocksSoilAndSunAreTheCells) {
  const YAML::Node base =
      YAML::Load("{world: {dtm: ../a.tif, soil: {everywhere: firm}}, path: {x_m: [0, 1], y_m: [0, 1]}}");
  const Cell cell = {{"scenario", "b"}, {"rock_area", "0.12"}, {"soil", "sand"}, {"sun_elevation_deg", "12"}};
  const YAML::Node variant = make_variant(base, "/x/y/b.yaml", cell);
  EXPECT_EQ(variant["world"]["rock_area_k"].as<double>(), 0.12);
  EXPECT_EQ(variant["world"]["soil"]["everywhere"].as<std::string>(), "sand");
  EXPECT_EQ(variant["sun"]["elevation_deg"].as<double>(), 12.0);
  EXPECT_EQ(variant["world"]["dtm"].as<std::string>(), "/x/a.tif");
  EXPECT_EQ(base["world"]["dtm"].as<std::string>(), "../a.tif");
  EXPECT_EQ(variant_name(cell), "b-rock_area-0.12-soil-sand-sun_elevation_deg-12");
}

TEST_F(CampaignFileTest, AFolderWithTheUsersScenariosIsNotEmpty) {
  const std::string file = write(head_);
  const std::string out = dir_ + "/o";
  fs::create_directories(out + "/scenarios");
  const auto make = [&] { make_campaign(out, file, load_campaign(file, kConfig), {"c", "abc", "", ""}); };
  EXPECT_THROW(make(), ConfigError);
  std::ofstream(out + "/campaign.json.begun") << "{}";  // of a start that was killed
  make();
  EXPECT_TRUE(has_campaign(out));
  EXPECT_FALSE(fs::exists(out + "/campaign.json.begun"));
}

TEST_F(CampaignFileTest, AJobIsARunWithItsOptions) {
  const std::string file =
      write(head_ + "axes: {level: full, perception: geometric, rock_area: 0.1, recorder.part_gb: 1}\n");
  const std::string out = dir_ + "/o";
  fs::create_directory(out);
  make_campaign(out, file, load_campaign(file, kConfig), {"c", "abc", "", ""});
  ASSERT_EQ(read_jobs(out).size(), 3U);
  EXPECT_EQ(repeat_command(out, read_job(out, 2)),
            "./rover run " + out +
                "/scenarios/enav-rock_area-0.1.yaml --seed 2 --level full --perception geometric"
                " --set recorder.part_gb=1 --record full");
}

}  // namespace
}  // namespace rover::campaign
