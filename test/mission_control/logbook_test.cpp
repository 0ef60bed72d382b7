// Logbook: bounded memory, checkpoint round trip.
#include "mission_control/logbook.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace rover::mission {
namespace {

Logbook full_book() {
  Logbook book;
  book.add_event(1.5, Tone::kBad, "fault", "slip raised");
  book.add_event(2.5, Tone::kGood, "state", "DRIVING");
  for (int i = 0; i < 50; ++i) book.add_track_point(0.2 * i, 1.0);
  GlobalPath path;
  path.x_m = {1.0, 2.0};
  path.y_m = {3.0, 4.0};
  path.level = {0, 1};
  path.corridor_half_width_m = 1.25;
  book.set_path(42, path);
  book.set_forced(Level::kFull);
  return book;
}

TEST(Logbook, CheckpointRoundTrip) {
  const Logbook book = full_book();
  Logbook back;
  ASSERT_TRUE(back.restore(book.save()));
  EXPECT_EQ(back.events_after(0), book.events_after(0));
  EXPECT_EQ(back.path_json(), book.path_json());
  EXPECT_EQ(back.track(), book.track());
  EXPECT_EQ(back.forced(), Level::kFull);
  back.add_event(3.0, Tone::kInfo, "state", "next");
  EXPECT_EQ(back.newest_event(), 3);
}

TEST(Logbook, InvalidCheckpointIsRejected) {
  const std::vector<std::uint8_t> good = full_book().save();
  Logbook book = full_book();
  EXPECT_FALSE(book.restore({}));
  EXPECT_FALSE(book.restore({1, 2, 3}));
  for (size_t size = 0; size < good.size(); size += 7) {
    const std::vector<std::uint8_t> cut(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(book.restore(cut)) << size;
  }
  EXPECT_EQ(book.path_id(), 42);
}

TEST(Logbook, OldEventsAreDroppedIdsContinue) {
  Logbook book;
  for (int i = 0; i < 1000; ++i) book.add_event(i, Tone::kInfo, "state", "x");
  EXPECT_LE(book.events().size(), 400U);
  EXPECT_EQ(book.newest_event(), 1000);
  EXPECT_EQ(book.events_after(998).size(), 2U);
  EXPECT_EQ(book.events_after(1000).size(), 0U);
}

TEST(Logbook, LongTrackIsDecimated) {
  Logbook book;
  for (int i = 0; i < 60'000; ++i) book.add_track_point(0.11 * i, 0.0);
  const auto& track = book.track();
  EXPECT_LE(track.size(), 2 * 20'002U);
  EXPECT_FLOAT_EQ(track.front(), 0.0F);
  EXPECT_NEAR(track[track.size() - 2], 0.11 * 60'000, 1.0);
  for (size_t i = 2; i + 1 < track.size(); i += 2) EXPECT_LT(track[i] - track[i - 2], 2.0F);
}

TEST(Logbook, StationaryRoverAndNaNAddNoTrackPoints) {
  Logbook book;
  for (int i = 0; i < 100; ++i) book.add_track_point(1.0 + 0.0005 * i, 2.0);
  book.add_track_point(NAN, 2.0);
  EXPECT_EQ(book.track().size(), 2U);
}

TEST(Logbook, TrendKeepsTwoMinutes) {
  Logbook book;
  for (int t = 0; t < 500; ++t) book.sample({static_cast<double>(t), 0.2F, NAN, 0.0F, 0.0F});
  EXPECT_EQ(book.trend_json().size(), 121U);
  EXPECT_EQ(book.trend_json().back()[0], 499.0);
}

}  // namespace
}  // namespace rover::mission
