#include "common/bus/parameters.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "common/core/frames.hpp"

namespace rover {
namespace {

struct Example {
  double speed_mps = 0.2;
  double tilt_rad = to_rad(0.6);
  int cells = 200;
  std::uint64_t seed = 1;
  bool enabled = true;
  std::string mode = "full";
  std::string file;
  Utime latency_us = 120'000;
};

Example load(const std::string& file, ParameterList* list = nullptr) {
  Example e;
  Parameters p(file, "An example.", list);
  p.add("speed_mps", e.speed_mps, {0.0, 1.0}, "top speed");
  p.add_s("latency_s", e.latency_us, {0.02, 5.0}, "modelled");
  Parameters map = p.section("map", "of the ground");
  map.add_deg("tilt_deg", e.tilt_rad, {0.0, 45.0}, "largest");
  map.add("cells", e.cells, {1, 400}, "per side");
  map.check(e.cells % 2 == 0, "cells", "must be even");
  p.add("seed", e.seed, {0, 1e15}, "of the random numbers");
  p.add("enabled", e.enabled, "or not");
  p.add_choice("mode", e.mode, {"full", "reduced"}, "what is kept");
  p.add("file", e.file, "none by default");
  p.finish();
  return e;
}

class ParametersTest : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(dir_); }
  void TearDown() override { std::filesystem::remove_all(dir_); }
  std::string written(const std::string& text) const {
    std::ofstream(dir_ / "example.yaml") << text;
    return dir_ / "example.yaml";
  }
  std::string error_of(const std::string& text) const {
    try {
      load(written(text));
    } catch (const ConfigError& error) {
      const std::string what = error.what();
      return what.substr(what.find("example.yaml"));
    }
    return "";
  }
  std::filesystem::path dir_ = std::filesystem::path(testing::TempDir()) / "parameters_test";
};

TEST_F(ParametersTest, FileGivesValuesAndAbsentKeysKeepTheirDefaults) {
  const Example e = load(written("speed_mps: 0.1\nmap:\n  cells: 100\nmode: reduced\n"));
  EXPECT_EQ(e.speed_mps, 0.1);
  EXPECT_EQ(e.cells, 100);
  EXPECT_EQ(e.mode, "reduced");
  EXPECT_EQ(e.tilt_rad, to_rad(0.6));
  EXPECT_EQ(e.latency_us, 120'000);
}

TEST_F(ParametersTest, AbsentSectionKeepsItsDefaults) {
  EXPECT_EQ(load(written("seed: 3\n")).cells, 200);
}

TEST_F(ParametersTest, GeneratedYamlReadsBackAsTheDefaults) {
  ParameterList list;
  load("no such file", &list);
  const std::string yaml = to_yaml(list);
  const Example e = load(written(yaml));
  const Example defaults;
  EXPECT_EQ(e.speed_mps, defaults.speed_mps);
  EXPECT_EQ(e.tilt_rad, defaults.tilt_rad) << "bit by bit, though the file has degrees";
  EXPECT_EQ(e.latency_us, defaults.latency_us);
  EXPECT_EQ(e.file, "");
  EXPECT_EQ(yaml.substr(0, yaml.find("latency_s")), "# An example.\nspeed_mps: 0.2   # top speed\n");
}

TEST_F(ParametersTest, WrongFilesAreRefusedWithFileLineAndKey) {
  EXPECT_EQ(error_of("speed_mps: 3\n"), "example.yaml:1: speed_mps: out of range [0, 1]");
  EXPECT_EQ(error_of("seed: 1\nmap:\n  cels: 4\n"), "example.yaml:3: map.cels: unknown key");
  EXPECT_EQ(error_of("map:\n  cells: 3\n"), "example.yaml:2: map.cells: must be even");
  EXPECT_EQ(error_of("mode: some\n"), "example.yaml:1: mode: 'some' is not one of full, reduced");
}

TEST_F(ParametersTest, TableHasDefaultUnitRangeAndMeaning) {
  ParameterList list;
  load("", &list);
  const std::string table = to_markdown(list);
  EXPECT_NE(table.find("| `map.tilt_deg` | 0.6 | deg | 0 to 45 | largest |"), std::string::npos) << table;
  EXPECT_NE(table.find("| `mode` | full |  | full, reduced | what is kept |"), std::string::npos) << table;
}

TEST(UnitOf, IsTheEndOfTheKey) {
  EXPECT_EQ(unit_of("max_speed_mps"), "m/s");
  EXPECT_EQ(unit_of("growth_m2_per_m"), "m²/m");
  EXPECT_EQ(unit_of("curvature_per_m"), "1/m");
  EXPECT_EQ(unit_of("max_particles"), "");
}

}  // namespace
}  // namespace rover
