#include "spy/traffic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/bus/channel_types.hpp"
#include "common/bus/channels.hpp"
#include "common/bus/streams.hpp"

namespace rover::spy {

void Traffic::hear(const std::string& channel, const void* data, int size, double wall_s) {
  if (std::isnan(first_wall_s_)) first_wall_s_ = wall_s;
  tick_without_ticks(wall_s);
  Channel& account = channels_[channel];
  const ChannelType* type = find_channel_type(channel);
  header_t header{};
  if (type != nullptr && !(type->decodes(data, size) && peek_header(data, size, header))) {
    ++account.malformed;
    return;
  }
  if (channel == channel::kTick) tick(header.utime, wall_s);
  ++account.messages;
  account.bytes += size;
  // What has no header of ours is numbered as it comes.
  if (type == nullptr) header.seq = account.messages;
  const Utime utime = type == nullptr ? clock_.now() : header.utime;
  account.newest_utime = std::max(account.newest_utime, utime);
  account.streams[header.publisher].hear({header.boot_id, header.seq, utime, clock_.now(), static_cast<size_t>(size)});
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  account.newest.assign(bytes, bytes + size);
}

void Traffic::tick(Utime utime, double wall_s) {
  // The first tick ends the time without; one that is older than the last begins another world.
  if (!ticks_heard_ || utime < clock_.now()) {
    clock_ = {};
    if (ticks_heard_) channels_.clear();
    forget_before(std::numeric_limits<Utime>::max());
  }
  ticks_heard_ = true;
  clock_.tick(utime, wall_s);
  forget_before(rates_ == Rates::kWhole ? utime : clock_.window(wall_s).from);
}

// On a bus where nobody ticks, wall time stands in for message time.
void Traffic::tick_without_ticks(double wall_s) {
  if (ticks_heard_) return;
  constexpr double kTickS = 0.02;
  const Utime utime = to_utime(wall_s - first_wall_s_);
  if (clock_.now() != kNever && utime - clock_.now() < to_utime(kTickS)) return;
  clock_.tick(utime, wall_s);
  forget_before(rates_ == Rates::kWhole ? utime : clock_.window(wall_s).from);
}

void Traffic::forget_before(Utime utime) {
  for (auto& [name, channel] : channels_)
    for (auto& [publisher, stream] : channel.streams) stream.forget_before(utime);
}

Figures Traffic::figures(double wall_s) const {
  Figures out;
  if (ticks_heard_) out.now = clock_.now();
  const status::Window window = clock_.window(wall_s);
  if (rates_ == Rates::kRecent && ticks_heard_ && window.wall_s > 0.0)
    out.realtime_factor = window.message_s / window.wall_s;
  out.span_s = std::isnan(first_wall_s_) ? 0.0 : wall_s - first_wall_s_;
  for (const auto& [name, channel] : channels_) out.channels[name] = figures_of(name, channel, wall_s);
  return out;
}

ChannelFigures Traffic::figures_of(const std::string& name, const Channel& channel, double wall_s) const {
  ChannelFigures out;
  const ChannelType* type = find_channel_type(name);
  if (type != nullptr) out.type = type->name;
  out.messages = channel.messages;
  out.bytes = channel.bytes;
  out.malformed = channel.malformed;
  out.newest = channel.newest;
  if (ticks_heard_ && type != nullptr) out.age_s = clock_.age_s(channel.newest_utime);
  const status::Window window = clock_.window(wall_s);
  double hz = 0.0;
  double recent_bytes = 0.0;
  for (const auto& [publisher, stream] : channel.streams) {
    if (!publisher.empty()) out.publishers.push_back(publisher);
    out.gaps += stream.gaps();
    hz += stream.hz(window);
    recent_bytes += static_cast<double>(stream.bytes());
  }
  const double whole_s = wall_s - first_wall_s_;
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
