#include "common/bus/faults.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "common/bus/field_faults.hpp"

namespace rover {
namespace {

std::string problem(const std::string& fault, const std::string& target) {
  return target_problem(*find_fault(fault), target, find_channel_type);
}

TEST(Faults, HaveOneNameEachAndAUsualAmountInRange) {
  std::set<std::string> names;
  for (const FaultKind& kind : fault_kinds()) {
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_FALSE(kind.description.empty());
    if (!std::isnan(kind.default_amount)) {
      EXPECT_EQ(amount_problem(kind, kind.default_amount), "") << kind.name;
    }
    EXPECT_NE(fault_list().find(kind.name), std::string::npos);
  }
  EXPECT_EQ(find_fault("no_such_fault"), nullptr);
}

TEST(Faults, TargetsAreChecked) {
  EXPECT_EQ(problem("kill", "stereo"), "");
  EXPECT_NE(problem("kill", "STEREO").find("'STEREO' is not a service"), std::string::npos);
  EXPECT_EQ(problem("drop", "POSE"), "");
  EXPECT_NE(problem("drop", "POSES").find("not a channel"), std::string::npos);
  EXPECT_NE(problem("drop", "TICK").find("no fault can be put on TICK"), std::string::npos);
  EXPECT_EQ(problem("nan", "POSE"), "");
  EXPECT_EQ(problem("nan", "POSE.covariance"), "");
  EXPECT_NE(problem("nan", "POSE.speed").find("no field 'speed'"), std::string::npos);
  EXPECT_NE(problem("offset", "POSE").find("a field is required"), std::string::npos);
  EXPECT_EQ(problem("wheel_jammed", "5"), "");
  EXPECT_NE(problem("wheel_jammed", "6").find("not one of"), std::string::npos);
  EXPECT_EQ(problem("loss", "*"), "");
}

TEST(Faults, AmountsAreChecked) {
  EXPECT_EQ(amount_problem(*find_fault("loss"), 0.5), "");
  EXPECT_NE(amount_problem(*find_fault("loss"), 0.51), "");
  EXPECT_NE(amount_problem(*find_fault("drop"), std::nan("")), "");
  EXPECT_NE(amount_problem(*find_fault("kill"), 1.0), "");
}

// Every listed field exists in its channel's type and can be changed.
TEST(Faults, FieldsBelongToChannels) {
  int channels = 0;
  for (const char* channel : {"POSE", "VO", "IMU", "WHEEL_STATE", "SLIP", "CONTROL_STATUS", "PLANNER_STATUS", "HAZARDS",
                              "DISPARITY", "PATH", "MOTION_COMMAND", "WHEEL_COMMAND", "DRIVE_PERMIT"}) {
    EXPECT_NE(find_channel_type(channel), nullptr) << channel;
    EXPECT_FALSE(fields_of(channel).empty()) << channel;
    ++channels;
  }
  EXPECT_TRUE(fields_of("TICK").empty());
  EXPECT_EQ(channels, 13);
}

TEST(Faults, BytesThatAreNoMessageStayAsTheyAre) {
  const std::vector<std::uint8_t> noise(50, 0xA5);
  EXPECT_EQ(change_fields(
                {"POSE", ""}, [](double) { return 0.0; }, noise),
            noise);
}

}  // namespace
}  // namespace rover
