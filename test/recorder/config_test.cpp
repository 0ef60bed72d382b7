#include "recorder/config.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "common/bus/config.hpp"

namespace rover::recorder {
namespace {

// A folder of configuration with this recorder.yaml.
std::string write(const std::string& text) {
  const std::string folder = testing::TempDir();
  std::ofstream(folder + "/recorder.yaml") << text;
  return folder;
}

TEST(RecorderConfig, DefaultFileLoads) {
  const RecorderConfig config = load_config(ROVER_SOURCE_DIR "/config");
  EXPECT_FALSE(config.keep.reduced);
  EXPECT_TRUE(config.keep.bulk_channels.contains("DISPARITY"));
}

TEST(RecorderConfig, RefusesUnknownKeysAndValues) {
  EXPECT_THROW(load_config(write("record: full\nrecrod: full\n")), ConfigError);
  EXPECT_THROW(load_config(write("record: some\n")), ConfigError);
  EXPECT_THROW(load_config(write("record: full\nimage_interval: 0\n")), ConfigError);
  EXPECT_THROW(load_config(write("record: full\nimage_every: 3\n")), ConfigError);
}

TEST(RecorderConfig, AbsentKeysKeepTheirDefaults) {
  const RecorderConfig config = load_config(write("record: reduced\n"));
  EXPECT_TRUE(config.keep.reduced);
  EXPECT_EQ(config.keep.image_interval, 50);
}

}  // namespace
}  // namespace rover::recorder
