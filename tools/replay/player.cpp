#include "tools/replay/player.hpp"

#include <algorithm>
#include <thread>

#include "common/bus/channels.hpp"

namespace rover::replay {
namespace {

constexpr Utime kSeekStep = 10'000'000;
constexpr double kSpeedStep = 2.0;
constexpr double kKeyPoll_s = 0.02;     // key polling interval while waiting
constexpr double kLostTimeout_s = 2.0;  // a reported message that does not arrive within this time is lost

}  // namespace

Player::Player(const PlayerOptions& options, RecordedLog& log, lcm::LCM& bus, lcm::LCM& reports, Comparison* comparison)
    : options_(options),
      live_(options.live.begin(), options.live.end()),
      log_(log),
      bus_(bus),
      comparison_(comparison),
      ticks_(options.live, bus, reports),
      pacer_(options.speed) {
  if (options_.from == kNever) options_.from = log.ticks().front();
  if (options_.until == kNever) options_.until = log.ticks().back();
  if (comparison_ != nullptr) bus_.subscribe(".*", &Player::on_message, this)->setQueueCapacity(0);
}

void Player::on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
  header_t header{};
  const auto* begin = static_cast<const std::uint8_t*>(buffer->data);
  if (channel == channel::kHeartbeat || channel == channel::kTick || channel == channel::kDone) return;
  if (!peek_header(begin, static_cast<int>(buffer->data_size), header) || !is_live(header)) return;
  const auto ended = options_.ended.find(header.publisher);
  if (ended != options_.ended.end() && header.release_utime > ended->second.last_release) return;
  arrivals_.arrived(channel, header);
  comparison_->add_live({channel, header.publisher, header.boot_id, header.seq, header.utime, header.release_utime},
                        {begin, begin + buffer->data_size});
}

bool Player::is_live(const header_t& header) const {
  if (!live_.contains(header.publisher)) return false;
  const auto ended = options_.ended.find(header.publisher);
  return ended == options_.ended.end() || header.boot_id <= ended->second.boot_id;
}

void Player::stop_ended(Utime t, const PlayerHooks& hooks) {
  for (const auto& [service, process] : options_.ended) {
    if (t < process.left || !stopped_.insert(service).second) continue;
    ticks_.wait_until_idle(hooks.running);
    ticks_.stop(service);
  }
}

PlayResult Player::play(const PlayerHooks& hooks) {
  started_ = Clock::now();
  ticks_.wait_for_start(hooks.running);
  started_ = Clock::now();
  PlayResult played;
  log_.seek(options_.from);
  std::optional<TickGroup> group = log_.next();
  if (group) pacer_.go_from(group->tick, wall_s());
  for (; group && group->tick <= options_.until && hooks.running(); group = log_.next()) {
    if (played.last != kNever && group->tick - played.last > kLongestPause) resume_from(group->tick, hooks);
    if (!wait_until_due(group->tick, hooks)) break;
    if (seek_time_) {
      seek(*seek_time_, hooks);
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
  stop_ended(group.tick, hooks);
  for (const LogMessage& message : group.messages) {
    if (message.header && is_live(*message.header)) {
      if (comparison_ == nullptr || message.channel == channel::kHeartbeat) continue;
      const header_t& h = *message.header;
      comparison_->add_recorded({message.channel, h.publisher, h.boot_id, h.seq, h.utime, h.release_utime},
                                message.bytes);
      continue;
    }
    publish(message);
  }
  // Without live services, publish the recorded ticks unchanged.
  if (live_.empty())
    publish(group.tick_message);
  else
    ticks_.publish_tick(group.tick, hooks.running);
  receive();
}

void Player::publish(const LogMessage& message) {
  bus_.publish(message.channel, message.bytes.data(), static_cast<unsigned int>(message.bytes.size()));
  if (message.header && !live_.empty()) ticks_.list(message.channel, *message.header);
}

// Returns false if the replay must end.
bool Player::wait_until_due(Utime t, const PlayerHooks& hooks) {
  while (hooks.running() && !quit_ && !seek_time_) {
    if (const auto key = hooks.key()) {
      handle_key(*key, t);
      continue;
    }
    const double wait_s = pacer_.wait_s(t, wall_s());
    if (wait_s <= 0.0) break;
    if (pacer_.paused()) hooks.show(t, pacer_);
    std::this_thread::sleep_for(std::chrono::duration<double>(std::min(wait_s, kKeyPoll_s)));
  }
  return hooks.running() && !quit_;
}

void Player::handle_key(Key key, Utime t) {
  switch (key) {
    case Key::kPause:
      pacer_.paused() ? pacer_.resume(wall_s()) : pacer_.pause(wall_s());
      break;
    case Key::kForward:
      seek_time_ = t + kSeekStep;
      break;
    case Key::kBack:
      if (live_.empty()) seek_time_ = t - kSeekStep;  // message time of live services must not decrease
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

// Skips to t in one step, after all services are idle.
void Player::resume_from(Utime t, const PlayerHooks& hooks) {
  ticks_.wait_until_idle(hooks.running);
  ticks_.jump(t);
  pacer_.go_from(t, wall_s());
}

void Player::seek(Utime t, const PlayerHooks& hooks) {
  seek_time_.reset();
  const auto& all = log_.ticks();
  const Utime last = std::min(options_.until, all.back());
  const Utime to = *std::lower_bound(all.begin(), all.end(), std::clamp(t, options_.from, last));
  resume_from(to, hooks);
  log_.seek(to);
}

void Player::receive() {
  if (comparison_ == nullptr) return;
  while (bus_.handleTimeout(0) > 0) {
  }
}

// Waits for all published messages: a DONE report may arrive before the messages that it lists.
void Player::finish(const PlayerHooks& hooks) {
  ticks_.wait_until_idle(hooks.running);
  if (comparison_ == nullptr) return;
  std::vector<stream_seq_t> awaited = ticks_.reported();
  std::erase_if(awaited, [](const stream_seq_t& stream) { return stream.channel == channel::kHeartbeat; });
  const double started_s = wall_s();
  const auto here = [this](const stream_seq_t& stream) { return arrivals_.complete(stream); };
  while (std::erase_if(awaited, here), !awaited.empty() && wall_s() - started_s < kLostTimeout_s) bus_.handleTimeout(5);
}

}  // namespace rover::replay
