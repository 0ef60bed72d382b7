#include "tools/campaign/session.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "common/bus/config.hpp"
#include "common/bus/text_file.hpp"
#include "tools/campaign/engine.hpp"
#include "tools/campaign/folder.hpp"
#include "tools/campaign/progress_line.hpp"
#include "tools/launcher/folder_lock.hpp"

namespace rover::campaign {
namespace {

namespace fs = std::filesystem;

class SessionTest : public testing::Test {
 protected:
  SessionTest() {
    std::string name = "/tmp/campaign-session-XXXXXX";
    dir_ = mkdtemp(name.data());
  }
  ~SessionTest() override { fs::remove_all(dir_); }
  static Row row(std::int64_t seed) { return {"abc", {{"scenario", "enav"}}, seed, 1, "done", "goal_reached", {}, {}}; }
  std::string dir_;
};

TEST_F(SessionTest, RowsOfAKilledSessionAreInTheNextOne) {
  Store store = Store::create(dir_);
  Session::begin(dir_, store).write_row(1, row(7));
  EXPECT_EQ(store.size(), 0);
  Session::begin(dir_, store);
  EXPECT_EQ(store.rows(), std::vector<Row>{row(7)});
}

TEST_F(SessionTest, RowsOfASessionKilledWhileItEndedTheOneBeforeAreThere) {
  Store store = Store::create(dir_);
  const Session killed = Session::begin(dir_, store);
  killed.write_row(1, row(7));
  fs::rename(killed.work(), dir_ + "/closed-abcdef");
  Session::begin(dir_, store);
  EXPECT_EQ(store.size(), 1);
  EXPECT_FALSE(fs::exists(dir_ + "/closed-abcdef"));
}

TEST_F(SessionTest, AWorkerOfAnEarlierSessionWritesNoRow) {
  Store store = Store::create(dir_);
  const Session earlier = Session::begin(dir_, store);
  const Session session = Session::begin(dir_, store);
  EXPECT_FALSE(earlier.is_open());
  EXPECT_THROW(earlier.write_row(1, row(7)), ConfigError);
  session.collect(store);
  EXPECT_EQ(store.size(), 0);
}

TEST_F(SessionTest, ARowThatIsCollectedTwiceIsOne) {
  Store store = Store::create(dir_);
  const Session session = Session::begin(dir_, store);
  session.write_row(1, row(7));
  session.collect(store);
  session.write_row(1, row(7));
  session.collect(store);
  EXPECT_EQ(store.size(), 1);
}

TEST_F(SessionTest, TwoAttemptsThatWriteTheSameRowHaveFilesOfTheirOwn) {
  Store store = Store::create(dir_);
  const Session session = Session::begin(dir_, store);
  std::ofstream(session.work() + "/rows/1.json.new") << "half";
  session.write_row(1, row(7));
  EXPECT_EQ(read_text(session.work() + "/rows/1.json.new", 100), "half");
  session.collect(store);
  EXPECT_EQ(store.size(), 1);
}

TEST_F(SessionTest, TheEndLeavesNoSessionBehind) {
  Store store = Store::create(dir_);
  const Session session = Session::begin(dir_, store);
  fs::create_directories(dir_ + "/closed-abcdef/runs/1-1");  // a drive went on while its session was ended
  session.remove();
  EXPECT_FALSE(fs::exists(dir_ + "/closed-abcdef"));
  EXPECT_FALSE(fs::exists(session.work()));
}

TEST_F(SessionTest, AWorkerSaysWhyItClosesTheSession) {
  Store store = Store::create(dir_);
  const Session session = Session::begin(dir_, store);
  EXPECT_EQ(session.reason_to_close(), "");
  session.close_because("job 3: another commit");
  EXPECT_FALSE(session.is_open());
  EXPECT_EQ(session.reason_to_close(), "job 3: another commit");
}

// A limit on the size of a file stops the write as a full disk does: in its middle.
TEST_F(SessionTest, HalfARowIsNoRow) {
  Store store = Store::create(dir_);
  const Session session = Session::begin(dir_, store);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{20, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  std::string problem;
  try {
    session.write_row(1, row(7));
  } catch (const ConfigError& error) {
    problem = error.what();
  }
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_NE(problem.find("/rows/1.json: cannot be written: "), std::string::npos) << problem;
  EXPECT_TRUE(fs::is_empty(session.work() + "/rows"));
}

TEST_F(SessionTest, OneCampaignAtATimeInAFolder) {
  const FolderLock lock(dir_, "in use");
  try {
    const FolderLock second(dir_, "in use");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_EQ(std::string(error.what()).find(dir_ + ": in use"), 0U);
  }
}

TEST(Engine, AMissingProgramIsOneLineWithThePackage) {
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  std::string problem;
  try {
    make_engine("slurm");
  } catch (const ConfigError& error) {
    problem = error.what();
  }
  setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(problem,
            "--engine slurm: the program 'sbatch' is not installed; Debian has it in the package slurm-client");
}

TEST(Progress, TellsRowsAndWhatIsLeft) {
  EXPECT_EQ(progress_text(0, 40, 0, 12.0), "0 of 40 drives (0 %)");
  EXPECT_EQ(progress_text(40, 40, 10, 12.0), "40 of 40 drives (100 %)");
  // 10 new rows in 100 s, 20 are missing.
  EXPECT_EQ(progress_text(20, 40, 10, 100.0).find("20 of 40 drives (50 %), 3 min 20 s left, ends at "), 0U);
  EXPECT_EQ(duration_text(7'500.0), "2 h 05 min");
}

}  // namespace
}  // namespace rover::campaign
