// Page and mission configuration.
#include "mission_control/config.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "common/bus/config.hpp"
#include "common/bus/vehicle_config.hpp"
#include "test/common/temp_folder.hpp"

namespace rover::mission {
namespace {

class PageConfigTest : public testing::Test {
 protected:
  std::string token_file(const std::string& token, mode_t mode) const {
    const std::string file = folder_.file("token");
    std::ofstream(file) << token << "\n";
    chmod(file.c_str(), mode);
    return file;
  }

  PageConfig load(const std::string& address, const std::string& token, const std::string& more = "") const {
    std::filesystem::copy_file(ROVER_SOURCE_DIR "/config/navigation.yaml", folder_.file("navigation.yaml"),
                               std::filesystem::copy_options::overwrite_existing);
    std::ofstream(folder_.file("mission_control.yaml"))
        << "address: " << address << "\ntoken_file: \"" << token << "\"\npath: {}\n"
        << more;
    return load_config(folder_.path());
  }

  testing_support::TempFolder folder_;
};

TEST_F(PageConfigTest, DefaultIsLoopbackWithoutToken) {
  const PageConfig config = load_config(ROVER_SOURCE_DIR "/config");
  EXPECT_TRUE(config.served);
  EXPECT_TRUE(is_loopback(config.guard.address));
  EXPECT_TRUE(config.guard.token.empty());
}

TEST_F(PageConfigTest, LimitsOfDrawnPathsAreThoseOfNavigation) {
  load("127.0.0.1", "");
  std::ofstream(folder_.file("navigation.yaml")) << "max_slope_deg: 12.0\ncorridor_half_width_m: 2.0\n";
  const OperatorPathConfig path = load_config(folder_.path()).path;
  EXPECT_EQ(path.slope.max_rad, to_rad(12.0));
  EXPECT_EQ(path.slope.steep_rad, to_rad(10.0));
  EXPECT_EQ(path.corridor_half_width_m, 2.0);
}

TEST_F(PageConfigTest, RefusesMissionPathOfZeroLength) {
  const auto refusal = [&](const std::string& x_m) {
    std::ofstream(folder_.file("ground.yaml")) << "start: {x_m: 10, y_m: 20, z_m: 0, yaw_deg: 0}\n"
                                               << "path: {x_m: [" << x_m << "], y_m: [20, 20], level: [0, 0]}\n";
    try {
      load_mission_plan(folder_.path());
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refusal("10, 10").find("path is shorter than 0.1 m"), std::string::npos);
  EXPECT_NE(refusal("10, 10.05").find("path.x_m"), std::string::npos);
  EXPECT_EQ(refusal("10, 10.3"), "");
}

TEST_F(PageConfigTest, NonLoopbackAddressNeedsToken) {
  EXPECT_NO_THROW(load("127.0.0.1", ""));
  EXPECT_THROW(load("0.0.0.0", ""), ConfigError);
  EXPECT_THROW(load("192.168.1.5", ""), ConfigError);
  EXPECT_NO_THROW(load("0.0.0.0", "", "page: false\n"));
  EXPECT_EQ(load("0.0.0.0", token_file("0123456789abcdef", 0600)).guard.token, "0123456789abcdef");
}

TEST_F(PageConfigTest, RefusesReadableOrShortToken) {
  for (const mode_t mode : {0644, 0640, 0604, 0700, 0660})
    EXPECT_THROW(load("0.0.0.0", token_file("0123456789abcdef", mode)), ConfigError) << mode;
  EXPECT_THROW(load("0.0.0.0", token_file("short", 0600)), ConfigError);
  EXPECT_THROW(load("0.0.0.0", token_file("", 0600)), ConfigError);
  EXPECT_THROW(load("0.0.0.0", token_file("0123456789abcdef;Path=/", 0600)), ConfigError);
  EXPECT_THROW(load("0.0.0.0", folder_.file("none")), ConfigError);
}

TEST_F(PageConfigTest, RefusesUnknownKeysAndInvalidPorts) {
  EXPECT_THROW(load("127.0.0.1", "", "colour: red\n"), ConfigError);
  EXPECT_THROW(load("127.0.0.1", "", "port: 70000\n"), ConfigError);
}

TEST_F(PageConfigTest, GaugeLimitsComeFromFaultTable) {
  const std::string dir = ROVER_SOURCE_DIR "/config";
  const auto setup = page_setup(dir, load_vehicle(dir));
  for (const char* gauge : {"slip", "roll_deg", "pitch_deg", "current_a"}) {
    ASSERT_TRUE(setup["gauges"][gauge]["limit"].is_number()) << gauge;
    EXPECT_LT(setup["gauges"][gauge]["warn"], setup["gauges"][gauge]["limit"]) << gauge;
  }
}

TEST_F(PageConfigTest, NavCamViewNeedsPanTiltUnit) {
  const std::string dir = ROVER_SOURCE_DIR "/config";
  Vehicle vehicle = load_vehicle(dir);
  const auto navcam = page_setup(dir, vehicle)["navcam"];
  EXPECT_NEAR(navcam["half_width"].get<double>(), to_rad(21.4), to_rad(0.5));
  EXPECT_EQ(navcam["x_m"].get<double>(), vehicle.pan_tilt->p_body_axes.x());
  vehicle.pan_tilt.reset();
  EXPECT_TRUE(page_setup(dir, vehicle)["navcam"].is_null());
}

}  // namespace
}  // namespace rover::mission
