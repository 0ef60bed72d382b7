// The duties of a driver (docs/drivers.md), one line of the table each.
#pragma once

#include <string>
#include <vector>

#include "common/core/camera_rig.hpp"
#include "tools/conform/heard.hpp"
#include "tools/conform/trial.hpp"

namespace rover::conform {

enum class Verdict { kPass, kFail, kSkipped };

struct Line {
  std::string duty;
  Verdict verdict = Verdict::kSkipped;
  std::string measured;  // or why it was skipped
  std::string demand;
};

// Ticks, rates, stamps, clocks.
std::vector<Line> judge_time(const Heard& heard);
// What the messages hold, for a rover that stands still on ground within 25 deg of level.
std::vector<Line> judge_content(const Heard& heard, const StereoRig& loccam);
// What the driver did with the trial's commands.
std::vector<Line> judge_trial(const Heard& heard, const Trial& trial);

// By how much a channel's messages come later than their release, in ticks heard until then [s], median; NaN where
// none came. It is the difference of the clocks of two drivers plus what the way took.
struct Lag {
  std::string channel;
  double median_s = 0.0;
};
std::vector<Lag> clock_lags(const Heard& heard);
// Limits of a lag: a message may come a tick before its own, and not much later than it.
constexpr double kLeastLagS = -0.040;
constexpr double kMostLagS = 0.100;

// Lines helpers.
Line line(std::string duty, bool pass, std::string measured, std::string demand);
Line skipped(std::string duty, std::string why, std::string demand);

}  // namespace rover::conform
