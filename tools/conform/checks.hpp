// Requirements for a driver (docs/drivers.md), one table line each.
#pragma once

#include <string>
#include <vector>

#include "common/core/camera_rig.hpp"
#include "tools/conform/received.hpp"
#include "tools/conform/trial.hpp"

namespace rover::conform {

enum class Verdict { kPass, kFail, kSkipped };

struct Line {
  std::string check;
  Verdict verdict = Verdict::kSkipped;
  std::string measured;  // measured value, or why it was skipped
  std::string requirement;
};

// Ticks, rates, timestamps, clocks.
std::vector<Line> check_time(const Received& received);
// Content of the messages of a stationary rover on ground within 25 deg of level.
std::vector<Line> check_content(const Received& received, const StereoRig& loccam);
// Reaction of the driver to the trial's commands.
std::vector<Line> check_trial(const Received& received, const Trial& trial);

// Median delay of a channel's messages after their release, in ticks received until then [s]: clock offset plus
// transport. NaN if none.
struct Lag {
  std::string channel;
  double median_s = 0.0;
};
std::vector<Lag> clock_lags(const Received& received);
// Limits of the delay: a message may precede its tick by two periods, and follow it by 100 ms.
constexpr double kMinLagS = -0.040;
constexpr double kMaxLagS = 0.100;

// Helpers that make a line.
Line line(std::string check, bool pass, std::string measured, std::string requirement);
Line skipped(std::string check, std::string why, std::string requirement);

}  // namespace rover::conform
