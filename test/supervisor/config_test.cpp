// Configuration of the supervisor derived from fdir.yaml, and its checks.
#include "supervisor/config.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/bus/config.hpp"

namespace rover::supervisor {
namespace {

namespace fs = std::filesystem;

// The default configuration with one text of a file replaced.
class ConfigTest : public testing::Test {
 protected:
  ConfigTest() : dir_(fs::path(testing::TempDir()) / "supervisor_config_test") {
    fs::remove_all(dir_);
    fs::copy(ROVER_SOURCE_DIR "/config", dir_, fs::copy_options::recursive);
  }
  ~ConfigTest() override { fs::remove_all(dir_); }

  SupervisorConfig load_with(const std::string& from, const std::string& to, const std::string& file = "fdir.yaml") {
    std::stringstream stream;
    stream << std::ifstream(dir_ / file).rdbuf();
    std::string text = stream.str();
    const size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos);
    std::ofstream(dir_ / file) << text.replace(at, from.size(), to);
    return load_config(dir_);
  }

  fs::path dir_;
};

TEST_F(ConfigTest, PermitAgesFollowTheFdirRows) {
  const SupervisorConfig config = load_with("quantity: pose_age_s, limit: 0.3", "quantity: pose_age_s, limit: 0.6");
  EXPECT_EQ(config.pose_max_age_s, 0.6);
  EXPECT_EQ(config.hazards_max_age_s, 1.2);
  EXPECT_EQ(config.wheels_max_age_s, 0.2);
  EXPECT_NEAR(config.heartbeat_max_age_s, 1.05, 1e-9);
}

TEST_F(ConfigTest, ASlowerComputerMayBeLateWithWhatItComputesAndNotWithTheRest) {
  const SupervisorConfig config = load_with("cpu_scale: 1.0", "cpu_scale: 3.0", "navigation.yaml");
  EXPECT_NEAR(config.hazards_max_age_s, 3.6, 1e-9);
  EXPECT_NEAR(config.heartbeat_max_age_s, 2.65, 1e-9);  // with its persistence
  EXPECT_EQ(config.pose_max_age_s, 0.3);
  EXPECT_EQ(config.wheels_max_age_s, 0.2);
}

TEST_F(ConfigTest, LogRowsDoNotChangePermitAges) {
  const SupervisorConfig config =
      load_with("limit: 1.2, response: stop, armed: efficient}    # 2.5 Hz", "limit: 9.0, response: log}    # 2.5 Hz");
  EXPECT_EQ(config.hazards_max_age_s, SupervisorConfig().hazards_max_age_s);
}

TEST_F(ConfigTest, UnknownQuantityIsReportedWithFileAndLine) {
  try {
    load_with("quantity: imu_fault", "quantity: imu_mood");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("fdir.yaml:"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("imu_mood"), std::string::npos) << error.what();
  }
}

TEST_F(ConfigTest, BacktrackLimitMustNotBeLowerThanLimit) {
  EXPECT_NO_THROW(load_with("backtrack_limit: 23.0", "backtrack_limit: 20.0"));
  EXPECT_THROW(load_with("backtrack_limit: 20.0", "backtrack_limit: 19.0"), ConfigError);
}

TEST_F(ConfigTest, BacktrackLimitIsOnlyForStopBacktrackRows) {
  EXPECT_THROW(load_with("limit: 35.0, n: 3", "limit: 35.0, backtrack_limit: 38.0, n: 3"), ConfigError);
}

TEST_F(ConfigTest, SlowRowsNeedAValidSpeed) {
  EXPECT_THROW(load_with("slow_mps: 0.10", "slow_mps: 5.0"), ConfigError);  // above the vehicle top speed
  EXPECT_THROW(load_with("slow_mps: 5.0, ", ""), ConfigError);
}

}  // namespace
}  // namespace rover::supervisor
