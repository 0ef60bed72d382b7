#include "tools/campaign/store.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "common/bus/config.hpp"

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
  EXPECT_EQ(store.figure_names(), (std::vector<std::string>{"path_ratio", "seconds.curve"}));
  EXPECT_EQ(store.rows_where("outcome = 'no_path'"), std::vector<Row>{second});
}

TEST_F(StoreTest, AKeyThatIsPresentIsNotAddedAgain) {
  Store store = Store::create(dir_);
  store.add(row("0.05", 1, "goal_reached", 1.0));
  store.add({row("0.05", 1, "no_path", 3.0), row("0.05", 2, "goal_reached", 2.0)});
  ASSERT_EQ(store.size(), 2);
  EXPECT_EQ(store.rows().front().outcome, "goal_reached");
  EXPECT_TRUE(store.keys("abc").contains({cell_text({{"scenario", "enav"}, {"rock_area", "0.05"}}), 2}));
  EXPECT_TRUE(store.keys("other").empty());
}

TEST_F(StoreTest, ValuesOfACellAreSortedAndHaveTheirSeeds) {
  Store store = Store::create(dir_);
  store.add({row("0.05", 1, "goal_reached", 1.5), row("0.05", 2, "goal_reached", 1.1), row("0.05", 3, "no_path", 9.0),
             row("0.05", 4, "goal_reached", 1.2), row("0.2", 1, "no_path", 1.0)});
  const auto reached = store.values_of("path_ratio");
  ASSERT_EQ(reached.size(), 1U);
  EXPECT_EQ(reached[0].values, (std::vector<double>{1.1, 1.2, 1.5}));
  EXPECT_EQ(reached[0].seeds, (std::vector<std::int64_t>{2, 4, 1}));
  EXPECT_EQ(reached[0].median(), 1.2);
  EXPECT_EQ(store.values_of("path_ratio", false).size(), 2U);
  EXPECT_TRUE(store.values_of("no_such_figure").empty());
  const auto outcomes = store.outcomes();
  ASSERT_EQ(outcomes.size(), 3U);
  EXPECT_EQ(outcomes[0].outcome, "goal_reached");
  EXPECT_EQ(outcomes[0].drives, 3);
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
  store.add(row("0.05", 1, "goal_reached", 1.0));
  Row bad = row("0.05", 3, "goal_reached", 1.0);
  bad.figures["SEED"] = 1.0;  // SQLite's names have no case
  EXPECT_THROW(store.add({row("0.05", 2, "goal_reached", 1.0), bad}), ConfigError);
  EXPECT_EQ(store.size(), 1);
  store.add(row("0.05", 2, "goal_reached", 1.0));
  EXPECT_EQ(store.size(), 2);
}

// 100,000 rows of 60 figures in 72 cells.
TEST_F(StoreTest, ManyRowsAggregateInSeconds) {
  Store store = Store::create(dir_);
  std::vector<Row> rows;
  for (int i = 0; i < 100'000; ++i) {
    rows.push_back(row(std::to_string(i % 72), i / 72, i % 3 == 0 ? "no_path" : "goal_reached", 1.0 + i % 100));
    for (int k = 0; k < 60; ++k) rows.back().figures["figure_" + std::to_string(k)] = i + k;
    if (rows.size() == 2000) {
      store.add(rows);
      rows.clear();
    }
  }
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(store.size(), 100'000);
  EXPECT_EQ(store.outcomes().size(), 72U);
  EXPECT_EQ(store.values_of("path_ratio").size(), 48U);
  EXPECT_EQ(store.values_of("figure_59", false).size(), 72U);
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  RecordProperty("aggregates_ms", static_cast<int>(1e3 * took_s));
  std::printf("three aggregates of 100,000 rows: %.2f s\n", took_s);
  EXPECT_LT(took_s, 10.0);
}

TEST(Row, MetricsBecomeFiguresAndTexts) {
  Row row;
  add_metrics(nlohmann::json::parse(R"({"outcome": "no_path", "seed": 9, "commit": "x", "level": "full", "regret": null,
      "oracle_feasible": true, "seconds": {"curve": 1.5, "deep": {"er": 2}}, "level_switches": [1, 2],
      "services": {"slam": {"cpu_s": 3.0}}, "fdir": [{"id": "a"}, {"id": "vo_lost"}]})"),
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
