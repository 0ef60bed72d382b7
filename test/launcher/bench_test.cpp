// ./rover bench with made-up drives: a script in place of the launcher.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "../common/temp_folder.hpp"
#include "common/bus/config.hpp"
#include "tools/launcher/bench_command.hpp"
#include "tools/launcher/folder_lock.hpp"

namespace rover {
namespace {

namespace fs = std::filesystem;

class BenchTest : public testing::Test {
 protected:
  BenchTest() {
    fs::create_directories(folder_.path() / "bin");
    program("rover_bench_table", "touch " + folder_.file("table"));
    reaches_its_goal();
  }
  void program(const std::string& name, const std::string& script) {
    const fs::path file = folder_.path() / "bin" / name;
    std::ofstream(file) << "#!/bin/bash\ncd " << folder_.path() << "\n" << script << "\n";
    fs::permissions(file, fs::perms::owner_all);
  }
  // A drive with its arguments in the file `commands`; `script` knows its folder as $out.
  void drive(const std::string& script) {
    program("rover_launcher",
            "echo \"$*\" >>commands\nwhile [ $# -gt 1 ]; do [ $1 != --out ] || out=$2; shift; done\n" + script);
  }
  void reaches_its_goal(const std::string& commit = "unknown") {
    drive(R"(mkdir $out; echo '{"outcome": "goal_reached", "commit": ")" + commit + R"("}' >$out/metrics.json)");
  }
  BenchArguments arguments(const std::string& seeds) const {
    BenchArguments bench;
    bench.run.source_dir = folder_.path();
    bench.run.bin_dir = folder_.file("bin");
    bench.suite = "default";
    bench.seeds = seeds;
    return bench;
  }
  std::string refusal(const BenchArguments& bench_arguments) {
    try {
      bench(bench_arguments);
    } catch (const ConfigError& error) {
      return folder_.short_names(error.what());
    }
    return "accepted";
  }
  std::string text(const std::string& name) const {
    std::ifstream in(folder_.file(name));
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::string rows() const { return text(kRows); }
  bool has_table() const { return fs::exists(folder_.file("table")); }

  static constexpr const char* kRows = "logs/bench/default/efficient/rows.jsonl";
  testing_support::TempFolder folder_;
};

TEST_F(BenchTest, EachDriveIsARow) {
  EXPECT_EQ(bench(arguments("1..3")), 0);
  const std::string lines = rows();
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 3);
  EXPECT_TRUE(has_table());
  EXPECT_NE(text("commands").find("default.yaml --seed 2 --level efficient --headless"), std::string::npos);
}

TEST_F(BenchTest, RefusedDriveEndsTheBenchAndLeavesRowsAndTable) {
  bench(arguments("1"));
  fs::remove(folder_.file("table"));
  const std::string before = rows();
  drive("echo '--set nothing.key=1: there is no config/nothing.yaml' >&2; exit 2");
  EXPECT_EQ(refusal(arguments("1..3")), "--set nothing.key=1: there is no config/nothing.yaml");
  EXPECT_EQ(rows(), before);
  EXPECT_FALSE(has_table());
}

TEST_F(BenchTest, DriveThatDiesIsARowAndIsRepeated) {
  drive("mkdir $out; exit 2");
  EXPECT_EQ(bench(arguments("1")), 0);
  EXPECT_NE(rows().find("\"died\""), std::string::npos);
  reaches_its_goal();
  BenchArguments again = arguments("1");
  again.resume = true;
  bench(again);
  EXPECT_EQ(rows().find("\"died\""), std::string::npos);
  EXPECT_NE(rows().find("goal_reached"), std::string::npos);
}

TEST_F(BenchTest, ParallelDrivesHaveBusesOfTheirOwn) {
  drive("mkdir $out; touch running-$$; until [ $(ls -d running-* | wc -l) = 2 ]; do sleep 0.02; done; exit 1");
  BenchArguments two = arguments("1,2");
  two.jobs = 2;
  bench(two);
  const std::string commands = text("commands");
  const size_t first = commands.find("udpm://"), second = commands.rfind("udpm://");
  EXPECT_NE(commands.substr(first, 30), commands.substr(second, 30));
}

TEST_F(BenchTest, SecondBenchOfASuiteIsRefused) {
  const FolderLock lock(folder_.file("logs/bench/default"), "");
  EXPECT_EQ(refusal(arguments("1")), "logs/bench/default: another bench of this suite runs; wait for its end");
}

TEST_F(BenchTest, InterruptedBenchEndsItsDrivesAndWritesNeitherRowNorTable) {
  drive("mkdir $out; trap 'touch ended; exit 1' TERM; kill -TERM $PPID; while :; do sleep 0.02; done");
  EXPECT_EXIT(std::_Exit(bench(arguments("1..3"))), testing::ExitedWithCode(1), "stopped; continue with --resume");
  EXPECT_TRUE(fs::exists(folder_.file("ended")));
  EXPECT_EQ(rows(), "");
  EXPECT_FALSE(has_table());
}

TEST_F(BenchTest, ResumedWithOtherSettingsIsRefused) {
  BenchArguments first = arguments("1");
  first.run.set = {"vehicle.a=1"};
  bench(first);
  BenchArguments again = arguments("1..2");
  again.resume = true;
  EXPECT_EQ(refusal(again), std::string(kRows) +
                                ": its drives are with '--level efficient --set vehicle.a=1', these with '--level "
                                "efficient'; begin again without --resume");
  again.run.set = first.run.set;
  EXPECT_EQ(refusal(again), "accepted");
}

TEST_F(BenchTest, DriveOfAnotherCommitIsRefused) {
  reaches_its_goal("0123456789ab");
  EXPECT_EQ(refusal(arguments("1")), "default seed 1: its drive is of commit 0123456789ab, the bench of unknown");
  EXPECT_EQ(rows(), "");
  fs::create_directories(folder_.path() / "logs/bench/default/efficient");
  std::ofstream(folder_.file(kRows)) << R"({"commit": "0123456789ab", "scenario": "default", "seed": 1})"
                                     << "\n";
  BenchArguments again = arguments("1..2");
  again.resume = true;
  EXPECT_EQ(refusal(again), std::string(kRows) +
                                ": its drives are of commit '0123456789ab', these of commit 'unknown'; begin again "
                                "without --resume");
}

}  // namespace
}  // namespace rover
