#include "tools/spy/spy_command.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>

#include "common/bus/channel_types.hpp"
#include "common/bus/config.hpp"
#include "common/bus/interrupt.hpp"
#include "common/bus/log_runs.hpp"
#include "common/bus/wall_clock.hpp"
#include "tools/spy/bus_subscriber.hpp"
#include "tools/spy/statistics_json.hpp"
#include "tools/spy/table.hpp"
#include "tools/status/running_run.hpp"
#include "tools/status/terminal.hpp"
#include "tools/status/text_line.hpp"

namespace rover::spy {
namespace {

constexpr double kOnceS = 1.2;  // as ./rover status
constexpr double kRefreshS = 1.0;
constexpr int kPollMs = 50;

status::ScreenOptions everything() {
  constexpr size_t kAll = std::numeric_limits<size_t>::max();
  return {.colours = status::on_terminal(), .columns = kAll, .rows = kAll};
}

std::string names_of(const TrafficStatistics& statistics) {
  constexpr size_t kMost = 40;
  std::string names;
  size_t count = 0;
  for (const auto& [name, channel] : statistics.channels)
    if (count++ < kMost) names += " " + status::printable(name);
  if (count > kMost) names += " ...";
  return names.empty() ? " none" : names;
}

// Returns 0 if there is something to show; else prints the reason.
int report_missing(const TrafficStatistics& statistics, const std::string& source,
                   const std::set<std::string>& chosen) {
  if (statistics.channels.empty()) {
    std::fprintf(stderr, "%s: no messages received. Is a rover running on this bus? See ./rover status\n",
                 source.c_str());
    return 1;
  }
  for (const std::string& channel : chosen) {
    if (statistics.channels.contains(channel)) continue;
    const bool known = find_channel_type(channel) != nullptr;
    std::fprintf(stderr, "%s: %s %s; received:%s\n", source.c_str(), known ? "no message on" : "there is no channel",
                 status::printable(channel).c_str(), names_of(statistics).c_str());
    return known ? 1 : 2;
  }
  return 0;
}

int show_once(const TrafficStatistics& statistics, const std::string& source, const SpyArguments& arguments) {
  if (const int fault = report_missing(statistics, source, arguments.channels); fault != 0) return fault;
  const std::string text = arguments.json
                               ? statistics_json(statistics, source, arguments.channels)
                                         .dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) +
                                     "\n"
                               : table(statistics, source, arguments.channels, everything());
  std::fputs(text.c_str(), stdout);
  return 0;
}

int spy_on_log(const SpyArguments& arguments) {
  const LogRun run = choose_run(arguments.log, arguments.log_run);
  Traffic traffic(Traffic::Rates::kWhole);
  Utime last = std::numeric_limits<Utime>::min();
  for_each_event(run, [&](const LogEvent& event) {
    last = std::max(last, event.time);  // keep the maximum: the clock of a recording may be set back
    traffic.add_message(event.channel, event.data, event.size, to_seconds(last));
  });
  const int status = show_once(traffic.statistics(to_seconds(last)), run.log, arguments);
  print_remarks(run);
  return status;
}

// Handles messages until end_s, Ctrl-C or the end of the run.
void listen_until(BusSubscriber& subscriber, double end_s) {
  while (keep_running() && wall_s() < end_s)
    subscriber.listen(std::clamp(static_cast<int>((end_s - wall_s()) * 1e3), 1, kPollMs));
}

int watch(BusSubscriber& subscriber, Traffic& traffic, const status::Target& target, const SpyArguments& arguments) {
  const double end_s = arguments.for_s > 0.0 ? wall_s() + arguments.for_s : std::numeric_limits<double>::infinity();
  const auto over = [&] { return !target.run_dir.empty() && !status::is_running(target.run_dir); };
  {
    status::Terminal terminal;
    while (keep_running() && wall_s() < end_s && !over()) {
      listen_until(subscriber, std::min(end_s, wall_s() + kRefreshS));
      const status::ScreenOptions options = status::on_terminal() ? terminal.options() : everything();
      terminal.redraw(table(traffic.statistics(wall_s()), target.bus_url, arguments.channels, options));
    }
  }
  return report_missing(traffic.statistics(wall_s()), target.bus_url, arguments.channels);
}

int spy_on_bus(const SpyArguments& arguments) {
  const std::optional<status::Target> target = status::find_target(arguments.target);
  if (!target) return 1;
  Traffic traffic(Traffic::Rates::kRecent);
  BusSubscriber subscriber(target->bus_url, traffic);
  catch_interrupts();
  if (!arguments.once && !arguments.json) return watch(subscriber, traffic, *target, arguments);
  listen_until(subscriber, wall_s() + (arguments.for_s > 0.0 ? arguments.for_s : kOnceS));
  return show_once(traffic.statistics(wall_s()), target->bus_url, arguments);
}

}  // namespace

int spy(const SpyArguments& arguments) {
  return arguments.log.empty() ? spy_on_bus(arguments) : spy_on_log(arguments);
}

}  // namespace rover::spy
