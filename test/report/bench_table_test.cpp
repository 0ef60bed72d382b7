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

TEST(BenchTable, RunsWithFewRepairsAreReplacedByAnotherSeed) {
  std::vector<BenchRow> rows = full_bench();
  rows[0].replans = 4;
  rows[0].path_ratio = 0.5;
  EXPECT_FALSE(counts(rows[0]));
  EXPECT_FALSE(seed_gates(rows)[0].met);
  rows.push_back(good("seed_traverse_1", 11));
  EXPECT_TRUE(seed_gates(rows)[0].met);
  const std::string table = bench_table({"seed", "cmd", "cpu", 2}, rows);
  EXPECT_NE(table.find("## Not counted"), std::string::npos);
  EXPECT_NE(table.find("here, all 20 runs"), std::string::npos);
}

TEST(BenchTable, FailedRunCountsDespiteFewRepairs) {
  BenchRow row = good("seed_traverse_2", 1);
  row.replans = 2;
  EXPECT_FALSE(counts(row));
  row.collisions = 1;
  EXPECT_TRUE(counts(row));
  row.collisions = 0;
  row.outcome = "fault_stop";
  EXPECT_TRUE(counts(row));
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

TEST(BenchRows, ReadsFiguresAndNull) {
  const std::vector<BenchRow> rows = parse_rows(
      R"({"scenario":"seed_traverse_1","seed":7,"commit":"c","deterministic":true,"duty":0.8,"rocks_missed":null})"
      "\n\n",
      "rows.jsonl");
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].seed, 7);
  EXPECT_EQ(rows[0].duty, 0.8);
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
