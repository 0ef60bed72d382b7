#include "tools/campaign/page/comparison.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "made_up_campaign.hpp"
#include "tools/campaign/page/comparison_page.hpp"

namespace rover::campaign {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string page_of(const Comparison& comparison) {
  return comparison_html({"first", "second", "aaa", "bbb", "./rover campaign compare a b"}, comparison);
}

std::string table_of(const Comparison& comparison) {
  return comparison_table({"first", "second", "aaa", "bbb", "./rover campaign compare a b"}, comparison);
}

// `reached` of 20 seeds in a cell reach the goal, each with this ratio.
std::vector<Row> one_cell(const std::string& soil, int reached, double ratio) {
  std::vector<Row> rows;
  for (int seed = 1; seed <= 20; ++seed) {
    Row row{.commit = "c", .cell = {{"soil", soil}}, .seed = seed, .status = "done"};
    row.outcome = seed <= reached ? "goal_reached" : "no_path";
    row.figures = {{"collisions", 0.0}, {"oracle_feasible", 1.0}, {"path_ratio", ratio + 0.001 * seed}};
    rows.push_back(row);
  }
  return rows;
}

std::vector<Row> joined(std::vector<Row> a, const std::vector<Row>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(Compare, SameRowsDifferInNothing) {
  const std::vector<Row> rows = made_up_rows({.seeds = 10});
  const Comparison c = compare(rows, rows);
  EXPECT_EQ(c.pairs, static_cast<int>(rows.size()));
  EXPECT_EQ(c.unpaired_a + c.unpaired_b, 0);
  EXPECT_EQ(c.all.success.difference, 0.0);
  EXPECT_EQ(c.all.success.p, 1.0);
  for (const FigureComparison& figure : c.all.figures) EXPECT_EQ(figure.mean_difference, 0.0);
  EXPECT_THAT(table_of(c), HasSubstr("| Success | 90 | 0 | 0 | 0 |"));
  EXPECT_THAT(page_of(c), Not(HasSubstr("<details")));
}

TEST(Compare, OneChangedCellIsFoundAmongMany) {
  std::vector<Row> a;
  std::vector<Row> b;
  for (const char* soil : {"sand", "firm", "bedrock", "mixed"}) {
    const bool changed = std::string(soil) == "firm";
    a = joined(a, one_cell(soil, 12, 1.2));
    b = joined(b, one_cell(soil, changed ? 20 : 12, changed ? 1.1 : 1.2));
  }
  const Comparison c = compare(a, b);
  int different = 0;
  for (const CellComparison& cell : c.cells) {
    if (differs(cell.pairs.success)) ++different;
    EXPECT_EQ(differs(cell.pairs.success), cell.cell.at("soil") == "firm");
    EXPECT_EQ(differs(cell.pairs.figures[0]), cell.cell.at("soil") == "firm");
  }
  EXPECT_EQ(different, 1);
  EXPECT_NEAR(c.all.success.difference, 8.0 / 80.0, 1e-12);
  EXPECT_NEAR(c.all.success.p, 2.0 / 256.0, 1e-12);
  EXPECT_EQ(c.all.figures[0].pairs, 48);  // goals of both
  EXPECT_THAT(table_of(c), HasSubstr("| soil firm | 20 | 12/20 | 20/20 | +40 % |"));
}

// Ratios of 19 drives fall a little, that of one rises much: median and mean differ in sign.
TEST(Compare, BetterHasTheSignOfTheDifferenceBesideIt) {
  const std::vector<Row> a = one_cell("sand", 20, 1.2);
  std::vector<Row> b = one_cell("sand", 20, 1.15);
  b[4].figures["path_ratio"] = 9.0;
  const Comparison c = compare(a, b);
  ASSERT_LT(c.all.figures[0].median_difference, 0.0);
  ASSERT_GT(c.all.figures[0].mean_difference, 0.0);
  EXPECT_THAT(table_of(c), HasSubstr("| Driven / planned | 1 | 1 | 1 | 0 |"));
}

// 100 cells without a difference beyond noise: the correction lets none, or few, through.
TEST(Compare, NoiseIsNotADifference) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(1.2, 0.1);
  std::vector<Row> a;
  std::vector<Row> b;
  for (int cell = 0; cell < 100; ++cell)
    for (int seed = 1; seed <= 20; ++seed) {
      Row row = one_cell("sand", 20, 1.2)[static_cast<size_t>(seed - 1)];
      row.cell["path_planner.a"] = std::to_string(cell);
      row.figures["path_ratio"] = noise(random);
      a.push_back(row);
      row.figures["path_ratio"] = noise(random);
      b.push_back(row);
    }
  const Comparison c = compare(a, b);
  int below = 0;
  int beyond = 0;
  for (const CellComparison& cell : c.cells) {
    below += cell.pairs.figures[0].p < 0.05 ? 1 : 0;
    beyond += differs(cell.pairs.figures[0]) ? 1 : 0;
  }
  EXPECT_GT(below, 0);
  EXPECT_EQ(beyond, 0);
}

TEST(Compare, ImprovementHasTheRightSignAndItsIntervalLeavesZeroOut) {
  const Comparison c = compare(made_up_rows({.seeds = 20}), made_up_rows({.seeds = 20, .improvement = 0.5}));
  EXPECT_GT(c.all.success.interval.low, 0.0);
  EXPECT_GT(c.success_by_seed.low, 0.0);
  EXPECT_LT(c.all.figures[1].mean_interval.high, 0.0);  // regret
  EXPECT_GT(c.all.figures[2].mean_interval.low, 0.0);   // progress
  EXPECT_THAT(page_of(c), HasSubstr("cells beyond chance</summary>"));
  EXPECT_THAT(page_of(c), Not(HasSubstr("<script")));
}

TEST(Compare, InfeasiblePairsAndDrivesWithoutPartnerAreLeftOut) {
  std::vector<Row> a = one_cell("sand", 20, 1.2);
  std::vector<Row> b = one_cell("sand", 10, 1.2);
  b[19].figures["oracle_feasible"] = 0.0;
  a.pop_back();
  b.erase(b.begin());
  const Comparison c = compare(a, b);
  EXPECT_EQ(c.pairs, 18);
  EXPECT_EQ(c.unpaired_a, 1);
  EXPECT_EQ(c.unpaired_b, 1);
  b[5].figures["oracle_feasible"] = 0.0;
  EXPECT_EQ(compare(a, b).infeasible, 1);
  EXPECT_EQ(compare(a, b).all.success.counts.pairs(), 17);
}

TEST(Compare, CampaignsThatDifferInOneConstantAxisArePaired) {
  std::vector<Row> a = one_cell("sand", 20, 1.2);
  std::vector<Row> b = one_cell("sand", 20, 1.3);
  for (Row& row : a) row.cell["perception"] = "geometric";
  for (Row& row : b) row.cell["perception"] = "rendered";
  const Comparison c = compare(a, b);
  EXPECT_EQ(c.pairs, 20);
  EXPECT_EQ(c.only_a, (Cell{{"perception", "geometric"}}));
  EXPECT_EQ(c.only_b, (Cell{{"perception", "rendered"}}));
  EXPECT_NEAR(c.all.figures[0].median_difference, 0.1, 1e-9);
  EXPECT_THAT(table_of(c), HasSubstr("B: second, commit bbb, rendered perception"));
}

TEST(Compare, AxisThatVariesInOneCampaignIsKept) {
  const std::vector<Row> a = joined(one_cell("sand", 20, 1.2), one_cell("firm", 20, 1.2));
  const Comparison c = compare(a, one_cell("firm", 20, 1.2));
  EXPECT_EQ(c.pairs, 20);
  EXPECT_EQ(c.unpaired_a, 20);
  EXPECT_TRUE(c.only_a.empty());
}

}  // namespace
}  // namespace rover::campaign
