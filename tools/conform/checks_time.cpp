#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <set>

#include "tools/conform/checks.hpp"

namespace rover::conform {
namespace {

constexpr double kMaxSkipped = 0.01;  // fraction of the ticks
constexpr double kPaceTolerance = 0.02;
constexpr double kMaxJitterS = 0.020;
constexpr double kMaxReleaseS = 0.30;
constexpr size_t kFewestTicks = 50;

using Stamps = std::vector<const Stamp*>;

template <class Message>
Stamps stamps_of(const std::vector<Message>& messages) {
  Stamps out;
  for (const Message& message : messages) out.push_back(&message.stamp);
  return out;
}

struct Channel {
  const char* name;
  Stamps stamps;
};

std::vector<Channel> channels_of(const Received& received) {
  return {{"TICK", stamps_of(received.ticks)},
          {"IMU", stamps_of(received.imu)},
          {"WHEEL_STATE", stamps_of(received.wheels)},
          {"LOCCAM_LEFT", stamps_of(received.left)},
          {"LOCCAM_RIGHT", stamps_of(received.right)}};
}

double quantile(std::vector<double> values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

Line tick_line(const Received& received) {
  const std::string requirement = "REALTIME, on multiples of 20 ms, none skipped";
  int by_the_clock = 0;
  int on_grid = 0;
  int steps = 0;
  for (size_t i = 0; i < received.ticks.size(); ++i) {
    const Utime t = received.ticks[i].stamp.utime;
    by_the_clock += received.ticks[i].by_the_clock ? 1 : 0;
    on_grid += t % kTickUs == 0 ? 1 : 0;
    steps += i > 0 && t - received.ticks[i - 1].stamp.utime == kTickUs ? 1 : 0;
  }
  const auto n = static_cast<int>(received.ticks.size());
  const bool whole = steps >= (1.0 - kMaxSkipped) * (n - 1);
  return line("ticks", by_the_clock == n && on_grid == n && whole,
              fmt::format("{} ticks, {} REALTIME, {} on the grid, {} steps of 20 ms", n, by_the_clock, on_grid, steps),
              requirement);
}

// Least-squares fit of message time over wall time, and its residuals.
std::vector<Line> clock_lines(const Received& received) {
  const auto n = static_cast<double>(received.ticks.size());
  double mean_t = 0.0;
  double mean_s = 0.0;
  const Utime first = received.ticks.front().stamp.utime;
  const auto t_of = [first](const ReceivedTick& tick) { return to_seconds(tick.stamp.utime - first); };
  for (const ReceivedTick& tick : received.ticks) {
    mean_t += t_of(tick) / n;
    mean_s += tick.stamp.arrival_s / n;
  }
  double ts = 0.0;
  double ss = 0.0;
  for (const ReceivedTick& tick : received.ticks) {
    const double s = tick.stamp.arrival_s - mean_s;
    ts += (t_of(tick) - mean_t) * s;
    ss += s * s;
  }
  const double pace = ss > 0.0 ? ts / ss : 0.0;
  std::vector<double> late;
  for (const ReceivedTick& tick : received.ticks)
    late.push_back(std::abs((tick.stamp.arrival_s - mean_s) - (t_of(tick) - mean_t) / std::max(pace, 1e-3)));
  const double jitter = quantile(late, 0.99);
  return {line("pace", std::abs(pace - 1.0) <= kPaceTolerance, fmt::format("{:.4f} s of message time per second", pace),
               fmt::format("1 +- {}", kPaceTolerance)),
          line("jitter", jitter <= kMaxJitterS, fmt::format("99 % of ticks within {:.1f} ms", 1e3 * jitter),
               fmt::format("{:.0f} ms", 1e3 * kMaxJitterS))};
}

Line rate_line(const std::string& channel, size_t count, double seconds, double min_hz, double max_hz) {
  const double hz = static_cast<double>(count) / seconds;
  return line("rate of " + channel, hz >= min_hz && hz <= max_hz, fmt::format("{:.2f} Hz", hz),
              fmt::format("{} to {} Hz", min_hz, max_hz));
}

// In message time, so that machine load does not count.
std::vector<Line> rate_lines(const Received& received) {
  const double seconds = to_seconds(received.ticks.back().stamp.utime - received.ticks.front().stamp.utime);
  return {rate_line("IMU", received.imu.size(), seconds, 49.0, 51.0),
          rate_line("WHEEL_STATE", received.wheels.size(), seconds, 49.0, 51.0),
          rate_line("LOCCAM_LEFT", received.left.size(), seconds, 2.0, 5.0),
          rate_line("LOCCAM_RIGHT", received.right.size(), seconds, 2.0, 5.0)};
}

// The first channel that violates a condition between consecutive messages.
std::string first_breach(const std::vector<Channel>& channels,
                         const std::function<bool(const Stamp& before, const Stamp& now)>& broken) {
  for (const Channel& channel : channels)
    for (size_t i = 1; i < channel.stamps.size(); ++i)
      if (broken(*channel.stamps[i - 1], *channel.stamps[i]))
        return fmt::format("{}: seq {} after seq {}", channel.name, channel.stamps[i]->seq, channel.stamps[i - 1]->seq);
  return "";
}

std::vector<Line> order_lines(const std::vector<Channel>& channels) {
  const auto in_order = [](const std::string& breach) { return breach.empty() ? "on every channel" : breach; };
  const auto same_boot = [](const Stamp& a, const Stamp& b) {
    return a.publisher == b.publisher && a.boot_id == b.boot_id;
  };
  const std::string later = first_breach(channels, [](const Stamp& a, const Stamp& b) { return b.utime <= a.utime; });
  const std::string counted =
      first_breach(channels, [&](const Stamp& a, const Stamp& b) { return same_boot(a, b) && b.seq != a.seq + 1; });
  const std::string booted = first_breach(channels, [&](const Stamp& a, const Stamp& b) { return !same_boot(a, b); });
  const bool numbered = std::all_of(channels.begin(), channels.end(), [](const Channel& channel) {
    return std::all_of(channel.stamps.begin(), channel.stamps.end(),
                       [](const Stamp* s) { return s->boot_id > 0 && !s->publisher.empty(); });
  });
  return {line("utime", later.empty(), in_order(later), "strictly increasing"),
          line("seq", counted.empty(), in_order(counted), "increments by 1"),
          line("boot", booted.empty() && numbered, !numbered ? "no publisher, or a boot_id below 1" : in_order(booted),
               "one publisher and one boot_id per channel")};
}

Line release_line(const std::vector<Channel>& channels) {
  double min = kMaxReleaseS;
  double most = 0.0;
  for (const Channel& channel : channels)
    for (const Stamp* stamp : channel.stamps) {
      min = std::min(min, to_seconds(stamp->release - stamp->utime));
      most = std::max(most, to_seconds(stamp->release - stamp->utime));
    }
  return line("release", min >= 0.0 && most <= kMaxReleaseS,
              fmt::format("{:.0f} to {:.0f} ms after utime", 1e3 * min, 1e3 * most),
              fmt::format("0 to {:.0f} ms", 1e3 * kMaxReleaseS));
}

Line clock_line(const Received& received) {
  std::string measured;
  bool within = true;
  for (const Lag& lag : clock_lags(received)) {
    measured += fmt::format("{}{} {:+.0f} ms", measured.empty() ? "" : ", ", lag.channel, 1e3 * lag.median_s);
    within = within && lag.median_s >= kMinLagS && lag.median_s <= kMaxLagS;
  }
  return line("clock", within, measured,
              fmt::format("{:.0f} to {:.0f} ms against TICK", 1e3 * kMinLagS, 1e3 * kMaxLagS));
}

Line decodes_line(const Received& received) {
  std::string measured;
  for (const auto& [channel, count] : received.malformed)
    measured += fmt::format("{}{}: {} do not decode", measured.empty() ? "" : ", ", channel, count);
  return line("types", measured.empty(), measured.empty() ? "all messages decode" : measured,
              "types of lcmtypes/ on every channel");
}

}  // namespace

Line line(std::string check, bool pass, std::string measured, std::string requirement) {
  return {std::move(check), pass ? Verdict::kPass : Verdict::kFail, std::move(measured), std::move(requirement)};
}

Line skipped(std::string check, std::string why, std::string requirement) {
  return {std::move(check), Verdict::kSkipped, std::move(why), std::move(requirement)};
}

std::vector<Lag> clock_lags(const Received& received) {
  std::vector<Lag> lags;
  for (const Channel& channel : channels_of(received)) {
    std::vector<double> lag_s;
    for (const Stamp* stamp : channel.stamps)
      if (stamp->tick != kNever) lag_s.push_back(to_seconds(stamp->tick - stamp->release));
    if (channel.name != std::string("TICK") && !lag_s.empty()) lags.push_back({channel.name, quantile(lag_s, 0.5)});
  }
  return lags;
}

std::vector<Line> check_time(const Received& received) {
  if (received.ticks.size() < kFewestTicks)
    return {line("ticks", false, fmt::format("{} ticks", received.ticks.size()), "50 per second"),
            decodes_line(received)};
  const std::vector<Channel> channels = channels_of(received);
  std::vector<Line> lines{decodes_line(received), tick_line(received)};
  const auto add = [&lines](std::vector<Line> more) { lines.insert(lines.end(), more.begin(), more.end()); };
  add(clock_lines(received));
  add(rate_lines(received));
  add(order_lines(channels));
  lines.push_back(release_line(channels));
  lines.push_back(clock_line(received));
  return lines;
}

}  // namespace rover::conform
