#include "common/bus/lockstep.hpp"

#include <unistd.h>

#include <algorithm>

#include "common/bus/channels.hpp"

namespace rover {
namespace {

// Wall time that a lockstep tick waits for listed messages that have not arrived. A stream never received has a
// shorter timeout, because its process may not be running.
constexpr auto kTimeout = std::chrono::seconds(2);
constexpr auto kTimeoutUnknown = std::chrono::milliseconds(50);
// Wall time without clock-paced ticks, whose period is 20 ms.
constexpr auto kTickTimeout = std::chrono::milliseconds(300);

// A vehicle's driver does not know the nodes: ticks without members are for all.
bool is_for(const std::string& name, const tick_t& tick) {
  if (tick.members.empty() && tick.mode == tick_t::REALTIME) return true;
  return std::find(tick.members.begin(), tick.members.end(), name) != tick.members.end();
}

}  // namespace

Lockstep::Lockstep(const std::string& name, std::int64_t boot_id, lcm::LCM& lcm, Inbox& inbox, Report report,
                   EventLog log)
    : name_(name),
      lcm_(lcm),
      inbox_(inbox),
      report_(std::move(report)),
      log_(std::move(log)),
      reports_(name, boot_id),
      ticks_on_bus_(lcm.subscribeFunction(
          channel::kTick,
          +[](const lcm::ReceiveBuffer* buffer, const std::string& channel, Lockstep* lockstep) {
            lockstep->receive(buffer, channel);
          },
          this)),
      health_(no_input_yet(channel::kTick)) {
  ticks_on_bus_->setQueueCapacity(0);
}

Lockstep::~Lockstep() {
  lcm_.unsubscribe(ticks_on_bus_);
}

void Lockstep::receive(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
  const int size = static_cast<int>(buffer->data_size);
  QueuedTick queued{{}, Clock::now()};
  if (!decode_message(buffer->data, size, queued.tick)) {
    const bool foreign = size >= kFingerprintBytes && peek_fingerprint(buffer->data, size) != tick_t::getHash();
    return inbox_.count_malformed(health_, channel, foreign ? "foreign fingerprint" : "truncated or damaged");
  }
  if (!is_for(name_, queued.tick)) return;
  const Utime latest = ticks_.empty() ? now_ : ticks_.back().tick.header.utime;
  if (queued.tick.header.utime > latest) {
    ticks_.push_back(std::move(queued));
  } else if (queued.tick.header.utime == now_ && queued.tick.mode == tick_t::LOCKSTEP) {
    report_(last_done_);  // the clock master did not receive it
  }
}

std::optional<tick_t> Lockstep::next() {
  const auto by_clock = [](const QueuedTick& queued) { return queued.tick.mode == tick_t::REALTIME; };
  while (ticks_.size() > 1 && by_clock(ticks_[0]) && by_clock(ticks_[1])) ticks_.pop_front();
  if (ticks_.empty() || !holds_all_for(ticks_.front())) return std::nullopt;
  tick_t tick = std::move(ticks_.front().tick);
  ticks_.pop_front();
  now_ = health_.last_utime = tick.header.utime;
  ++health_.received;
  if (tick.mode != tick_t::LOCKSTEP) last_tick_wall_ = Clock::now();
  return tick;
}

bool Lockstep::holds_all_for(const QueuedTick& queued) {
  if (queued.tick.mode == tick_t::REALTIME) return true;
  const auto waited = Clock::now() - queued.arrived;
  for (const stream_seq_t& stream : queued.tick.streams) {
    if (stream.publisher == name_ || !inbox_.misses(stream)) continue;
    const bool known = inbox_.knows(stream);
    if (waited < (known ? Clock::duration(kTimeout) : Clock::duration(kTimeoutUnknown))) return false;
    if (known) {
      ++last_done_.lost;
      log_("WARN", "LOST_ON_BUS channel=" + stream.channel + " publisher=" + stream.publisher);
    }
    inbox_.give_up(stream);
  }
  return true;
}

void Lockstep::done(Utime tick, Utime promise, std::vector<stream_seq_t> updated, bool busy) {
  last_done_.tick_utime = tick;
  last_done_.busy = busy ? 1 : 0;
  last_done_.promise_utime = promise;
  last_done_.pid = getpid();
  last_done_.streams = std::move(updated);
  last_done_.stream_count = static_cast<std::int32_t>(last_done_.streams.size());
  last_done_.header = reports_.next(channel::kDone, tick, std::max(tick, promise));
  report_(last_done_);
}

void Lockstep::announce() const {
  done_t hello{};
  hello.header.utime = hello.header.release_utime = kNever;
  hello.header.seq = 0;
  hello.header.publisher = name_;
  hello.header.boot_id = reports_.boot_id();
  hello.tick_utime = hello.promise_utime = kNever;
  hello.pid = getpid();
  hello.stream_count = 0;
  report_(hello);
}

bool Lockstep::ticks_timed_out() {
  if (!last_tick_wall_ || Clock::now() - *last_tick_wall_ < kTickTimeout) return false;
  last_tick_wall_.reset();
  return true;
}

}  // namespace rover
