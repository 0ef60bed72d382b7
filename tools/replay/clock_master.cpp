#include "tools/replay/clock_master.hpp"

#include <algorithm>
#include <chrono>
#include <rover/tick_t.hpp>

#include "common/bus/channels.hpp"
#include "common/bus/s6_client.hpp"
#include "common/bus/streams.hpp"

namespace rover::replay {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kRepeatTick_s = 1.0;  // TICK or DONE may be lost: repeat the tick
constexpr double kTimeout_s = 60.0;    // timeout: a frame may take seconds on a loaded machine

double since_s(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

ClockMaster::ClockMaster(const std::vector<std::string>& services, lcm::LCM& bus, lcm::LCM& reports)
    : bus_(bus), reports_(reports), barrier_(services), streams_("replay", 1) {
  reports_.subscribe(channel::kDone, &ClockMaster::on_done, this)->setQueueCapacity(0);
}

void ClockMaster::on_done(const lcm::ReceiveBuffer* buffer, const std::string&) {
  done_t done{};
  if (!decode_message(buffer->data, static_cast<int>(buffer->data_size), done)) return;
  const header_t& header = done.header;
  if (done.tick_utime == kNever) return barrier_.ready(header.publisher, header.boot_id, done.pid);
  barrier_.done(header.publisher, header.boot_id, done.pid, done.tick_utime, done.promise_utime, done.busy != 0);
  for (const stream_seq_t& stream : done.streams)
    reported_.insert_or_assign({stream.channel, stream.publisher, stream.boot_id}, stream);
  dones_.push_back(std::move(done));
}

// `missing()` returns the services still awaited.
template <class Missing>
void ClockMaster::wait(const Missing& missing, const Running& running) {
  const auto started = Clock::now();
  double repeated_at_s = 0.0;
  for (std::vector<std::string> names = missing(); !names.empty() && running(); names = missing()) {
    if (reports_.handleTimeout(5) > 0) continue;
    for (const std::string& name : names) {
      const int pid = barrier_.pid_of(name);
      if (pid > 0 && !process_alive(pid)) throw ServiceGone(name + " has died");
      if (since_s(started) > kTimeout_s) throw ServiceGone(name + (pid > 0 ? " stopped responding" : " did not start"));
    }
    if (last_tick_.empty() || since_s(started) - repeated_at_s < kRepeatTick_s) continue;
    repeated_at_s = since_s(started);
    bus_.publish(channel::kTick, last_tick_.data(), static_cast<unsigned int>(last_tick_.size()));
  }
}

void ClockMaster::wait_for_start(const Running& running) {
  wait([this] { return barrier_.waiting_for(0); }, running);
}

void ClockMaster::list(const std::string& channel, const header_t& header) {
  stream_seq_t stream{};
  stream.channel = channel;
  stream.publisher = header.publisher;
  stream.boot_id = header.boot_id;
  stream.seq = header.seq;
  listed_.push_back(std::move(stream));
}

void ClockMaster::publish_tick(Utime t, const Running& running) {
  wait([this, t] { return barrier_.waiting_for(t); }, running);
  std::erase_if(dones_, [&](const done_t& done) {
    if (done.header.release_utime > t) return false;
    listed_.insert(listed_.end(), done.streams.begin(), done.streams.end());
    return true;
  });
  tick_t tick{};
  tick.mode = tick_t::LOCKSTEP;
  tick.members = barrier_.admit(t);
  tick.member_count = static_cast<std::int32_t>(tick.members.size());
  tick.streams = std::move(listed_);
  listed_.clear();
  tick.stream_count = static_cast<std::int32_t>(tick.streams.size());
  tick.header = streams_.next(channel::kTick, t, t);
  last_tick_ = encoded(tick);
  bus_.publish(channel::kTick, last_tick_.data(), static_cast<unsigned int>(last_tick_.size()));
}

void ClockMaster::wait_until_idle(const Running& running) {
  const auto busy = [this] {
    std::vector<std::string> names;
    for (const std::string& name : barrier_.participants())
      if (!barrier_.idle(name)) names.push_back(name);
    return names;
  };
  wait(busy, running);
}

std::vector<stream_seq_t> ClockMaster::reported() const {
  std::vector<stream_seq_t> streams;
  for (const auto& [key, stream] : reported_) streams.push_back(stream);
  return streams;
}

}  // namespace rover::replay
