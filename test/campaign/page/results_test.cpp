#include "tools/campaign/page/results.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace rover::campaign {
namespace {

Row drive(std::int64_t seed, const std::string& outcome, double progress, double feasible = 1.0) {
  Row row{.cell = {{"soil", "sand"}}, .seed = seed, .status = "done", .outcome = outcome};
  row.figures = {
      {"progress", progress}, {"oracle_feasible", feasible}, {"collisions", 0.0}, {"path_ratio", 1.0 + progress}};
  return row;
}

TEST(Count, InfeasibleDrivesAreNotCountedAsFailures) {
  const std::vector<Row> rows = {drive(1, "goal_reached", 0.8), drive(2, "no_path", 0.1), drive(3, "no_path", 0.1, 0.0),
                                 drive(4, "goal_reached", 0.8, 0.0)};
  const SuccessCount c = count(pointers(rows));
  EXPECT_EQ(c.drives, 4);
  EXPECT_EQ(c.feasible, 2);
  EXPECT_EQ(c.reached, 1);
  EXPECT_EQ(c.infeasible, 2);
  EXPECT_EQ(c.reached_infeasible, 1);
}

TEST(Count, DriveThatDiedIsAFailure) {
  const std::vector<Row> rows = {drive(1, "goal_reached", 0.8),
                                 {.cell = {{"soil", "sand"}}, .seed = 2, .status = "died"}};
  const SuccessCount c = count(pointers(rows));
  EXPECT_EQ(c.feasible, 2);
  EXPECT_EQ(c.reached, 1);
  EXPECT_EQ(c.died, 1);
  EXPECT_EQ(c.without_oracle, 1);
  EXPECT_EQ(c.unknown_contacts, 0);
}

TEST(Count, ContactIsNoSuccess) {
  std::vector<Row> rows = {drive(1, "goal_reached", 0.8)};
  rows[0].figures["collisions"] = 2.0;
  const SuccessCount c = count(pointers(rows));
  EXPECT_EQ(c.reached, 0);
  EXPECT_EQ(c.contacts, 2.0);
}

TEST(Spread, MedianAndWorstOfTheDrivesThatCount) {
  const std::vector<Row> rows = {drive(1, "goal_reached", 0.8), drive(2, "goal_reached", 0.6), drive(3, "no_path", 0.1),
                                 drive(4, "no_path", 0.01, 0.0)};
  const Spread ratio = spread(pointers(rows), kShownFigures[0]);
  EXPECT_EQ(ratio.drives, 2);
  EXPECT_DOUBLE_EQ(ratio.median, 1.7);
  EXPECT_DOUBLE_EQ(ratio.worst, 1.8);
  const Spread progress = spread(pointers(rows), kShownFigures[2]);  // higher is better; all feasible drives
  EXPECT_EQ(progress.drives, 3);
  EXPECT_EQ(progress.worst, 0.1);
  EXPECT_TRUE(std::isnan(spread({}, kShownFigures[0]).median));
}

TEST(Causes, ByOutcomeAndFaultWithTheWorstDriveFirst) {
  std::vector<Row> rows = {drive(1, "no_path", 0.5), drive(2, "no_path", 0.2),      drive(3, "fault_stop", 0.3),
                           drive(4, "no_path", 0.9), drive(5, "goal_reached", 0.9), drive(6, "no_path", 0.0, 0.0)};
  rows[2].texts["fault"] = "tilt_high";
  rows[3].figures["collisions"] = 1.0;
  const std::vector<Cause> found = causes(pointers(rows));
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].name, "no_path");
  ASSERT_EQ(found[0].drives.size(), 3u);
  EXPECT_EQ(found[0].drives[0]->seed, 4);  // contact
  EXPECT_EQ(found[0].drives[1]->seed, 2);  // lowest progress
  EXPECT_EQ(found[1].name, "fault_stop: tilt_high");
}

TEST(Causes, AFaultThatTheRoverSurvivedIsNoCause) {
  std::vector<Row> rows = {drive(1, "no_path", 0.5), drive(2, "no_path", 0.2)};
  rows[0].texts["fault"] = "vo_lost";
  const std::vector<Cause> found = causes(pointers(rows));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].name, "no_path");
}

TEST(Causes, ContactOnAnInfeasibleMapIsAFailure) {
  std::vector<Row> rows = {drive(1, "collision", 0.5, 0.0)};
  rows[0].figures["collisions"] = 1.0;
  EXPECT_EQ(causes(pointers(rows)).size(), 1u);
}

}  // namespace
}  // namespace rover::campaign
