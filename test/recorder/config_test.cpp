#include "recorder/config.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "common/bus/config.hpp"

namespace rover::recorder {
namespace {

std::string write(const std::string& text) {
  const std::string file = testing::TempDir() + "/recorder.yaml";
  std::ofstream(file) << text;
  return file;
}

TEST(RecorderConfig, DefaultFileLoads) {
  const RecorderConfig config = load_config(ROVER_SOURCE_DIR "/config/recorder.yaml");
  EXPECT_FALSE(config.keep.reduced);
  EXPECT_TRUE(config.keep.bulk_channels.contains("DISPARITY"));
}

TEST(RecorderConfig, RefusesUnknownKeysAndValues) {
  EXPECT_THROW(load_config(write("record: full\nrecrod: full\n")), ConfigError);
  EXPECT_THROW(load_config(write("record: some\n")), ConfigError);
  EXPECT_THROW(load_config(write("record: full\nimage_every: 0\n")), ConfigError);
  EXPECT_THROW(load_config(write("image_every: 3\n")), ConfigError);
}

}  // namespace
}  // namespace rover::recorder
