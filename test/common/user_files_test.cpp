// Typed paths, and outputs that never replace existing files.
#include "common/bus/user_files.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "common/bus/command_line.hpp"
#include "common/bus/config.hpp"

namespace rover {
namespace {

namespace fs = std::filesystem;

class UserFilesTest : public testing::Test {
 protected:
  UserFilesTest() {
    std::string name = (fs::temp_directory_path() / "rover-files-XXXXXX").string();
    dir_ = fs::canonical(mkdtemp(name.data()));
    before_ = fs::current_path();
    fs::current_path(dir_);
  }
  ~UserFilesTest() override {
    fs::current_path(before_);
    fs::remove_all(dir_);
  }
  static void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }
  static std::string read(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  }

  fs::path dir_, before_;
};

TEST_F(UserFilesTest, PathsAreOfTheFolderThatTheUserIsIn) {
  const std::string here = dir_.string();
  fs::create_directory("sub");
  fs::current_path("sub");
  EXPECT_EQ(user_path("x"), here + "/sub/x");
  EXPECT_EQ(user_path("x/"), here + "/sub/x");
  EXPECT_EQ(user_path("x//"), here + "/sub/x");
  EXPECT_EQ(user_path("."), here + "/sub");
  EXPECT_EQ(user_path("./"), here + "/sub");
  EXPECT_EQ(user_path(".."), here);
  EXPECT_EQ(user_path("../y/./z"), here + "/y/z");
  EXPECT_EQ(user_path("/"), "/");
  EXPECT_EQ(user_path("it's a übung"), here + "/sub/it's a übung");
  EXPECT_THROW(user_path(""), ConfigError);
}

TEST_F(UserFilesTest, ATildeIsTheHomeFolder) {
  setenv("HOME", dir_.c_str(), 1);
  EXPECT_EQ(user_path("~/a/b/"), (dir_ / "a/b").string());
  EXPECT_EQ(user_path("~"), dir_.string());
  EXPECT_EQ(user_path("a~"), (dir_ / "a~").string());
}

TEST_F(UserFilesTest, ALinkKeepsItsNameAndAFolderBehindALinkIsFoundThroughIt) {
  fs::create_directories("real/deep");
  fs::create_directory_symlink("real/deep", "link");
  EXPECT_EQ(user_path("link"), (dir_ / "link").string());
  EXPECT_EQ(user_path("link/.."), (dir_ / "real").string());  // as the kernel resolves it
}

TEST_F(UserFilesTest, AFolderIsThereWholeOrNotAtAll) {
  {
    NewFolder folder("out");
    write(folder.dir() / "a", "half");
  }
  EXPECT_FALSE(fs::exists("out"));
  NewFolder folder("deep/out");
  write(folder.dir() / "a", "whole");
  folder.keep();
  EXPECT_EQ(read("deep/out/a"), "whole");
  EXPECT_EQ(std::distance(fs::directory_iterator("deep/out"), {}), 1);
}

TEST_F(UserFilesTest, AFolderThatHoldsSomethingIsNotTouched) {
  fs::create_directory("out");
  write("out/mine", "mine");
  EXPECT_THROW(NewFolder("out"), ConfigError);
  fs::create_directory_symlink("out", "link");
  EXPECT_THROW(NewFolder("link"), ConfigError);
  write("file", "mine");
  EXPECT_THROW(NewFolder("file"), ConfigError);
  EXPECT_THROW(NewFolder("file/out"), ConfigError);
  EXPECT_EQ(read("out/mine") + read("file"), "minemine");
}

TEST_F(UserFilesTest, AnEmptyFolderOfTheUsersIsFilled) {
  fs::create_directory("out");
  fs::create_directory_symlink("out", "link");
  { NewFolder given_up("link"); }
  EXPECT_TRUE(fs::is_empty("out"));
  NewFolder folder("link");
  write(folder.dir() / "a", "whole");
  folder.keep();
  EXPECT_EQ(read("out/a"), "whole");
}

TEST_F(UserFilesTest, WhatAnInterruptedCommandLeftDoesNotStandInTheWay) {
  const pid_t child = fork();
  if (child == 0) {
    NewFolder folder("out");
    write(folder.dir() / "half", "half");
    _exit(0);  // as if killed
  }
  waitpid(child, nullptr, 0);
  ASSERT_TRUE(fs::exists("out/.unfinished/half"));
  NewFolder folder("out");
  EXPECT_THROW(NewFolder("out"), ConfigError) << "two commands write to one folder";
  write(folder.dir() / "a", "whole");
  folder.keep();
  EXPECT_EQ(std::distance(fs::directory_iterator("out"), {}), 1);
}

TEST_F(UserFilesTest, WhatComesMeanwhileStays) {
  NewFolder folder("out");
  write(folder.dir() / "a", "ours");
  write("out/a", "theirs");
  EXPECT_THROW(folder.keep(), ConfigError);
  NewFile file("f");
  write(file.path(), "ours");
  write("f", "theirs");
  EXPECT_THROW(file.keep(), ConfigError);
  EXPECT_EQ(read("out/a") + read("f"), "theirstheirs");
}

TEST_F(UserFilesTest, AFileIsThereWholeOrNotAtAll) {
  {
    NewFile file("f");
    write(file.path(), "half");
  }
  EXPECT_TRUE(fs::is_empty("."));
  NewFile file("f");
  write(file.path(), "whole");
  file.keep();
  EXPECT_EQ(read("f"), "whole");
  EXPECT_EQ(std::distance(fs::directory_iterator("."), {}), 1);
}

TEST_F(UserFilesTest, AFileThatIsThereIsNotReplaced) {
  write("f", "mine");
  fs::create_symlink("nowhere", "dangling");
  EXPECT_THROW(NewFile("f"), ConfigError);
  EXPECT_THROW(NewFile("dangling"), ConfigError);
  EXPECT_THROW(NewFile("no/folder"), ConfigError);
  EXPECT_EQ(read("f"), "mine");
}

TEST(CommandLine, AnOptionForListsTakesOneValueEachTime) {
  std::vector<std::string> set;
  std::string scenario, out;
  CLI::App app;
  app.add_option("scenario", scenario);
  repeatable(app.add_option("--set", set));
  app.add_option("--out", out)->transform(is_user_path());
  app.parse("--set a.b=1 s.yaml --set c.d=2 --out x/", false);
  EXPECT_EQ(scenario, "s.yaml");
  EXPECT_EQ(set, (std::vector<std::string>{"a.b=1", "c.d=2"}));
  EXPECT_EQ(out, user_path("x"));
}

}  // namespace
}  // namespace rover
