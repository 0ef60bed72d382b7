#include "tools/replay/player.hpp"

#include <algorithm>
#include <thread>

#include "common/bus/channels.hpp"

namespace rover::replay {
namespace {

constexpr Utime kSeekStep = 10'000'000;
constexpr double kSpeedStep = 2.0;
constexpr double kLook_s = 0.02;  // how often keys are looked for while waiting
constexpr double kLost_s = 2.0;   // a message that was reported and does not come in this time is lost

}  // namespace

Player::Player(const PlayerOptions& options, RecordedLog& log, lcm::LCM& bus, lcm::LCM& reports, Comparison* judge)
    : options_(options),
      live_(options.live.begin(), options.live.end()),
      log_(log),
      bus_(bus),
      judge_(judge),
      ticks_(options.live, bus, reports),
      pacer_(options.speed) {
  if (options_.from == kNever) options_.from = log.ticks().front();
  if (options_.until == kNever) options_.until = log.ticks().back();
  if (judge_ != nullptr) bus_.subscribe(".*", &Player::on_message, this)->setQueueCapacity(0);
}

void Player::on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
  header_t header{};
  const auto* begin = static_cast<const std::uint8_t*>(buffer->data);
  if (channel == channel::kHeartbeat || channel == channel::kTick || channel == channel::kDone) return;
  if (!peek_header(begin, static_cast<int>(buffer->data_size), header) || !is_live(header.publisher)) return;
  heard_.arrived(channel, header);
  judge_->said_now({channel, header.publisher, header.boot_id, header.seq, header.utime, header.release_utime},
                   {begin, begin + buffer->data_size});
}

Played Player::play(const PlayerHooks& hooks) {
  started_ = Clock::now();
  ticks_.wait_for_start(hooks.running);
  started_ = Clock::now();
  Played played;
  log_.seek(options_.from);
  std::optional<TickGroup> group = log_.next();
  if (group) pacer_.go_from(group->tick, wall_s());
  for (; group && group->tick <= options_.until && hooks.running(); group = log_.next()) {
    if (played.last != kNever && group->tick - played.last > kLongestPause) go_on_from(group->tick, hooks);
    if (!wait_until_due(group->tick, hooks)) break;
    if (wanted_) {
      seek(*wanted_, hooks);
      continue;
    }
    play_group(*group, hooks);
    if (played.first == kNever) played.first = group->tick;
    played.last = group->tick;
    hooks.show(group->tick, pacer_);
  }
  finish(hooks);
  played.wall_s = wall_s();
  played.quit = quit_ || !hooks.running();
  return played;
}

void Player::play_group(const TickGroup& group, const PlayerHooks& hooks) {
  for (const LogMessage& message : group.messages) {
    if (message.header && is_live(message.header->publisher)) {
      if (judge_ == nullptr || message.channel == channel::kHeartbeat) continue;
      const header_t& h = *message.header;
      judge_->recorded({message.channel, h.publisher, h.boot_id, h.seq, h.utime, h.release_utime}, message.bytes);
      continue;
    }
    publish(message);
  }
  // Without live services whoever listens gets the ticks as they were.
  if (live_.empty())
    publish(group.tick_message);
  else
    ticks_.give(group.tick, hooks.running);
  hear();
}

void Player::publish(const LogMessage& message) {
  bus_.publish(message.channel, message.bytes.data(), static_cast<unsigned int>(message.bytes.size()));
  if (message.header && !live_.empty()) ticks_.list(message.channel, *message.header);
}

// False where the replay is to end.
bool Player::wait_until_due(Utime t, const PlayerHooks& hooks) {
  while (hooks.running() && !quit_ && !wanted_) {
    if (const auto key = hooks.key()) {
      obey(*key, t);
      continue;
    }
    const double wait_s = pacer_.wait_s(t, wall_s());
    if (wait_s <= 0.0) break;
    if (pacer_.paused()) hooks.show(t, pacer_);
    std::this_thread::sleep_for(std::chrono::duration<double>(std::min(wait_s, kLook_s)));
  }
  return hooks.running() && !quit_;
}

void Player::obey(Key key, Utime t) {
  switch (key) {
    case Key::kPause:
      pacer_.paused() ? pacer_.resume(wall_s()) : pacer_.pause(wall_s());
      break;
    case Key::kForward:
      wanted_ = t + kSeekStep;
      break;
    case Key::kBack:
      if (live_.empty()) wanted_ = t - kSeekStep;  // the message time of services never falls
      break;
    case Key::kFaster:
    case Key::kSlower:
      if (pacer_.speed() > 0.0)
        pacer_.set_speed(pacer_.speed() * (key == Key::kFaster ? kSpeedStep : 1.0 / kSpeedStep), wall_s());
      break;
    case Key::kQuit:
      quit_ = true;
      break;
  }
}

// In one step, for which nobody waits.
void Player::go_on_from(Utime t, const PlayerHooks& hooks) {
  ticks_.wait_until_idle(hooks.running);
  ticks_.jump(t);
  pacer_.go_from(t, wall_s());
}

void Player::seek(Utime t, const PlayerHooks& hooks) {
  wanted_.reset();
  const auto& all = log_.ticks();
  const Utime last = std::min(options_.until, all.back());
  const Utime to = *std::lower_bound(all.begin(), all.end(), std::clamp(t, options_.from, last));
  go_on_from(to, hooks);
  log_.seek(to);
}

void Player::hear() {
  if (judge_ == nullptr) return;
  while (bus_.handleTimeout(0) > 0) {
  }
}

// All that the services have said is waited for: a report may overtake the messages that it lists.
void Player::finish(const PlayerHooks& hooks) {
  ticks_.wait_until_idle(hooks.running);
  if (judge_ == nullptr) return;
  std::vector<stream_seq_t> awaited = ticks_.reported();
  std::erase_if(awaited, [](const stream_seq_t& stream) { return stream.channel == channel::kHeartbeat; });
  const double begun_s = wall_s();
  const auto here = [this](const stream_seq_t& stream) { return heard_.complete(stream); };
  while (std::erase_if(awaited, here), !awaited.empty() && wall_s() - begun_s < kLost_s) bus_.handleTimeout(5);
}

}  // namespace rover::replay
