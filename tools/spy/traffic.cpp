#include "tools/spy/traffic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/bus/channel_types.hpp"
#include "common/bus/channels.hpp"
#include "common/bus/streams.hpp"

namespace rover::spy {

void Traffic::add_message(const std::string& channel, const void* data, int size, double wall_s) {
  const ChannelType* type = find_channel_type(channel);
  header_t header{};
  const bool valid = type == nullptr || (type->decodes(data, size) && peek_header(data, size, header));
  // First: a tick that goes back resets the statistics.
  if (channel == channel::kTick && valid) tick(header.utime, wall_s);
  if (!run_.has_ticks) advance_by_wall_clock(wall_s);
  Channel& counters = run_.channels[channel];
  if (!valid) {
    ++counters.malformed;
    return;
  }
  ++counters.messages;
  counters.bytes += size;
  const Utime now = run_.clock.now();
  // Channels of other projects have no header: number their messages in order of arrival.
  if (type == nullptr) header.seq = counters.messages;
  const Utime utime = type == nullptr ? now : header.utime;
  counters.newest_utime = std::max(counters.newest_utime, utime);
  counters.streams[header.publisher].add({header.boot_id, header.seq, utime, now, static_cast<size_t>(size)});
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  counters.newest.assign(bytes, bytes + size);
}

void Traffic::tick(Utime utime, double wall_s) {
  if (run_.has_ticks && utime < run_.clock.now()) run_ = {};
  // The first tick discards the statistics that were based on wall time.
  if (!run_.has_ticks) {
    run_.clock = {};
    remove_before(std::numeric_limits<Utime>::max());
  }
  run_.has_ticks = true;
  if (std::isnan(run_.first_wall_s)) run_.first_wall_s = wall_s;
  run_.clock.tick(utime, wall_s);
  remove_before(rates_ == Rates::kWhole ? utime : run_.clock.window(wall_s).from);
}

// Without TICK, wall time replaces message time.
void Traffic::advance_by_wall_clock(double wall_s) {
  constexpr double kTickS = 0.02;
  if (std::isnan(run_.first_wall_s)) run_.first_wall_s = wall_s;
  const Utime utime = to_utime(wall_s - run_.first_wall_s);
  if (run_.clock.now() != kNever && utime - run_.clock.now() < to_utime(kTickS)) return;
  run_.clock.tick(utime, wall_s);
  remove_before(rates_ == Rates::kWhole ? utime : run_.clock.window(wall_s).from);
}

void Traffic::remove_before(Utime utime) {
  for (auto& [name, channel] : run_.channels)
    for (auto& [publisher, stream] : channel.streams) stream.remove_before(utime);
}

TrafficStatistics Traffic::statistics(double wall_s) const {
  TrafficStatistics out;
  if (run_.has_ticks) out.now = run_.clock.now();
  const status::Window window = run_.clock.window(wall_s);
  if (rates_ == Rates::kRecent && run_.has_ticks && window.wall_s > 0.0)
    out.realtime_factor = window.message_s / window.wall_s;
  out.span_s = std::isnan(run_.first_wall_s) ? 0.0 : wall_s - run_.first_wall_s;
  for (const auto& [name, channel] : run_.channels) out.channels[name] = statistics_of(name, channel, wall_s);
  return out;
}

ChannelStatistics Traffic::statistics_of(const std::string& name, const Channel& channel, double wall_s) const {
  ChannelStatistics out;
  const ChannelType* type = find_channel_type(name);
  if (type != nullptr) out.type = type->name;
  out.messages = channel.messages;
  out.bytes = channel.bytes;
  out.malformed = channel.malformed;
  out.newest = channel.newest;
  if (run_.has_ticks && type != nullptr) out.age_s = run_.clock.age_s(channel.newest_utime);
  const status::Window window = run_.clock.window(wall_s);
  double hz = 0.0;
  double recent_bytes = 0.0;
  for (const auto& [publisher, stream] : channel.streams) {
    if (!publisher.empty()) out.publishers.push_back(publisher);
    out.gaps += stream.gaps();
    hz += stream.hz(window);
    recent_bytes += static_cast<double>(stream.bytes());
  }
  const double whole_s = wall_s - run_.first_wall_s;
  if (rates_ == Rates::kRecent && window.wall_s > 0.0) {
    out.hz = hz;
    out.bytes_per_s = recent_bytes / window.wall_s;
  } else if (rates_ == Rates::kWhole && whole_s > 0.0) {
    out.hz = static_cast<double>(channel.messages) / whole_s;
    out.bytes_per_s = static_cast<double>(channel.bytes) / whole_s;
  }
  return out;
}

}  // namespace rover::spy
