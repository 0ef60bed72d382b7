#include "tools/launcher/run_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "../common/temp_folder.hpp"
#include "common/bus/config.hpp"

namespace rover {
namespace {

namespace fs = std::filesystem;

TEST(RunFolderTest, RunsOfOneSecondHaveFoldersOfTheirOwn) {
  const testing_support::TempFolder folder;
  std::set<std::string> dirs;
  for (int i = 0; i < 3; ++i) dirs.insert(create_folders(folder.path(), "", "flat").dir);
  ASSERT_EQ(dirs.size(), 3U);
  // A second may end between two of them, but not twice.
  EXPECT_TRUE(std::any_of(dirs.begin(), dirs.end(), [](const std::string& dir) { return dir.ends_with("-flat-2"); }));
}

TEST(RunFolderTest, OnlyItsMakerRemovesAFolder) {
  const testing_support::TempFolder folder;
  const std::string dir = folder.file("out");
  const RunFolder maker = create_folders("", dir, "flat");
  EXPECT_THROW(create_folders("", dir, "flat"), ConfigError);
  EXPECT_TRUE(fs::is_directory(maker.config_dir));
  remove_run_folder(maker);
  EXPECT_FALSE(fs::exists(dir));
  fs::create_directory(dir);
  remove_run_folder(create_folders("", dir, "flat"));
  EXPECT_TRUE(fs::is_empty(dir));
}

}  // namespace
}  // namespace rover
