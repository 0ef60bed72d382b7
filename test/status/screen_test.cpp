#include "tools/status/screen.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <sstream>

#include "example_status.hpp"

namespace rover::status {
namespace {

const char* const kScreen =
    R"(rover 20251121-160000-default   udpm://239.255.76.67:7667?ttl=0
message time 83.42 s   3.41 times real time   384 messages/s   1.19 MB/s

FAULT_STOP   EFFICIENT   for 2.50 s   may not drive: FAULT_STOP   1 hazard stop
  cause: heartbeat.stereo   heartbeat_age_s 1.02, threshold 1

FAULT                                  VALUE       LIMIT     FOR s  IS       RESPONSE
heartbeat.stereo                        3.52           1      2.50  STALE    STOP
hazards_age                                -           -         -

SERVICE                  PID  IS         AGE s RESTARTS  CPU %  RSS MB  p50 ms  p99 ms   LOST    BAD
locomotion               101  OK          0.20        0   12.3    45.7     1.2     3.5      0      0
recorder                 102  DEGRADED    0.18        0   12.3    45.7     1.2     3.5      3      0
    disk full: 12 MB left
rover_simulator          103  OK          0.01        0   60.0   210.0       -       -      -      -
stereo                     -  dead        3.52        2      -       -     1.2     3.5      0      0
visual_odometry          104  silent      >4.1        1    0.0    33.3       -       -      -      -

CHANNEL                Hz    AGE s  LOST    kB/s    CHANNEL                Hz    AGE s  LOST    kB/s
DISPARITY             2.5     3.50     0   983.0    SLIP                 10.0     0.02     3     4.4
PATH                  0.0    21.06     0     0.0    TICK                 50.0     0.00     0    90.0
POSE                 50.0     0.00     0   110.0
)";

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string without_colours(const std::string& text) {
  return std::regex_replace(text, std::regex("\033\\[[0-9]*m"), "");
}

size_t longest(const std::string& text) {
  size_t most = 0;
  for (const std::string& line : lines_of(text)) most = std::max(most, line.size());
  return most;
}

// Every service and channel, and more faults than rows.
Snapshot crowded() {
  Snapshot s = example_status();
  for (int i = 0; i < 16; ++i) s.services["service_" + std::to_string(i)] = example_service(1'234'567, 12345.678);
  for (int i = 0; i < 60; ++i)
    s.channels["CHANNEL_WITH_LONG_NAME_" + std::to_string(i)] = {50.0, 170.0, 1e9, 9e5, 1, 1};
  for (int i = 0; i < 20; ++i) s.faults.push_back(s.faults[0]);
  s.bus_url = std::string(200, 'x');
  return s;
}

TEST(Screen, ShowsEverything) {
  EXPECT_EQ(screen(example_status(), {}), kScreen);
}

TEST(Screen, ColoursChangeNothingElse) {
  const std::string coloured = screen(example_status(), {.colours = true});
  EXPECT_EQ(without_colours(coloured), kScreen);
  for (const char* red : {"FAULT_STOP", "dead     ", "silent   "})
    EXPECT_NE(coloured.find("\033[31m" + std::string(red) + "\033[0m"), std::string::npos) << red;
  EXPECT_NE(coloured.find("\033[33mDEGRADED"), std::string::npos);
  EXPECT_NE(coloured.find("\033[31m     3.50\033[0m"), std::string::npos) << "a stream at rest";
}

TEST(Screen, ServiceThatTheLevelDoesNotNeedIsNotDead) {
  Snapshot status = example_status();
  status.services.at("stereo").wanted = false;
  EXPECT_NE(screen(status, {}).find("stereo                     -  stopped"), std::string::npos);
}

TEST(Screen, FitsTheTerminal) {
  for (const size_t rows : {5u, 24u, 34u, 35u, 50u, 200u}) {
    const std::string text = screen(crowded(), {.rows = rows});
    EXPECT_LE(longest(text), 100u);
    EXPECT_LE(lines_of(text).size(), rows);
  }
  EXPECT_LE(longest(screen(crowded(), {.columns = 40})), 40u);
  EXPECT_LE(longest(without_colours(screen(crowded(), {.colours = true, .columns = 40}))), 40u);
}

TEST(Screen, CountsTruncatedRows) {
  const std::vector<std::string> lines = lines_of(screen(crowded(), {}));
  EXPECT_NE(std::find(lines.begin(), lines.end(), "and 14 more faults"), lines.end());
  ASSERT_EQ(lines.size(), 50u);
  const auto shown =
      2 * std::count_if(lines.begin(), lines.end(), [](const std::string& line) { return line.find("CHANNEL_") == 0; });
  EXPECT_NE(lines.back().find(std::to_string(65 - shown) + " more channels"), std::string::npos) << lines.back();
}

TEST(Screen, ScreenShowsMissingTicksAndServices) {
  const std::string silent = screen(Snapshot{}, {});
  EXPECT_NE(silent.find("no TICK received"), std::string::npos);
  EXPECT_NE(silent.find("no STATE received"), std::string::npos);
  EXPECT_EQ(silent.find("no active faults"), std::string::npos);
  Snapshot stalled = example_status();
  stalled.tick_silence_s = 7.2;
  EXPECT_NE(screen(stalled, {}).find("no TICK for 7.2 s"), std::string::npos);
  stalled.services["visual_odometry"].quiet_s = kNaN;
  EXPECT_NE(screen(stalled, {}).find("visual_odometry          104  waiting"), std::string::npos);
}

TEST(Screen, ControlCharactersFromTheBusAreReplaced) {
  Snapshot s = example_status();
  s.services["recorder"].heartbeat->text = "bad\033[2J\nnews";
  const std::string text = screen(s, {});
  EXPECT_NE(text.find("    bad?[2J?news\n"), std::string::npos);
}

}  // namespace
}  // namespace rover::status
