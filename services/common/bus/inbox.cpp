#include "common/bus/inbox.hpp"

#include <algorithm>
#include <tuple>

#include "common/bus/channels.hpp"
#include "common/core/check.hpp"

namespace rover {
namespace {

bool is_power_of_two(std::int64_t n) {
  return (n & (n - 1)) == 0;
}

}  // namespace

input_health_t no_input_yet(const std::string& channel) {
  input_health_t health{};
  health.channel = channel;
  health.last_utime = kNever;
  health.received = health.gaps = health.malformed = health.out_of_order = 0;
  return health;
}

struct Inbox::Subscription {
  struct Progress {
    std::int64_t boot_id = 0;
    std::int64_t seq = 0;
    Utime utime = kNever;
  };
  std::string channel;  // ".*" for the raw one
  std::int64_t fingerprint = 0;
  Utime slow = 0;
  Decode decode;
  FindChannelType types = nullptr;  // of the raw one: by channel, not by fingerprint
  input_health_t health{};
  std::map<std::string, Progress> progress;  // by channel and publisher
  lcm::Subscription* on_bus = nullptr;       // the bus outlives it

  std::int64_t fingerprint_of(const std::string& from) const {
    if (types == nullptr) return fingerprint;
    const ChannelType* type = types(from);
    return type == nullptr ? 0 : type->fingerprint;
  }
};

Inbox::Inbox(lcm::LCM& lcm, std::unique_ptr<FaultInjector> injector, bool allow_injection, EventLog log)
    : lcm_(lcm), injector_(std::move(injector)), allow_injection_(allow_injection), log_(std::move(log)) {}

Inbox::~Inbox() {
  for (const auto& subscription : subscriptions_) lcm_.unsubscribe(subscription->on_bus);
}

void Inbox::add(const std::string& channel, std::int64_t fingerprint, Utime slow, Decode decode,
                FindChannelType types) {
  // LCM takes names as regular expressions; sequence numbers and the filter of the bus go by names.
  ROVER_CHECK(channel == ".*" || channel.find_first_of(".*+?[](){}|\\^$") == std::string::npos, channel);
  subscriptions_.push_back(std::make_unique<Subscription>(
      Subscription{channel, fingerprint, slow, std::move(decode), types, no_input_yet(channel)}));
  struct Context {
    Inbox* inbox;
    Subscription* subscription;
  };
  Subscription& added = *subscriptions_.back();
  added.on_bus = lcm_.subscribeFunction(
      channel,
      +[](const lcm::ReceiveBuffer* buffer, const std::string& from, Context context) {
        context.inbox->receive(buffer, from, *context.subscription);
      },
      Context{this, &added});
  added.on_bus->setQueueCapacity(0);
}

// Only undamaged messages enter the ledger, so that a damaged copy cannot replace the undamaged one.
void Inbox::receive(const lcm::ReceiveBuffer* buffer, const std::string& channel, Subscription& subscription) {
  // LCM's self test at each start of a process, and reports to the clock master if they share the bus.
  if (channel == "LCM_SELF_TEST" || channel == channel::kDone) return;
  const int size = static_cast<int>(buffer->data_size);
  const auto* begin = static_cast<const std::uint8_t*>(buffer->data);
  const auto drop = [&](const char* why) { count_malformed(subscription.health, channel, why); };
  const std::int64_t fingerprint = subscription.fingerprint_of(channel);
  if (size < kFingerprintBytes) return drop("truncated");
  if (fingerprint != 0 && peek_fingerprint(begin, size) != fingerprint) return drop("foreign fingerprint");
  Pending pending;
  if (!peek_header(begin, size, pending.header)) return drop("truncated");
  pending.deliver = subscription.decode({channel, pending.header, {begin, begin + size}});
  if (!pending.deliver) return drop("truncated or damaged");
  if (pending.header.seq <= 0) return drop("no sequence number");
  const bool raw = subscription.types != nullptr;
  // If injection is allowed, INJECT has two subscriptions, and the raw one must not use the ledger again.
  const bool second = raw && injector_ && allow_injection_ && channel == channel::kInject;
  if (!second && !ledger_.arrived(channel, pending.header)) {
    ++subscription.health.out_of_order;
    return;
  }
  // It has arrived, so the tick that lists it does not wait for it.
  if (pending.header.utime > pending.header.release_utime) return drop("measured after its release");
  if (injector_ && injector_->mutes(channel)) return;
  pending.channel = channel;
  if (injector_ && !raw) pending.bytes.assign(begin, begin + size);
  enqueue(subscription, std::move(pending), 0);
}

void Inbox::enqueue(Subscription& subscription, Pending pending, Utime delay) {
  pending.release = pending.header.release_utime + delay;
  pending.subscription = &subscription;
  pending.slow = subscription.slow;
  pending_.push_back(std::move(pending));
}

bool Inbox::misses(const stream_seq_t& stream) const {
  const bool taken = std::any_of(subscriptions_.begin(), subscriptions_.end(), [&](const auto& subscription) {
    return subscription->channel == stream.channel || subscription->channel == ".*";
  });
  return taken && !ledger_.complete(stream);
}

std::vector<Inbox::Pending> Inbox::take_released(Utime until) {
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
  return injector_ ? apply_injections(std::move(released)) : released;
}

// Injections first: they apply to the messages released with them.
std::vector<Inbox::Pending> Inbox::apply_injections(std::vector<Pending> released) {
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
      inject_faults(std::move(pending), passed);
  }
  return passed;
}

// A fault that changed the header makes the message malformed: a wrong seq or boot_id would end the stream.
void Inbox::inject_faults(Pending pending, std::vector<Pending>& passed) {
  const auto identity = [](const header_t& h) { return std::tie(h.publisher, h.boot_id, h.seq, h.release_utime); };
  for (FaultInjector::Output& result : injector_->apply(pending.channel, pending.header, std::move(pending.bytes))) {
    Pending output{pending.release, pending.slow, pending.subscription, pending.channel, pending.header};
    header_t header{};
    const bool readable = peek_header(result.bytes.data(), static_cast<int>(result.bytes.size()), header);
    if (readable && identity(header) == identity(pending.header) && header.utime <= header.release_utime)
      output.deliver = output.subscription->decode({output.channel, header, std::move(result.bytes)});
    if (result.delay > 0)
      enqueue(*pending.subscription, std::move(output), result.delay);
    else
      passed.push_back(std::move(output));
  }
}

void Inbox::forget_before(Utime first_tick) {
  std::erase_if(pending_, [first_tick](const Pending& pending) { return pending.header.release_utime < first_tick; });
}

bool Inbox::in_order(Subscription& subscription, const std::string& channel, const header_t& header) {
  auto& progress = subscription.progress[channel + '/' + header.publisher];
  if (header.boot_id < progress.boot_id) return false;
  if (header.boot_id > progress.boot_id) progress = {header.boot_id, 0, kNever};
  if (header.seq <= progress.seq || header.utime < progress.utime) return false;
  if (progress.seq > 0) subscription.health.gaps += header.seq - progress.seq - 1;
  progress = {header.boot_id, header.seq, header.utime};
  return true;
}

void Inbox::dispatch(const Pending& pending) {
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

void Inbox::leave_out(const Pending& pending) {
  in_order(*pending.subscription, pending.channel, pending.header);
}

void Inbox::count_malformed(input_health_t& health, const std::string& channel, const std::string& why) {
  ++health.malformed;
  const std::int64_t count = ++malformed_[{health.channel, channel}];
  if (is_power_of_two(count))
    log_("WARN", "BAD_MESSAGE channel=" + channel + " count=" + std::to_string(count) + " why=" + why);
}

void Inbox::reject(const std::string& channel, const std::string& why) {
  for (const auto& subscription : subscriptions_)
    if (subscription->channel == channel) return count_malformed(subscription->health, channel, why);
}

const input_health_t* Inbox::health(const std::string& channel) const {
  for (const auto& subscription : subscriptions_)
    if (subscription->channel == channel) return &subscription->health;
  return nullptr;
}

std::vector<input_health_t> Inbox::health() const {
  std::vector<input_health_t> all;
  for (const auto& subscription : subscriptions_) all.push_back(subscription->health);
  return all;
}

}  // namespace rover
