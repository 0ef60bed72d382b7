#include "common/bus/config.hpp"

#include <gtest/gtest.h>

#include "common/bus/vehicle_config.hpp"

namespace rover {
namespace {

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(Config, UnknownKeyIsNamedWithFileAndLine) {
  const Config config = Config::parse("speed_mps: 0.2\nspeed_kmh: 3\n", "drive.yaml");
  EXPECT_DOUBLE_EQ(config.number("speed_mps", {0, 1}), 0.2);
  EXPECT_EQ(error_of([&] { config.finish(); }), "drive.yaml:2: speed_kmh: unknown key");
}

TEST(Config, UnknownKeyInASectionIsNamedToo) {
  const Config config = Config::parse("limits:\n  roll_deg: 20\n  pich_deg: 3\n", "fdir.yaml");
  EXPECT_DOUBLE_EQ(config.section("limits").number("roll_deg", {0, 90}), 20.0);
  EXPECT_EQ(error_of([&] { config.finish(); }), "fdir.yaml:3: limits.pich_deg: unknown key");
}

TEST(Config, WrongTypeRangeAndNanAreRefused) {
  const Config config = Config::parse("a: fast\nb: 7\nc: .nan\nd: [1, 2]\n", "x.yaml");
  EXPECT_EQ(error_of([&] {
              (void)config.number("a", {0, 1});
            }),
            "x.yaml:1: a: not a number: 'fast'; plain decimal is expected, as 0.5 or 1e-3");
  EXPECT_EQ(error_of([&] { (void)config.number("b", {0, 1}); }), "x.yaml:2: b: out of range [0, 1]");
  EXPECT_EQ(error_of([&] {
              (void)config.number("c", {0, 1});
            }),
            "x.yaml:3: c: not a number: '.nan'; plain decimal is expected, as 0.5 or 1e-3");
  EXPECT_EQ(error_of([&] { (void)config.numbers("d", {0, 9}, 3); }), "x.yaml:4: d: 3 numbers expected, found 2");
  EXPECT_EQ(error_of([&] { (void)config.number("e", {0, 1}); }), "x.yaml:1: e: missing");
}

TEST(Config, BrokenYamlAndMissingFileAreOneLine) {
  EXPECT_NE(error_of([] { Config::parse("a: [1, 2\nb", "y.yaml"); }).find("y.yaml:"), std::string::npos);
  EXPECT_EQ(error_of([] { Config::load("/nowhere/z.yaml"); }), "/nowhere/z.yaml: no such file");
  EXPECT_EQ(error_of([] { Config::parse("a: 1\na: 2\n", "t.yaml"); }), "t.yaml:2: a: given twice");
}

TEST(Config, ShippedVehicleAndCamerasLoad) {
  const std::string dir = ROVER_SOURCE_DIR "/config";
  const Vehicle vehicle = load_vehicle(dir);
  EXPECT_NEAR(vehicle.footprint_half_length_m(), 0.875, 1e-9);
  EXPECT_NEAR(vehicle.footprint_half_width_m(), 0.47, 1e-9);
  const StereoRig rig = load_stereo_rig(dir, "loccam");
  EXPECT_EQ(rig.width, 512);
  EXPECT_NEAR(rig.T_left_right.translation().x(), 0.12, 1e-9);
}

}  // namespace
}  // namespace rover
