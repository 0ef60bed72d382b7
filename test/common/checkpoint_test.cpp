#include "common/bus/checkpoint.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace rover {
namespace {

class Checkpoint : public testing::Test {
 protected:
  void SetUp() override {
    dir_ = std::filesystem::temp_directory_path() /
           ("rover_checkpoint_" + std::to_string(testing::UnitTest::GetInstance()->random_seed()) + "_" +
            testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(dir_);
  }
  void TearDown() override { std::filesystem::remove_all(dir_); }
  std::filesystem::path dir_;
};

TEST_F(Checkpoint, ComesBackAsItWas) {
  ASSERT_TRUE(save_checkpoint(dir_, "pose", {1, 2, 3}));
  ASSERT_TRUE(save_checkpoint(dir_, "pose", {4, 5}));
  EXPECT_EQ(load_checkpoint(dir_, "pose"), (std::vector<std::uint8_t>{4, 5}));
  EXPECT_FALSE(load_checkpoint(dir_, "other").has_value());
}

TEST_F(Checkpoint, DamageIsSeen) {
  ASSERT_TRUE(save_checkpoint(dir_, "pose", std::vector<std::uint8_t>(100, 7)));
  const auto file = dir_ / "pose.ckpt";
  std::filesystem::resize_file(file, 60);
  EXPECT_FALSE(load_checkpoint(dir_, "pose").has_value());
  ASSERT_TRUE(save_checkpoint(dir_, "pose", std::vector<std::uint8_t>(100, 7)));
  std::fstream(file, std::ios::in | std::ios::out | std::ios::binary).seekp(50).put(8);
  EXPECT_FALSE(load_checkpoint(dir_, "pose").has_value());
}

TEST_F(Checkpoint, AFolderThatIsNotThereIsReported) {
  EXPECT_FALSE(save_checkpoint(dir_ / "none", "pose", {1}));
}

}  // namespace
}  // namespace rover
