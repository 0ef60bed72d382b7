#include "recorder/event_buffer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace rover::recorder {
namespace {

Event event(Utime release, const std::string& channel, std::int64_t seq, Event::Kind kind = Event::Kind::kData) {
  Event e;
  e.release = e.utime = release;
  e.channel = channel;
  e.publisher = "p";
  e.boot_id = 1;
  e.seq = seq;
  e.kind = kind;
  return e;
}

std::vector<std::string> names(const std::vector<Event>& events) {
  std::vector<std::string> out;
  for (const Event& e : events) out.push_back(e.channel + std::to_string(e.seq));
  return out;
}

TEST(EventBuffer, OrderDoesNotDependOnArrival) {
  std::vector<Event> events = {event(20, "WHEEL_STATE", 1), event(20, "TICK", 1, Event::Kind::kTick),
                               event(20, "IMU", 1), event(20, "IMU", 2), event(0, "ZULU", 1)};
  const std::vector<std::string> expected = {"ZULU1", "IMU1", "IMU2", "WHEEL_STATE1", "TICK1"};
  std::mt19937 random(1);
  for (int round = 0; round < 50; ++round) {
    std::shuffle(events.begin(), events.end(), random);
    EventBuffer buffer;
    for (const Event& e : events) buffer.add(e);
    EXPECT_EQ(names(buffer.pop_all()), expected);
  }
}

TEST(EventBuffer, PopBeforeKeepsEventsAtOrAfterLimit) {
  EventBuffer buffer;
  buffer.add(event(40, "A", 3));
  buffer.add(event(20, "A", 2));
  buffer.add(event(0, "A", 1));
  EXPECT_EQ(names(buffer.pop_before(20)), std::vector<std::string>{"A1"});
  EXPECT_EQ(buffer.size(), 2u);
  EXPECT_EQ(names(buffer.pop_all()), (std::vector<std::string>{"A2", "A3"}));
  EXPECT_EQ(buffer.size(), 0u);
}

}  // namespace
}  // namespace rover::recorder
