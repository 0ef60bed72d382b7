#include "tools/campaign/store.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>

#include "common/bus/config.hpp"
#include "tools/campaign/sqlite.hpp"

namespace rover::campaign {
namespace {

namespace fs = std::filesystem;

class StoreTest : public testing::Test {
 protected:
  StoreTest() {
    std::string name = "/tmp/campaign-store-XXXXXX";
    dir_ = mkdtemp(name.data());
  }
  ~StoreTest() override { fs::remove_all(dir_); }
  std::string dir_;
};

Row row(const std::string& rock_area, std::int64_t seed, const std::string& outcome, double ratio) {
  return {"abc", {{"scenario", "enav"}, {"rock_area", rock_area}}, seed, 1, "done", outcome, {{"path_ratio", ratio}},
          {}};
}

TEST_F(StoreTest, RowsComeBackAsTheyWereAdded) {
  Row first = row("0.05", 2, "goal_reached", 1.25);
  first.figures["seconds.curve"] = 0.1;
  first.texts["fault"] = "pose_age; drop \"rows\"";
  Row second = row("0.1", 1, "no_path", NAN);
  second.figures.clear();
  Store store = Store::create(dir_);
  store.add({second, first});
  EXPECT_EQ(store.rows(), (std::vector<Row>{first, second}));  // by text of the cell
  EXPECT_EQ(Store::open(dir_).rows(), store.rows());
}

TEST_F(StoreTest, RowsHaveTheColumnsThatAreAskedFor) {
  Row stored = row("0.05", 2, "fault_stop", 1.25);
  stored.figures["seconds.curve"] = 0.1;
  stored.texts = {{"fault", "pose_age"}, {"level", "full"}};
  Store store = Store::create(dir_);
  store.add({stored});
  stored.figures.erase("seconds.curve");
  stored.texts.erase("level");
  EXPECT_EQ(store.rows({"path_ratio", "fault", "no_such_figure"}), std::vector<Row>{stored});
}

TEST_F(StoreTest, AKeyThatIsPresentIsNotAddedAgain) {
  Store store = Store::create(dir_);
  store.add({row("0.05", 1, "goal_reached", 1.0)});
  store.add({row("0.05", 1, "no_path", 3.0), row("0.05", 2, "goal_reached", 2.0)});
  ASSERT_EQ(store.size(), 2);
  EXPECT_EQ(store.rows().front().outcome, "goal_reached");
  EXPECT_TRUE(store.keys("abc").contains({cell_text({{"scenario", "enav"}, {"rock_area", "0.05"}}), 2}));
  EXPECT_TRUE(store.keys("other").empty());
}

TEST_F(StoreTest, AFolderWithoutStoreIsOneLine) {
  try {
    Store::open(dir_);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.what(), dir_ + ": not the folder of a campaign: no campaign.sqlite");
  }
}

TEST_F(StoreTest, NothingOfABatchIsAddedIfOneRowCannotBe) {
  Store store = Store::create(dir_);
  store.add({row("0.05", 1, "goal_reached", 1.0)});
  Row bad = row("0.05", 3, "goal_reached", 1.0);
  bad.figures["SEED"] = 1.0;  // SQLite's names have no case
  EXPECT_THROW(store.add({row("0.05", 2, "goal_reached", 1.0), bad}), ConfigError);
  EXPECT_EQ(store.size(), 1);
  store.add({row("0.05", 2, "goal_reached", 1.0)});
  EXPECT_EQ(store.size(), 2);
}

// A writer that is killed in a transaction leaves a journal; the page reads what was there before.
TEST_F(StoreTest, ReadsWhatAKilledWriterLeft) {
  Store::create(dir_).add({row("0.05", 1, "goal_reached", 1.0)});
  const pid_t writer = fork();
  if (writer == 0) {
    const Database database(dir_ + "/campaign.sqlite", true);
    database.execute("PRAGMA cache_size = 1; BEGIN; CREATE TABLE many (x)");
    for (int i = 0; i < 500; ++i) database.execute("INSERT INTO many VALUES (zeroblob(1000))");
    kill(getpid(), SIGKILL);
  }
  waitpid(writer, nullptr, 0);
  ASSERT_TRUE(fs::exists(dir_ + "/campaign.sqlite-journal"));
  EXPECT_EQ(Store::open(dir_).size(), 1);
}

TEST(Row, MetricsBecomeFiguresAndTexts) {
  Row row;
  add_metrics(nlohmann::json::parse(R"({"outcome": "no_path", "seed": 9, "commit": "x", "level": "full", "regret": null,
      "oracle_feasible": true, "seconds": {"curve": 1.5, "deep": {"er": 2}}, "level_switches": [1, 2],
      "services": {"slam": {"cpu_s": 3.0}}, "realtime_factor": 4.5, "wall_s": 81.2,
      "fdir": [{"id": "a", "response": "stop"}, {"id": "vo_lost", "response": "stop_replan"},
               {"id": "b", "response": "slow"}, {"id": "c", "response": "log"}]})"),
              row);
  EXPECT_EQ(row.outcome, "no_path");
  EXPECT_EQ(row.figures, (std::map<std::string, double>{
                             {"oracle_feasible", 1.0}, {"seconds.curve", 1.5}, {"seconds.deep.er", 2.0}}));
  EXPECT_EQ(row.texts, (std::map<std::string, std::string>{{"fault", "vo_lost"}, {"level", "full"}}));
}

TEST(Row, ALineComesBackAsTheSameRow) {
  Row row{"abc-dirty",
          {{"slope_deg", "12.5"}, {"rock_area", "0.05"}, {"soil", "sand"}, {"a.b", "1e-07"}},
          7,
          2,
          "done",
          "goal_reached",
          {{"path_ratio", 0.1 + 0.2}},
          {{"level", "full"}}};
  EXPECT_EQ(parse_row(json_line(row), "here"), row);
  EXPECT_NE(json_line(row).find("\"slope_deg\":12.5"), std::string::npos);
  EXPECT_EQ(parse_cell(cell_text(row.cell)), row.cell);
}

TEST(Row, HalfALineIsRefused) {
  const std::string line = json_line(row("0.05", 1, "goal_reached", 1.0));
  try {
    parse_row(line.substr(0, line.size() / 2), "rows.jsonl:3");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_EQ(std::string(error.what()).find("rows.jsonl:3: not a row of a campaign"), 0U);
  }
}

TEST(Row, NumbersHaveOneForm) {
  EXPECT_EQ(short_value("5.0"), "5");
  EXPECT_EQ(short_value("5e-2"), "0.05");
  EXPECT_EQ(short_value("0.10"), "0.1");
  EXPECT_EQ(short_value("down"), "down");
}

}  // namespace
}  // namespace rover::campaign
