#include "tools/replay/field_difference.hpp"

#include <gtest/gtest.h>

#include <rover/slip_t.hpp>

#include "common/bus/channels.hpp"
#include "common/bus/streams.hpp"

namespace rover::replay {
namespace {

Bytes bytes_of(const slip_t& message) {
  return encoded(message);
}

TEST(FieldDifference, ReportsFirstDifferingField) {
  slip_t slip{};
  slip.header.publisher = "localization";
  slip.slip_ratio = 0.25;
  Difference difference;
  difference.name.channel = channel::kSlip;
  difference.recorded = bytes_of(slip);
  slip.slip_ratio = 0.5;
  difference.live = bytes_of(slip);
  EXPECT_EQ(field_difference(difference), "slip_ratio is 0.25 in the log, 0.5 now");
}

TEST(FieldDifference, EmptyIfMessageDoesNotDecode) {
  Difference difference;
  difference.name.channel = channel::kSlip;
  difference.recorded = {1, 2, 3};
  difference.live = bytes_of(slip_t{});
  EXPECT_EQ(field_difference(difference), "");
}

}  // namespace
}  // namespace rover::replay
