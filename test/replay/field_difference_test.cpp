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

TEST(FieldDifference, names_the_first_field_that_differs) {
  slip_t slip{};
  slip.header.publisher = "localization";
  slip.slip_ratio = 0.25;
  Difference difference;
  difference.name.channel = channel::kSlip;
  difference.then = bytes_of(slip);
  slip.slip_ratio = 0.5;
  difference.now = bytes_of(slip);
  EXPECT_EQ(field_difference(difference), "slip_ratio is 0.25 in the log, 0.5 now");
}

TEST(FieldDifference, is_silent_about_what_does_not_decode) {
  Difference difference;
  difference.name.channel = channel::kSlip;
  difference.then = {1, 2, 3};
  difference.now = bytes_of(slip_t{});
  EXPECT_EQ(field_difference(difference), "");
}

}  // namespace
}  // namespace rover::replay
