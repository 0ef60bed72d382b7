// --set, --seeds and the commit.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "../common/temp_folder.hpp"
#include "common/bus/child_process.hpp"
#include "common/bus/config.hpp"
#include "common/bus/yaml_file.hpp"
#include "tools/launcher/arguments.hpp"
#include "tools/launcher/run_folder.hpp"
#include "wild.hpp"

namespace rover {
namespace {

namespace fs = std::filesystem;

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

class SettingTest : public testing::Test {
 protected:
  SettingTest() {
    for (const char* name : {"vehicle.yaml", "bus.yaml"})
      fs::copy_file(fs::path(ROVER_SOURCE_DIR) / "config" / name, folder_.path() / name);
  }
  std::string refusal(const std::string& setting) {
    return error_of([&] { apply_setting(setting, folder_.path()); });
  }
  std::string limit() const { return load_yaml(folder_.file("vehicle.yaml"))["limits"]["top_speed_mps"].Scalar(); }

  testing_support::TempFolder folder_;
};

// The lines of the run's copy are not those of the user's file.
TEST_F(SettingTest, ErrorInAChangedFileNamesTheOptionInPlaceOfALine) {
  RunFolder folder;
  folder.config_dir = folder_.path();
  apply_settings(false, "", {"vehicle.limits.top_speed=1"}, folder);
  EXPECT_EQ(in_users_files("locomotion: " + folder_.file("vehicle.yaml") + ":31: limits.top_speed: unknown key", folder,
                           "/rover/config"),
            "locomotion: /rover/config/vehicle.yaml with --set: limits.top_speed: unknown key");
  EXPECT_EQ(in_users_files(folder_.file("bus.yaml") + ":3: url: missing", folder, "/rover/config"),
            "/rover/config/bus.yaml:3: url: missing");
}

struct Case {
  std::string typed;
  const char* before;
  const char* now;  // part of the error line
};

TEST_F(SettingTest, InvalidSettingIsRefusedInOneLine) {
  const std::string before = limit();
  std::string long_file(300, 'v'), long_list(100'000, '1');
  long_file += ".key=1";
  long_list.insert(0, "vehicle.limits.top_speed_mps=[");
  const std::vector<Case> cases = {
      {"", "refused", "file.key=value is expected"},
      {"vehicle", "refused", "file.key=value is expected"},
      {"vehicle=1", "refused", "file.key=value is expected"},
      {"vehicle.=1", "refused", "file.key=value is expected"},
      {".limits.top_speed_mps=1", "refused", "file.key=value is expected"},
      {"vehicle..limits=1", "a section without a name", "file.key=value is expected"},
      {"vehicle.limits.top_speed_mps.=1", "no section", "file.key=value is expected"},
      {"vehicle.limits.top_speed_mps=", "an empty value was written", "file.key=value is expected"},
      {"vehicle.limits.top speed=1", "refused", "file.key=value is expected"},
      {"../vehicle.limits.top_speed_mps=1", "refused", "file.key=value is expected"},
      {"vehicle.wheels.x_m.0=1", "refused", "no section 'x_m'"},
      {"nothing.key=1", "refused", "there is no config/nothing.yaml"},
      {"vehicle.limits.top_speed_mps=&a 1", "taken", "anchors"},
      {"vehicle.limits.top_speed_mps=!!float 1", "taken", "tags"},
      {"vehicle.limits.top_speed_mps=1\n--- 2", "refused", "a second document"},
      {"vehicle.limits={top_speed_mps: 1, top_speed_mps: 2}", "taken, the first ignored", "given twice"},
      {long_file, "an exception of the file system's", "there is no config/vvv"},
      {long_list, "a crash: the stack was full", "not valid YAML"}};
  for (const Case& c : cases) {
    const std::string line = refusal(c.typed);
    EXPECT_NE(line.find(c.now), std::string::npos) << c.typed.substr(0, 80) << " -> " << line;
    EXPECT_EQ(line.find('\n'), std::string::npos);
    EXPECT_LE(line.size(), 2000U);
    EXPECT_EQ(limit(), before);
    const bool is_long = c.typed.size() > 100;
    wild_row("Configuration",
             "--set " + (is_long ? "of " + std::to_string(c.typed.size()) + " characters" : "'" + c.typed + "'"),
             c.before, is_long ? line.substr(0, 60) + "..." : line);
  }
}

TEST_F(SettingTest, ValueIsWrittenAsTyped) {
  EXPECT_EQ(refusal("vehicle.limits.top_speed_mps=0.125"), "");
  EXPECT_EQ(limit(), "0.125");
  EXPECT_EQ(refusal("vehicle.limits.top_speed_mps=012"), "");
  const Config limits = Config::load(folder_.file("vehicle.yaml")).section("limits");
  const std::string line = error_of([&] { (void)limits.number("top_speed_mps", {0, 100}); });
  EXPECT_NE(line.find("limits.top_speed_mps: not a number: '012'"), std::string::npos) << line;
  wild_row("Configuration", "--set vehicle.limits.top_speed_mps=012", "taken as 12", line.substr(line.find("limits.")));
}

TEST(Seeds, AreDecimalAndBounded) {
  EXPECT_EQ(parse_seeds("2..4"), (std::vector<std::int64_t>{2, 3, 4}));
  EXPECT_EQ(parse_seeds("1,4,7"), (std::vector<std::int64_t>{1, 4, 7}));
  EXPECT_EQ(parse_seeds("4,1,4"), (std::vector<std::int64_t>{4, 1})) << "each once";
  EXPECT_EQ(parse_seeds("5"), (std::vector<std::int64_t>{5}));
  const std::vector<Case> cases = {{"012", "taken as 12", ""},
                                   {"1..999999999", "8 GB of memory", ""},
                                   {"0..9223372036854775807", "refused", ""},
                                   {"3..1", "refused", ""},
                                   {"1,,2", "refused", ""},
                                   {"1,", "refused", ""},
                                   {"-1", "refused", ""},
                                   {"1..2..3", "refused", ""},
                                   {"", "refused", ""}};
  for (const Case& c : cases) {
    const std::string line = error_of([&] { (void)parse_seeds(c.typed); });
    EXPECT_EQ(line.rfind("--seeds: '" + c.typed + "'", 0), 0U) << c.typed << " -> " << line;
    wild_row("Command line", "--seeds '" + c.typed + "'", c.before, line);
  }
}

TEST(Commit, ChangesOfTheSourcesHaveAHash) {
  const testing_support::TempFolder folder;
  const auto git = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"git", "-C", folder.path(), "-c", "user.name=a", "-c", "user.email=a@b"});
    ASSERT_TRUE(output_of(words).has_value());
  };
  const auto write = [&](const std::string& name, const char* text) { std::ofstream(folder.file(name)) << text; };
  EXPECT_EQ(commit_of(folder.path()), "unknown");
  fs::create_directories(folder.path() / "test/results");
  write("source.cpp", "1");
  write("test/results/seed.md", "1");
  git({"init", "-q"});
  git({"add", "."});
  git({"commit", "-qm", "first"});
  const std::string commit = commit_of(folder.path());
  EXPECT_EQ(commit.size(), 12U) << commit;
  write("test/results/seed.md", "2");
  EXPECT_EQ(commit_of(folder.path()), commit);
  write("source.cpp", "2");
  const std::string changed = commit_of(folder.path());
  EXPECT_EQ(changed.rfind(commit + "-dirty-", 0), 0U) << changed;
  write("source.cpp", "3");
  EXPECT_NE(commit_of(folder.path()), changed);
  write("source.cpp", "2");
  EXPECT_EQ(commit_of(folder.path()), changed);
}

}  // namespace
}  // namespace rover
