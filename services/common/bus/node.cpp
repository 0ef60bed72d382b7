#include "common/bus/node.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <utility>

#include "common/bus/channel_filter.hpp"
#include "common/core/frames.hpp"

namespace rover {
namespace {

constexpr Utime kHeartbeatPeriod = 10 * kTickUs;

std::unique_ptr<FaultInjector> injector_for(const NodeOptions& options) {
  if (!options.allow_injection && options.muted.empty()) return nullptr;
  auto injector = std::make_unique<FaultInjector>(options.name);
  for (const std::string& channel : options.muted) injector->mute(channel);
  return injector;
}

}  // namespace

Node::Node(NodeOptions options, lcm::LCM& lcm, lcm::LCM* reports)
    : options_(std::move(options)),
      lcm_(lcm),
      reports_(reports == nullptr ? lcm : *reports),
      streams_(options_.name, options_.boot_id),
      inbox_(lcm_, injector_for(options_), options_.allow_injection,
             [this](const char* level, const std::string& event) { log(level, event); }),
      lockstep_(
          options_.name, options_.boot_id, lcm_, inbox_,
          [this](const done_t& done) { send(reports_, channel::kDone, done); },
          [this](const char* level, const std::string& event) { log(level, event); }) {
  if (options_.allow_injection)
    subscribe<injection_t>(channel::kInject, [this](const injection_t& injection) { apply_injection(injection); });
}

void Node::subscribe_raw(std::function<void(const RawMessage&)> handler, FindChannelType types) {
  ROVER_CHECK(!subscriptions_closed_);
  const auto shared = std::make_shared<const std::function<void(const RawMessage&)>>(std::move(handler));
  const auto decode = [shared, types](RawMessage raw) -> Inbox::Deliver {
    const ChannelType* type = types(raw.channel);
    if (type != nullptr && !type->decodes(raw.bytes.data(), static_cast<int>(raw.bytes.size()))) return nullptr;
    const auto message = std::make_shared<const RawMessage>(std::move(raw));
    return [shared, message] { (*shared)(*message); };
  };
  inbox_.add(".*", 0, 0, decode, types);
}

void Node::apply_injection(const injection_t& injection) {
  const bool mine = inbox_.inject(injection);
  if (on_injection_) on_injection_(injection);
  if (mine) log("WARN", "INJECTED fault=" + injection.fault + " target=" + injection.target);
}

void Node::process(const tick_t& tick) {
  if (now_ == kNever && options_.boot_id > 1) inbox_.forget_before(tick.header.utime);
  before_ = now_;
  now_ = tick.header.utime;
  const bool lockstep = tick.mode == tick_t::LOCKSTEP;
  std::vector<Inbox::Pending> released = std::exchange(waiting_, {});
  for (Inbox::Pending& pending : inbox_.take_released(now_)) released.push_back(std::move(pending));
  const bool slow = begin_slow(released);
  if (slow) {
    if (lockstep) lockstep_.done(now_, promise_, streams_.take_updated(), true);
    timer_.begin();
  }
  for (Inbox::Pending& pending : released) {
    if (pending.slow == 0 || pending.header.utime == frame_)
      inbox_.dispatch(pending);
    else if (pending.header.utime > frame_)
      wait(std::move(pending));
    else
      inbox_.leave_out(pending);
  }
  if (slow) timer_.end();
  if (step_) step_(now_);
  if (once_in(kHeartbeatPeriod)) publish_heartbeat();
  if (lockstep) lockstep_.done(now_, promise_, streams_.take_updated(), false);
}

// The newest frame that waits; while the node is busy, what comes late of the frame it works on.
bool Node::begin_slow(const std::vector<Inbox::Pending>& released) {
  Utime newest = kNever;
  for (const Inbox::Pending& pending : released)
    if (pending.slow > 0) newest = std::max(newest, pending.header.utime);
  if (!busy()) frame_ = newest;
  Utime latency = 0;
  for (const Inbox::Pending& pending : released)
    if (pending.header.utime == frame_) latency = std::max(latency, pending.slow);
  if (latency > 0) promise_ = std::max(promise_, now_ + scaled(latency));
  return latency > 0;
}

// Of the frames that wait only the newest will be taken.
void Node::wait(Inbox::Pending pending) {
  const Utime newest = waiting_.empty() ? kNever : waiting_.front().header.utime;
  if (pending.header.utime < newest) return inbox_.leave_out(pending);
  if (pending.header.utime > newest) {
    for (const Inbox::Pending& older : waiting_) inbox_.leave_out(older);
    waiting_.clear();
  }
  waiting_.push_back(std::move(pending));
}

Utime Node::scaled(Utime latency) const {
  return static_cast<Utime>(std::llround(static_cast<double>(latency) * options_.cpu_scale));
}

bool Node::once_in(Utime period) const {
  return before_ == kNever ? now_ % period == 0 : now_ / period != before_ / period;
}

double Node::age_s(const std::string& channel) const {
  const input_health_t* health = inbox_.health(channel);
  return health == nullptr || health->last_utime == kNever ? kInfinity : to_seconds(now_ - health->last_utime);
}

void Node::set_status(std::int8_t status, std::string text) {
  status_ = status;
  status_text_ = std::move(text);
}

void Node::log(const char* level, const std::string& event) {
  std::printf("%lld %s %s %s\n", static_cast<long long>(now_), level, options_.name.c_str(), event.c_str());
  std::fflush(stdout);
}

void Node::publish_heartbeat() {
  heartbeat_t heartbeat{};
  heartbeat.service = options_.name;
  heartbeat.pid = getpid();
  heartbeat.status = status_;
  heartbeat.text = status_text_;
  heartbeat.cpu_s = process_cpu_s();
  heartbeat.rss_mb = process_rss_mb();
  heartbeat.step_p50_ms = timer_.quantile_ms(0.5);
  heartbeat.step_p99_ms = timer_.quantile_ms(0.99);
  heartbeat.inputs = inputs();
  heartbeat.input_count = static_cast<std::int32_t>(heartbeat.inputs.size());
  publish(channel::kHeartbeat, heartbeat, now_);
}

std::vector<input_health_t> Node::inputs() const {
  std::vector<input_health_t> all = inbox_.health();
  all.push_back(lockstep_.health());
  return all;
}

void Node::send_bytes(lcm::LCM& lcm, const std::string& channel, const std::vector<std::uint8_t>& bytes) {
  ROVER_CHECK(bytes.size() <= kDatagramBytes || !fits_a_datagram(channel), channel, bytes.size());
  if (lcm.publish(channel, bytes.data(), static_cast<unsigned int>(bytes.size())) != 0)
    log("ERROR", "NOT_PUBLISHED channel=" + channel + " bytes=" + std::to_string(bytes.size()));
}

lcm::LCM& Node::share_bus() {
  ROVER_CHECK(!subscriptions_closed_);
  shares_bus_ = true;
  return lcm_;
}

void Node::close_subscriptions(int port) {
  subscriptions_closed_ = true;
  std::vector<std::string> channels;
  for (const input_health_t& input : inputs()) channels.push_back(input.channel);
  if (shares_bus_ || std::find(channels.begin(), channels.end(), ".*") != channels.end()) return;
  if (!keep_channels(channels, port)) log("WARN", "BUS_NOT_FILTERED channels=" + std::to_string(channels.size()));
}

bool Node::handle(int timeout_ms) {
  const int handled = lcm_.handleTimeout(timeout_ms);
  while (const auto tick = lockstep_.next()) process(*tick);
  if (lockstep_.ticks_timed_out()) {
    log("WARN", "NO_TICKS");
    if (tick_timeout_) tick_timeout_();
  }
  return handled >= 0;
}

void Node::run(const std::function<bool()>& running) {
  constexpr int kAnnounceMs = 50;
  constexpr int kPollMs = 20;
  auto announced = std::chrono::steady_clock::time_point{};
  while (running()) {
    if (now_ == kNever && std::chrono::steady_clock::now() - announced > std::chrono::milliseconds(kAnnounceMs)) {
      announce();
      announced = std::chrono::steady_clock::now();
    }
    if (!handle(kPollMs) && running()) {  // a signal that ends the node also ends the wait
      log("ERROR", "BUS_FAILED");
      return;
    }
  }
}

}  // namespace rover
