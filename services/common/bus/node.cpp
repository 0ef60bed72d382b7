#include "common/bus/node.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "common/core/frames.hpp"

namespace rover {
namespace {

using Clock = std::chrono::steady_clock;

constexpr Utime kHeartbeatPeriod = 10 * kTickUs;
// Wall time that a lockstep tick waits for messages that are listed but not here: only loss or reordering on the bus
// makes it wait at all. A stream never seen is given less, because it may be of a process that is not running.
constexpr auto kPatience = std::chrono::seconds(2);
constexpr auto kPatienceUnknown = std::chrono::milliseconds(50);
// Wall time without ticks that follow the clock; they come every 20 ms.
constexpr auto kSilence = std::chrono::milliseconds(300);

bool is_power_of_two(std::int64_t n) {
  return (n & (n - 1)) == 0;
}

// A vehicle's driver need not know who listens: its ticks name nobody and are for all.
bool is_for(const std::string& name, const tick_t& tick) {
  if (tick.members.empty() && tick.mode == tick_t::REALTIME) return true;
  return std::find(tick.members.begin(), tick.members.end(), name) != tick.members.end();
}

input_health_t nothing_yet(const std::string& channel) {
  input_health_t health{};
  health.channel = channel;
  health.last_utime = kNever;
  health.received = health.gaps = health.malformed = health.out_of_order = 0;
  return health;
}

}  // namespace

// What the node keeps of one channel it takes.
struct Node::Subscription {
  struct Progress {
    std::int64_t boot_id = 0;
    std::int64_t seq = 0;
    Utime utime = kNever;
  };
  std::string channel;  // ".*" for the raw one
  std::int64_t fingerprint = 0;
  FindChannelType types = nullptr;  // of the raw one: by channel, not by fingerprint
  Utime slow = 0;
  Decode decode;
  input_health_t health{};
  std::map<std::string, Progress> progress;  // by channel and publisher
};

struct Node::Pending {
  Utime release = 0;
  Subscription* subscription = nullptr;
  std::string channel;
  header_t header{};
  Deliver deliver;                  // empty: the tap has damaged it
  std::vector<std::uint8_t> bytes;  // for the tap, empty where none is to see it
};

struct Node::QueuedTick {
  tick_t tick{};
  Clock::time_point arrived;
};

Node::Node(NodeOptions options, lcm::LCM& lcm, lcm::LCM* reports)
    : options_(std::move(options)),
      lcm_(lcm),
      reports_(reports == nullptr ? lcm : *reports),
      streams_(options_.name, options_.boot_id),
      reports_counter_(options_.name, options_.boot_id),
      ticks_health_(nothing_yet(channel::kTick)) {
  if (options_.allow_injection || !options_.muted.empty()) {
    tap_ = std::make_unique<Tap>(options_.name);
    for (const std::string& channel : options_.muted) tap_->mute(channel);
  }
  if (options_.allow_injection)
    subscribe<injection_t>(channel::kInject, [this](const injection_t& injection) { obey(injection); });
  auto* subscription = lcm_.subscribeFunction(
      channel::kTick,
      +[](const lcm::ReceiveBuffer* buffer, const std::string& channel, Node* node) {
        node->receive_tick(buffer, channel);
      },
      this);
  subscription->setQueueCapacity(0);
  taken_.push_back(subscription);
}

Node::~Node() {
  for (lcm::Subscription* subscription : taken_) lcm_.unsubscribe(subscription);
}

Node::Subscription& Node::add_subscription(const std::string& channel, std::int64_t fingerprint, Utime slow,
                                           Decode decode) {
  auto owned = std::make_unique<Subscription>();
  Subscription& added = *owned;
  added.channel = channel;
  added.fingerprint = fingerprint;
  added.slow = slow;
  added.decode = std::move(decode);
  added.health = nothing_yet(channel);
  subscriptions_.push_back(std::move(owned));
  struct Context {
    Node* node;
    Subscription* subscription;
  };
  auto* subscription = lcm_.subscribeFunction(
      channel,
      +[](const lcm::ReceiveBuffer* buffer, const std::string& from, Context context) {
        context.node->receive(buffer, from, *context.subscription);
      },
      Context{this, &added});
  subscription->setQueueCapacity(0);
  taken_.push_back(subscription);
  return added;
}

void Node::subscribe_raw(std::function<void(const RawMessage&)> handler, FindChannelType types) {
  const auto shared = std::make_shared<const std::function<void(const RawMessage&)>>(std::move(handler));
  Subscription& added = add_subscription(".*", 0, 0, [shared, types](RawMessage raw) -> Deliver {
    const ChannelType* type = types(raw.channel);
    if (type != nullptr && !type->decodes(raw.bytes.data(), static_cast<int>(raw.bytes.size()))) return nullptr;
    const auto message = std::make_shared<const RawMessage>(std::move(raw));
    return [shared, message] { (*shared)(*message); };
  });
  added.types = types;
}

std::int64_t Node::fingerprint_of(const Subscription& subscription, const std::string& channel) {
  if (subscription.types == nullptr) return subscription.fingerprint;
  const ChannelType* type = subscription.types(channel);
  return type == nullptr ? 0 : type->fingerprint;
}

// A message is noted in the ledger only when all of it is sound: a damaged copy must not stand in for the sound one.
void Node::receive(const lcm::ReceiveBuffer* buffer, const std::string& channel, Subscription& subscription) {
  // LCM's own, at each start of a process; and reports to the giver of ticks, where they share the bus.
  if (channel == "LCM_SELF_TEST" || channel == channel::kDone) return;
  const int size = static_cast<int>(buffer->data_size);
  const auto* begin = static_cast<const std::uint8_t*>(buffer->data);
  const auto drop = [&](const char* why) { count_malformed(subscription.health, channel, why); };
  const std::int64_t fingerprint = fingerprint_of(subscription, channel);
  if (size < kFingerprintBytes) return drop("truncated");
  if (fingerprint != 0 && peek_fingerprint(begin, size) != fingerprint) return drop("foreign fingerprint");
  Pending pending;
  if (!peek_header(begin, size, pending.header)) return drop("truncated");
  pending.deliver = subscription.decode({channel, pending.header, {begin, begin + size}});
  if (!pending.deliver) return drop("truncated or damaged");
  if (pending.header.seq <= 0) return drop("no sequence number");
  const bool raw = subscription.types != nullptr;
  // Where injection is allowed the raw subscription is the second to take INJECT, and not the one that keeps the
  // ledger.
  const bool second = raw && tap_ && options_.allow_injection && channel == channel::kInject;
  if (!second && !ledger_.arrived(channel, pending.header)) {
    ++subscription.health.out_of_order;
    return;
  }
  if (tap_ && tap_->mutes(channel)) return;
  pending.channel = channel;
  if (tap_ && !raw) pending.bytes.assign(begin, begin + size);
  enqueue(subscription, std::move(pending), 0);
}

void Node::enqueue(Subscription& subscription, Pending pending, Utime delay) {
  pending.release = pending.header.release_utime + delay;
  pending.subscription = &subscription;
  pending_.push_back(std::move(pending));
}

void Node::obey(const injection_t& injection) {
  const bool mine = tap_->inject(injection);
  if (on_injection_) on_injection_(injection);
  if (mine) log("WARN", "INJECTED fault=" + injection.fault + " target=" + injection.target);
}

// Injections first: they hold for what is taken with them.
std::vector<Node::Pending> Node::through_tap(std::vector<Pending> released) {
  std::vector<Pending> others;
  for (Pending& pending : released) {
    if (pending.subscription->channel == channel::kInject)
      dispatch(pending);
    else
      others.push_back(std::move(pending));
  }
  std::vector<Pending> passed;
  for (Pending& pending : others) {
    if (pending.bytes.empty())
      passed.push_back(std::move(pending));
    else
      tap_one(std::move(pending), passed);
  }
  return passed;
}

// A bus with check sums hands on no damaged header, so damage there is malformed input like any other: taken at its
// word it would end the stream for good.
void Node::tap_one(Pending pending, std::vector<Pending>& passed) {
  const auto identity = [](const header_t& h) { return std::tie(h.publisher, h.boot_id, h.seq, h.release_utime); };
  for (Tap::Passed& through : tap_->pass(pending.channel, pending.header, std::move(pending.bytes))) {
    Pending tapped{pending.release, pending.subscription, pending.channel, pending.header};
    header_t header{};
    const bool readable = peek_header(through.bytes.data(), static_cast<int>(through.bytes.size()), header);
    if (readable && identity(header) == identity(pending.header))
      tapped.deliver = tapped.subscription->decode({tapped.channel, header, std::move(through.bytes)});
    if (through.delay > 0)
      enqueue(*pending.subscription, std::move(tapped), through.delay);
    else
      passed.push_back(std::move(tapped));
  }
}

// Which messages from before its first tick a process that was started again has heard depends on how fast it started:
// it takes none of them.
void Node::forget_before(Utime first_tick) {
  std::erase_if(pending_, [first_tick](const Pending& pending) { return pending.header.release_utime < first_tick; });
}

void Node::receive_tick(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
  const int size = static_cast<int>(buffer->data_size);
  QueuedTick queued{{}, Clock::now()};
  if (!decode_message(buffer->data, size, queued.tick)) {
    const bool foreign = size >= kFingerprintBytes && peek_fingerprint(buffer->data, size) != tick_t::getHash();
    return count_malformed(ticks_health_, channel, foreign ? "foreign fingerprint" : "truncated or damaged");
  }
  if (!is_for(options_.name, queued.tick)) return;
  const Utime latest = ticks_.empty() ? now_ : ticks_.back().tick.header.utime;
  if (queued.tick.header.utime > latest) {
    ticks_.push_back(std::move(queued));
  } else if (queued.tick.header.utime == now_ && queued.tick.mode == tick_t::LOCKSTEP) {
    report(last_done_);  // the world did not hear it
  }
}

void Node::process_ready_ticks() {
  while (!ticks_.empty() && holds_all_for(ticks_.front())) {
    const tick_t tick = std::move(ticks_.front().tick);
    ticks_.pop_front();
    process(tick);
  }
}

bool Node::holds_all_for(QueuedTick& queued) {
  if (queued.tick.mode == tick_t::REALTIME) return true;
  const auto waited = Clock::now() - queued.arrived;
  for (const stream_seq_t& stream : queued.tick.streams) {
    const bool taken = std::any_of(subscriptions_.begin(), subscriptions_.end(), [&](const auto& subscription) {
      return subscription->channel == stream.channel || subscription->channel == ".*";
    });
    if (!taken || stream.publisher == options_.name || ledger_.complete(stream)) continue;
    if (waited < (ledger_.known(stream) ? Clock::duration(kPatience) : Clock::duration(kPatienceUnknown))) return false;
    if (ledger_.known(stream)) log("WARN", "LOST_ON_BUS channel=" + stream.channel + " publisher=" + stream.publisher);
    ledger_.give_up(stream);
  }
  return true;
}

std::vector<Node::Pending> Node::take_released(Utime until) {
  const auto later = [until](const Pending& pending) { return pending.release > until; };
  const auto split = std::stable_partition(pending_.begin(), pending_.end(), later);
  std::vector<Pending> released(std::make_move_iterator(split), std::make_move_iterator(pending_.end()));
  pending_.erase(split, pending_.end());
  std::stable_sort(released.begin(), released.end(), [](const Pending& a, const Pending& b) {
    const auto key = [](const Pending& p) {
      return std::tie(p.release, p.channel, p.header.publisher, p.header.boot_id, p.header.seq);
    };
    return key(a) < key(b);
  });
  return released;
}

void Node::process(const tick_t& tick) {
  if (now_ == kNever && options_.boot_id > 1) forget_before(tick.header.utime);
  now_ = ticks_health_.last_utime = tick.header.utime;
  ++ticks_health_.received;
  const bool lockstep = tick.mode == tick_t::LOCKSTEP;
  if (!lockstep) last_tick_wall_ = Clock::now();
  std::vector<Pending> released = take_released(now_);
  if (tap_) released = through_tap(std::move(released));
  Utime slow = 0;
  for (const Pending& pending : released) slow = std::max(slow, pending.subscription->slow);
  if (slow > 0) {
    promise_ = std::max(promise_, now_ + slow);
    if (lockstep) publish_done(now_, true);
    timer_.begin();
  }
  for (const Pending& pending : released) dispatch(pending);
  if (slow > 0) timer_.end();
  if (step_) step_(now_);
  if (now_ % kHeartbeatPeriod == 0) publish_heartbeat();
  if (lockstep) publish_done(now_);
}

bool Node::in_order(Subscription& subscription, const std::string& channel, const header_t& header) {
  auto& progress = subscription.progress[channel + '/' + header.publisher];
  if (header.boot_id < progress.boot_id) return false;
  if (header.boot_id > progress.boot_id) progress = {header.boot_id, 0, kNever};
  if (header.seq <= progress.seq || header.utime < progress.utime) return false;
  if (progress.seq > 0) subscription.health.gaps += header.seq - progress.seq - 1;
  progress = {header.boot_id, header.seq, header.utime};
  return true;
}

void Node::dispatch(const Pending& pending) {
  Subscription& subscription = *pending.subscription;
  if (!pending.deliver) return count_malformed(subscription.health, pending.channel, "truncated or damaged");
  if (!in_order(subscription, pending.channel, pending.header)) {
    ++subscription.health.out_of_order;
    return;
  }
  subscription.health.last_utime = pending.header.utime;
  ++subscription.health.received;
  pending.deliver();
}

void Node::count_malformed(input_health_t& health, const std::string& channel, const std::string& why) {
  ++health.malformed;
  const std::int64_t count = ++malformed_[{health.channel, channel}];
  if (is_power_of_two(count))
    log("WARN", "BAD_MESSAGE channel=" + channel + " count=" + std::to_string(count) + " why=" + why);
}

void Node::reject(const std::string& channel, const std::string& why) {
  for (const auto& subscription : subscriptions_)
    if (subscription->channel == channel) return count_malformed(subscription->health, channel, why);
}

double Node::age_s(const std::string& channel) const {
  for (const auto& subscription : subscriptions_)
    if (subscription->channel == channel && subscription->health.last_utime != kNever)
      return to_seconds(now_ - subscription->health.last_utime);
  return kInfinity;
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
  for (const auto& subscription : subscriptions_) heartbeat.inputs.push_back(subscription->health);
  heartbeat.inputs.push_back(ticks_health_);
  heartbeat.input_count = static_cast<std::int32_t>(heartbeat.inputs.size());
  publish(channel::kHeartbeat, heartbeat, now_);
}

void Node::publish_done(Utime tick, bool busy) {
  last_done_.tick_utime = tick;
  last_done_.busy = busy ? 1 : 0;
  last_done_.promise_utime = promise_;
  last_done_.pid = getpid();
  last_done_.streams = streams_.take_grown();
  last_done_.stream_count = static_cast<std::int32_t>(last_done_.streams.size());
  last_done_.header = reports_counter_.next(channel::kDone, tick, std::max(tick, promise_));
  report(last_done_);
}

void Node::report(const done_t& done) {
  send(reports_, channel::kDone, done);
}

void Node::send_bytes(lcm::LCM& lcm, const std::string& channel, const std::vector<std::uint8_t>& bytes) {
  if (lcm.publish(channel, bytes.data(), static_cast<unsigned int>(bytes.size())) != 0)
    log("ERROR", "NOT_PUBLISHED channel=" + channel);
}

void Node::announce() {
  done_t hello{};
  hello.header.utime = hello.header.release_utime = kNever;
  hello.header.seq = 0;
  hello.header.publisher = options_.name;
  hello.header.boot_id = options_.boot_id;
  hello.tick_utime = hello.promise_utime = kNever;
  hello.pid = getpid();
  hello.stream_count = 0;
  report(hello);
}

bool Node::handle(int timeout_ms) {
  const int handled = lcm_.handleTimeout(timeout_ms);
  process_ready_ticks();
  look_for_silence();
  return handled >= 0;
}

void Node::look_for_silence() {
  if (!last_tick_wall_ || Clock::now() - *last_tick_wall_ < kSilence) return;
  last_tick_wall_.reset();
  log("WARN", "NO_TICKS");
  if (silence_) silence_();
}

void Node::run(const std::function<bool()>& running) {
  constexpr int kAnnounceMs = 50;
  constexpr int kPollMs = 20;
  auto announced = Clock::time_point{};
  while (running()) {
    if (now_ == kNever && Clock::now() - announced > std::chrono::milliseconds(kAnnounceMs)) {
      announce();
      announced = Clock::now();
    }
    if (!handle(kPollMs) && running()) {  // a signal that ends the node also ends the wait
      log("ERROR", "BUS_FAILED");
      return;
    }
  }
}

}  // namespace rover
