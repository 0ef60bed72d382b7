#include "tools/status/processes.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "test/common/temp_folder.hpp"
#include "tools/status/running_run.hpp"

namespace rover::status {
namespace {
namespace fs = std::filesystem;

class Folder : public testing::Test {
 protected:
  ~Folder() override {
    for (const int fd : open_) close(fd);
  }
  // Creates a run folder as s6-svscan leaves it; `running`: with a reader on its control pipe.
  fs::path run(const std::string& name, bool running) {
    const fs::path scan = root_ / name / "services" / ".s6-svscan";
    fs::create_directories(scan);
    mkfifo((scan / "control").c_str(), 0600);
    if (running) open_.push_back(open((scan / "control").c_str(), O_RDONLY | O_NONBLOCK));
    return root_ / name;
  }
  void begun(const fs::path& run, int seconds_ago) {
    fs::last_write_time(run / "services" / ".s6-svscan",
                        fs::file_time_type::clock::now() - std::chrono::seconds(seconds_ago));
  }

  testing_support::TempFolder folder_;
  fs::path root_ = folder_.path();
  std::vector<int> open_;
};

TEST_F(Folder, FindsNewestRunningRun) {
  begun(run("20250101-000000-flat", true), 30);
  begun(run("bench/seed/seed_traverse_1-2", true), 20);
  begun(run("20250101-000002-flat", false), 10);
  fs::create_directories(root_ / "no run");
  EXPECT_EQ(newest_running(root_), (root_ / "bench/seed/seed_traverse_1-2").string());
  EXPECT_TRUE(is_running(root_ / "20250101-000000-flat"));
  EXPECT_FALSE(is_running(root_ / "20250101-000002-flat"));
}

TEST_F(Folder, FindsNoRunIfNoneIsRunning) {
  EXPECT_FALSE(newest_running(root_ / "missing").has_value());
  EXPECT_FALSE(newest_running(root_).has_value());
  run("20250101-000000-flat", false);
  EXPECT_FALSE(newest_running(root_).has_value());
}

TEST_F(Folder, ServicesDownInS6AreDead) {
  const fs::path dir = run("dead", true);
  fs::create_directories(dir / "services" / "stereo");
  fs::create_directories(dir / "services" / "recorder");
  fs::create_directories(dir / "boots");
  fs::create_directories(dir / "exits");
  std::ofstream(dir / "boots" / "stereo") << "4\n";
  std::ofstream(dir / "exits" / "stereo") << "256 9\n0 0\n256 9\n";  // one was stopped
  Processes processes(dir);
  processes.sample({{"stereo", getpid()}}, 0.0);
  ASSERT_EQ(processes.figures().size(), 2u);
  const ProcessFigures& stereo = processes.figures().at("stereo");
  EXPECT_FALSE(stereo.alive) << "the bus does not overrule s6";
  EXPECT_EQ(stereo.restarts, 2);
  EXPECT_FALSE(processes.figures().at("recorder").restarts.has_value());
}

TEST(Processes, CpuLoadIsMeasuredBetweenTwoSamples) {
  Processes processes("");
  const std::map<std::string, int> reported_pids = {{"me", getpid()}, {"nobody", 0}};
  processes.sample(reported_pids, 10.0);
  EXPECT_TRUE(processes.figures().at("me").alive);
  EXPECT_FALSE(processes.figures().at("nobody").alive);
  EXPECT_TRUE(std::isnan(processes.figures().at("me").cpu_percent));
  EXPECT_GT(processes.figures().at("me").rss_mb, 0.5);
  const double begin_s = usage_of(getpid()).cpu_s;
  while (usage_of(getpid()).cpu_s < begin_s + 0.2) {
  }
  processes.sample(reported_pids, 11.0);
  EXPECT_GE(processes.figures().at("me").cpu_percent, 20.0);
  EXPECT_LT(processes.figures().at("me").cpu_percent, 60.0);
  EXPECT_FALSE(processes.figures().at("me").restarts.has_value());
}

}  // namespace
}  // namespace rover::status
