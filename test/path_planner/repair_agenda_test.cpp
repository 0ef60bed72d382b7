#include "path_planner/repair_agenda.hpp"

#include <gtest/gtest.h>

namespace rover::planning {
namespace {

const std::vector<WayDemand> kDemands = {{kInfinity, 0.3}, {2.5, 0.3}, {0.6, 0.3}, {2.5, 1.2}};

// Demands in the order in which they come up until the end; each search ends alike.
std::vector<size_t> order(RepairStatus status, size_t leads) {
  RepairAgenda agenda;
  std::vector<size_t> out;
  do {
    out.push_back(agenda.demand());
  } while (agenda.advance(status, kDemands, leads));
  return out;
}

TEST(RepairAgenda, EachDemandIsTriedWithEachMarginAndLead) {
  EXPECT_EQ(order(RepairStatus::kUnseen, 1), (std::vector<size_t>{0, 0, 1, 1, 2, 2, 3, 3}));
  EXPECT_EQ(order(RepairStatus::kUnseen, 2).size(), 16U);
}

TEST(RepairAgenda, AskingForLessSeenGroundIsSkippedWhereNoneWasInTheWay) {
  EXPECT_EQ(order(RepairStatus::kNoWay, 1), (std::vector<size_t>{0, 0, 3, 3}));
}

// The demand for a goal under hazards comes and goes with the rover's distance to it.
TEST(RepairAgenda, BeginsAnewWhereItsDemandIsNoMore) {
  RepairAgenda agenda;
  while (agenda.demand() < 3) ASSERT_TRUE(agenda.advance(RepairStatus::kUnseen, kDemands, 1));
  agenda.fit(4);
  EXPECT_EQ(agenda.demand(), 3U);
  agenda.fit(3);
  EXPECT_EQ(agenda.demand(), 0U);
  EXPECT_EQ(agenda.margin(), 0U);
}

}  // namespace
}  // namespace rover::planning
