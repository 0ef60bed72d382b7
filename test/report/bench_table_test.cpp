#include "tools/report/bench_table.hpp"

#include <gtest/gtest.h>

#include "common/bus/config.hpp"
#include "tools/report/bench_rows.hpp"

namespace rover::report {
namespace {

BenchRow good(const std::string& scenario, std::int64_t seed) {
  BenchRow row;
  row.commit = "abc";
  row.scenario = scenario;
  row.seed = seed;
  row.deterministic = true;
  row.outcome = "goal_reached";
  row.planned_length_m = scenario == "seed_traverse_1" ? 86.0 : 62.2;
  row.driven_length_m = 1.05 * row.planned_length_m;
  row.path_ratio = 1.05;
  row.replans = 9;
  row.hazard_stops = 1;
  row.collisions = row.rocks_missed = row.false_stops = row.faults = 0;
  row.rocks_encountered = 20;
  row.odometry_drift_percent = 0.4;
  row.cross_track_rms_m = 0.03;
  row.final_error_m = 0.5;
  row.mean_speed_m_per_h = 600;
  row.duty = 0.85;
  row.realtime_factor = 4.0;
  return row;
}

std::vector<BenchRow> full_bench() {
  std::vector<BenchRow> rows;
  for (int seed = 1; seed <= 10; ++seed) {
    rows.push_back(good("seed_traverse_1", seed));
    rows.push_back(good("seed_traverse_2", seed));
  }
  return rows;
}

int met(const std::vector<Gate>& gates) {
  int count = 0;
  for (const Gate& gate : gates) count += gate.met ? 1 : 0;
  return count;
}

TEST(Median, OddEvenNoneAndUnknown) {
  EXPECT_EQ(median({3, 1, 2}), 2.0);
  EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
  EXPECT_TRUE(std::isnan(median({})));
  EXPECT_EQ(median({kNaN, 5.0}), 5.0);
}

TEST(BenchTable, GoodBenchmarkMeetsEveryRequirement) {
  const std::vector<Gate> gates = seed_gates(full_bench());
  EXPECT_EQ(met(gates), static_cast<int>(gates.size()));
}

// Each requirement fails when its own metric does.
TEST(BenchTable, EachMetricFailsItsOwnRequirement) {
  const std::vector<std::function<void(BenchRow&)>> faults = {[](BenchRow& r) { r.outcome = "timeout"; },
                                                              [](BenchRow& r) { r.collisions = 1; },
                                                              [](BenchRow& r) { r.rocks_missed = 1; },
                                                              [](BenchRow& r) { r.faults = 1; },
                                                              [](BenchRow& r) { r.path_ratio = 1.13; },
                                                              [](BenchRow& r) { r.odometry_drift_percent = 1.1; },
                                                              [](BenchRow& r) { r.cross_track_rms_m = 0.11; },
                                                              [](BenchRow& r) { r.final_error_m = 1.8; },
                                                              [](BenchRow& r) { r.duty = 0.74; },
                                                              [](BenchRow& r) { r.deterministic = false; }};
  for (size_t i = 0; i < faults.size(); ++i) {
    std::vector<BenchRow> rows = full_bench();
    for (BenchRow& row : rows) faults[i](row);
    const std::vector<Gate> gates = seed_gates(rows);
    EXPECT_FALSE(gates[i].met) << gates[i].requirement;
    EXPECT_EQ(met(gates), static_cast<int>(gates.size()) - 1) << gates[i].requirement;
  }
}

TEST(BenchTable, UnknownMetricMeetsNoRequirement) {
  std::vector<BenchRow> rows = full_bench();
  rows[0].rocks_missed = kNaN;
  EXPECT_FALSE(seed_gates(rows)[2].met);
  EXPECT_FALSE(seed_gates({})[0].met);
}

TEST(BenchTable, EveryRunCountsHoweverFewItsRepairs) {
  std::vector<BenchRow> rows = full_bench();
  rows[0].replans = 0;
  EXPECT_TRUE(seed_gates(rows)[0].met);
  EXPECT_NE(bench_table({"seed", "cmd", "cpu", 2}, rows).find("here, all 20 runs"), std::string::npos);
  rows.pop_back();
  EXPECT_FALSE(seed_gates(rows)[0].met) << "19 of 19";
}

TEST(BenchTable, TakesTheNewestCommitAndTheLastRunOfASeed) {
  std::vector<BenchRow> rows = full_bench();
  for (BenchRow& row : rows) row.commit = "old";
  rows.push_back(good("seed_traverse_1", 3));
  rows.push_back(good("seed_traverse_1", 3));
  rows.back().duty = 0.9;
  const std::vector<BenchRow> newest = newest_rows(rows);
  ASSERT_EQ(newest.size(), 1u);
  EXPECT_EQ(newest[0].duty, 0.9);
}

TEST(BenchTable, EachLevelHasItsOwnNewestCommit) {
  std::vector<BenchRow> rows = {good("default", 101), good("default", 101), good("default", 102)};
  rows[0].level = "efficient";
  rows[1].level = rows[2].level = "auto";
  rows[1].commit = "old";
  const std::vector<BenchRow> newest = newest_rows(rows);
  ASSERT_EQ(newest.size(), 2u);
  EXPECT_EQ(newest[0].seed, 102) << "auto";
  EXPECT_EQ(newest[1].level, "efficient");
}

TEST(BenchTable, ProgressRegretAndTimeByCauseAreInTheTable) {
  std::vector<BenchRow> rows = full_bench();
  for (BenchRow& row : rows) {
    row.progress = 0.812;
    row.regret = 1.034;
    row.seconds = {{"straight", 60.0}, {"point_turn", 39.0}, {"fault", 1.0}, {"sweep", 0.0}};
  }
  const std::string table = bench_table({"seed", "cmd", "cpu", 2}, rows);
  EXPECT_NE(table.find("Median progress 0.812, regret 1.034, duty 0.850"), std::string::npos) << table;
  EXPECT_NE(table.find("Time by cause [%]: straight 60.0, point turn 39.0, fault 1.0.\n"), std::string::npos);
}

TEST(BenchTable, ConsistencyOfThePoseIsTheMeanOfTheDrivesThatCount) {
  std::vector<BenchRow> rows = full_bench();
  for (BenchRow& row : rows) row.anees_x = row.anees_y = row.anees_yaw = row.anees_xyyaw = 1.0;
  rows[0].anees_x = 3.0;
  const std::string line =
      "ANEES of POSE, mean of 20 drives with 10 start poses: x 1.10, y 1.00, yaw 1.00 (consistent: 0.32 to 2.05); "
      "together 1.00 (0.56 to 1.57).";
  const std::string table = bench_table({"seed", "cmd", "cpu", 2}, rows);
  EXPECT_NE(table.find(line), std::string::npos) << table;
  rows[1].anees_yaw = kNaN;
  EXPECT_NE(bench_table({"seed", "cmd", "cpu", 2}, rows).find("yaw n/a"), std::string::npos) << "unknown is not good";
}

// Four drives at the Efficient level: two reach the goal, one gives up, one died without metrics.
std::vector<BenchRow> four_drives() {
  std::vector<BenchRow> rows;
  for (int seed = 101; seed <= 104; ++seed) rows.push_back(good("default", seed));
  for (BenchRow& row : rows) {
    row.level = "efficient";
    row.command = "./rover bench default";
    row.progress = 0.7;
    row.oracle_feasible = true;
    row.regret = 1.1;
  }
  rows[1].path_ratio = 2.13;
  rows[1].progress = 0.3;
  rows[1].oracle_feasible = false;
  rows[2].outcome = "no_path";
  rows[2].path_ratio = 0.1;
  rows[2].progress = 0.05;
  BenchRow died;
  died.commit = "abc";
  died.scenario = "default";
  died.level = "efficient";
  died.seed = 104;
  died.outcome = "died";
  died.command = rows[0].command;
  rows[3] = died;
  return rows;
}

TEST(SuccessTable, SaysHowManyReachTheGoalWithItsInterval) {
  const std::string table = success_table({"default", "cmd", "cpu", 2}, four_drives());
  // Wilson's interval of 2 of 4 is 15 to 85 %, of 1 of 2 9 to 91 %.
  EXPECT_NE(table.find("| efficient | 2 of 4 (50 %; 15 to 85 %) | 2 of 3 | 1 of 2 (50 %; 9 to 91 %) |"),
            std::string::npos)
      << table;
  EXPECT_NE(table.find("failures: died (seeds 104); no_path (seeds 103)"), std::string::npos) << table;
}

TEST(SuccessTable, RatioIsOfDrivesThatReachedTheGoalAndProgressOfAll) {
  const std::string table = success_table({"default", "cmd", "cpu", 2}, four_drives());
  EXPECT_NE(table.find("| 1.590; 2.130 | 1.100; 1.100 | 0.300; 0.050 |"), std::string::npos) << table;
}

TEST(SuccessTable, ADriveThatDiedIsARowAndMeetsNoRequirement) {
  const std::string table = success_table({"default", "cmd", "cpu", 2}, four_drives());
  EXPECT_NE(table.find("| default | 104 | died | n/a |"), std::string::npos) << table;
  EXPECT_NE(table.find("| 0 (1 unknown) | 0 (1 unknown) | 0 (1 unknown) |"), std::string::npos) << table;
  for (const Gate& gate : success_gates(four_drives())) EXPECT_FALSE(gate.met) << gate.requirement;
  std::vector<BenchRow> rows = four_drives();
  rows.pop_back();
  for (const Gate& gate : success_gates(rows)) EXPECT_TRUE(gate.met) << gate.requirement;
}

TEST(SuccessTable, UnknownOracleIsSaid) {
  std::vector<BenchRow> rows = four_drives();
  for (BenchRow& row : rows) {
    row.oracle_feasible.reset();
    row.regret = kNaN;
  }
  const std::string table = success_table({"default", "cmd", "cpu", 2}, rows);
  EXPECT_NE(table.find("15 to 85 %) | n/a | n/a | 1.590; 2.130 | n/a |"), std::string::npos) << table;
}

TEST(SuccessTable, EachLevelHasASection) {
  std::vector<BenchRow> rows = four_drives();
  for (BenchRow row : four_drives()) {
    row.level = "auto";
    row.outcome = "goal_reached";
    rows.push_back(row);
  }
  const std::string table = success_table({"default", "cmd", "cpu", 2}, rows);
  EXPECT_NE(table.find("| auto | 4 of 4 (100 %; 51 to 100 %)"), std::string::npos) << table;
  EXPECT_LT(table.find("## Level `efficient`"), table.find("## Level `auto`"));
}

TEST(Suites, AreFoundByName) {
  ASSERT_NE(find_suite("seed"), nullptr);
  ASSERT_NE(find_suite("default"), nullptr);
  EXPECT_EQ(find_suite("defaults"), nullptr);
}

TEST(BenchRows, ReadsFiguresAndNull) {
  const std::vector<BenchRow> rows = parse_rows(
      R"({"scenario":"seed_traverse_1","seed":7,"commit":"c","deterministic":true,"duty":0.8,"rocks_missed":null,)"
      R"("progress":0.7,"oracle_feasible":true,"seconds":{"straight":3.5},)"
      R"("anees":{"x":0.5,"y":0.6,"yaw":null,"xyyaw":0.7}})"
      "\n\n",
      "rows.jsonl");
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].seed, 7);
  EXPECT_EQ(rows[0].duty, 0.8);
  EXPECT_EQ(rows[0].progress, 0.7);
  EXPECT_TRUE(std::isnan(rows[0].regret));
  EXPECT_EQ(rows[0].oracle_feasible, true);
  EXPECT_EQ(rows[0].seconds.at("straight"), 3.5);
  EXPECT_EQ(rows[0].anees_x, 0.5);
  EXPECT_EQ(rows[0].anees_xyyaw, 0.7);
  EXPECT_TRUE(std::isnan(rows[0].anees_yaw));
  EXPECT_TRUE(rows[0].deterministic);
  EXPECT_TRUE(std::isnan(rows[0].rocks_missed));
}

TEST(BenchRows, InvalidRowReportsFileAndLine) {
  try {
    parse_rows("{\"scenario\":\"a\",\"seed\":1}\n{\"scen", "rows.jsonl");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_EQ(std::string(error.what()).rfind("rows.jsonl:2: ", 0), 0u) << error.what();
  }
}

}  // namespace
}  // namespace rover::report
