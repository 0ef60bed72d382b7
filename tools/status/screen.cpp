#include "tools/status/screen.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/status/health.hpp"
#include "tools/status/text_line.hpp"

namespace rover::status {
namespace {

constexpr size_t kFaultsShown = 8;
constexpr double kSilenceS = 1.0;
constexpr size_t kHalf = 48;  // columns of one channel; the screen shows two side by side

using Lines = std::vector<Line>;

std::string count_of(size_t n, const std::string& what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

std::string last_part(const std::string& dir) {
  return dir.substr(dir.find_last_of('/') + 1);
}

Line clock_line(const Snapshot& s) {
  if (s.now == kNever) return {{"no TICK received: no messages on the bus", Colour::kRed}};
  double messages = 0.0;
  double bytes = 0.0;
  for (const auto& [name, channel] : s.channels) {
    messages += std::isfinite(channel.wall_hz) ? channel.wall_hz : 0.0;
    bytes += std::isfinite(channel.bytes_per_s) ? channel.bytes_per_s : 0.0;
  }
  Line line = {{"message time " + fixed(to_seconds(s.now), 2) + " s   " + fixed(s.realtime_factor, 2) +
                " times real time   " + fixed(messages, 0) + " messages/s   " + fixed(bytes * 1e-6, 2) + " MB/s"}};
  if (s.tick_silence_s > kSilenceS)
    line.push_back({"   no TICK for " + fixed(s.tick_silence_s, 1) + " s", Colour::kRed});
  return line;
}

void add_title(const Snapshot& s, Lines& out) {
  out.push_back({{"rover ", Colour::kPlain},
                 {s.run_dir.empty() ? "(no run, only a bus)" : printable(last_part(s.run_dir)), Colour::kBold},
                 {"   " + printable(s.bus_url)}});
  out.push_back(clock_line(s));
}

Line cause_line(const StateReport& state) {
  std::string text = "  cause: " + (state.cause.empty() ? "-" : printable(state.cause));
  if (!state.quantity.empty())
    text += "   " + printable(state.quantity) + " " + brief(state.value) + ", threshold " + brief(state.threshold);
  return {{text}};
}

void add_state(const Snapshot& s, Lines& out) {
  out.emplace_back();
  if (!s.state) {
    out.push_back({{"no STATE received from the supervisor", Colour::kRed}});
    return;
  }
  const StateReport& state = *s.state;
  std::string permit = "no permit received";
  if (s.permit) permit = s.permit->granted ? "may drive" : "may not drive: " + printable(s.permit->reason);
  out.push_back({{state.state, colour_of_state(state.state)},
                 {"   " + state.level + "   for " + fixed(s.state_for_s, 2) + " s   " + permit + "   " +
                  count_of(static_cast<size_t>(state.hazard_stops), "hazard stop")}});
  out.push_back(cause_line(state));
}

Line fault_line(const FaultStatus& fault) {
  const FaultReport& r = fault.report;
  return {{left(printable(r.id), 32), Colour::kRed},
          {right(brief(r.value), 12) + right(brief(r.limit), 12) + right(fixed(fault.for_s, 2), 10) + "  " +
           left(r.condition, 9) + left(r.response, 16)}};
}

void add_faults(const Snapshot& s, Lines& out) {
  if (!s.state && s.faults.empty()) return;  // without STATE the list of faults is unknown, not empty
  out.emplace_back();
  if (s.faults.empty()) {
    out.push_back({{"no active faults"}});
    return;
  }
  out.push_back({{left("FAULT", 32) + right("VALUE", 12) + right("LIMIT", 12) + right("FOR s", 10) + "  " +
                      left("IS", 9) + "RESPONSE",
                  Colour::kBold}});
  for (size_t i = 0; i < std::min(kFaultsShown, s.faults.size()); ++i) out.push_back(fault_line(s.faults[i]));
  if (s.faults.size() > kFaultsShown)
    out.push_back({{"and " + count_of(s.faults.size() - kFaultsShown, "more fault"), Colour::kRed}});
}

std::string age_text(const ServiceStatus& service) {
  if (std::isfinite(service.age_s)) return fixed(service.age_s, 2);
  return std::isfinite(service.quiet_s) ? ">" + fixed(service.quiet_s, 1) : "-";
}

Line service_line(const std::string& name, const ServiceStatus& service) {
  const ProcessFigures& p = service.process;
  const Heartbeat beat = service.heartbeat.value_or(Heartbeat{});
  const Piece condition = condition_of(service);
  const auto counted = [&](std::int64_t n) { return service.heartbeat ? std::to_string(n) : std::string("-"); };
  const std::int64_t bad = beat.malformed + beat.out_of_order;
  const auto warn = [](bool on) { return on ? Colour::kYellow : Colour::kPlain; };
  return {{left(printable(name), 20) + right(p.pid > 0 ? std::to_string(p.pid) : "-", 8) + "  "},
          {left(condition.text, 9), condition.colour},
          {right(age_text(service), 7)},
          {right(p.restarts ? std::to_string(*p.restarts) : "-", 9), warn(p.restarts.value_or(0) > 0)},
          {right(fixed(p.cpu_percent, 1), 7) + right(fixed(p.rss_mb, 1), 8) + right(fixed(beat.step_p50_ms, 1), 8) +
           right(fixed(beat.step_p99_ms, 1), 8)},
          {right(counted(beat.gaps), 7), warn(beat.gaps > 0)},
          {right(counted(bad), 7), warn(bad > 0)}};
}

void add_services(const Snapshot& s, Lines& out) {
  out.emplace_back();
  out.push_back({{left("SERVICE", 20) + right("PID", 8) + "  " + left("IS", 9) + right("AGE s", 7) +
                      right("RESTARTS", 9) + right("CPU %", 7) + right("RSS MB", 8) + right("p50 ms", 8) +
                      right("p99 ms", 8) + right("LOST", 7) + right("BAD", 7),
                  Colour::kBold}});
  for (const auto& [name, service] : s.services) {
    out.push_back(service_line(name, service));
    if (service.heartbeat && !service.heartbeat->text.empty())
      out.push_back({{"    " + printable(service.heartbeat->text), condition_of(service).colour}});
  }
}

Line channel_half(const std::string& name, const ChannelStatus& c) {
  const std::int64_t lost = c.gaps + c.malformed;
  return {{left(printable(name), 18)},
          {right(fixed(c.hz, 1), 7)},
          {right(fixed(c.age_s, 2), 9), is_stale(c) ? Colour::kRed : Colour::kPlain},
          {right(std::to_string(lost), 6), lost > 0 ? Colour::kYellow : Colour::kPlain},
          {right(fixed(c.bytes_per_s * 1e-3, 1), 8)}};
}

Line side_by_side(Line first, const Line& second) {
  first.push_back({std::string(kHalf + 4 - std::min(kHalf, width(first)), ' ')});
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

// Fills the left half first, then the right one.
void add_channels(const Snapshot& s, size_t rows, Lines& out) {
  if (s.channels.empty()) return;
  const Line head = {
      {left("CHANNEL", 18) + right("Hz", 7) + right("AGE s", 9) + right("LOST", 6) + right("kB/s", 8), Colour::kBold}};
  Lines halves;
  for (const auto& [name, channel] : s.channels) halves.push_back(channel_half(name, channel));
  const size_t frame = out.size() + 2;  // the empty line and the headings
  const size_t all = (halves.size() + 1) / 2;
  const bool fits = frame + all <= rows;
  const size_t height = fits ? all : rows - std::min(rows, frame + 1);
  out.emplace_back();
  out.push_back(side_by_side(head, head));
  for (size_t i = 0; i < height; ++i)
    out.push_back(side_by_side(halves[i], i + height < halves.size() ? halves[i + height] : Line{}));
  if (!fits) out.push_back({{"and " + count_of(halves.size() - 2 * height, "more channel") + " (--json has all)"}});
}

}  // namespace

std::string screen(const Snapshot& snapshot, const ScreenOptions& options) {
  Lines lines;
  add_title(snapshot, lines);
  add_state(snapshot, lines);
  add_faults(snapshot, lines);
  add_services(snapshot, lines);
  add_channels(snapshot, options.rows, lines);
  if (lines.size() > options.rows) lines.resize(options.rows);
  std::string out;
  for (const Line& line : lines) out += rendered(line, options.columns, options.colours) + "\n";
  return out;
}

}  // namespace rover::status
