// Plays a log: its messages in recorded order, tick by tick, without those that live services say themselves.
#pragma once

#include <chrono>
#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/replay/comparison.hpp"
#include "tools/replay/keyboard.hpp"
#include "tools/replay/pacer.hpp"
#include "tools/replay/recorded_log.hpp"
#include "tools/replay/tick_giver.hpp"

namespace rover::replay {

struct PlayerOptions {
  std::vector<std::string> live;  // services that run; what they said in the log is muted
  double speed = 1.0;             // 0: as fast as possible
  Utime from = kNever;            // first and last tick played; kNever: of the log
  Utime until = kNever;
};

struct PlayerHooks {
  std::function<bool()> running = [] { return true; };
  std::function<std::optional<Key>()> key = [] { return std::nullopt; };
  std::function<void(Utime now, const Pacer& pacer)> show = [](Utime, const Pacer&) {};
};

struct Played {
  Utime first = kNever;  // ticks
  Utime last = kNever;
  double wall_s = 0.0;
  bool quit = false;  // by key, or because it was to stop
  double sim_s() const { return to_seconds(last - first); }
};

class Player {
 public:
  // `judge` null: nothing is compared.
  Player(const PlayerOptions& options, RecordedLog& log, lcm::LCM& bus, lcm::LCM& reports, Comparison* judge);
  // Throws ServiceGone.
  Played play(const PlayerHooks& hooks);

 private:
  using Clock = std::chrono::steady_clock;
  double wall_s() const { return std::chrono::duration<double>(Clock::now() - started_).count(); }
  bool is_live(const std::string& publisher) const { return live_.contains(publisher); }
  void play_group(const TickGroup& group, const PlayerHooks& hooks);
  void publish(const LogMessage& message);
  bool wait_until_due(Utime t, const PlayerHooks& hooks);
  void obey(Key key, Utime t);
  void go_on_from(Utime t, const PlayerHooks& hooks);
  void seek(Utime t, const PlayerHooks& hooks);
  void hear();
  void finish(const PlayerHooks& hooks);
  void on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel);

  PlayerOptions options_;
  std::set<std::string> live_;
  RecordedLog& log_;
  lcm::LCM& bus_;
  Comparison* judge_;
  TickGiver ticks_;
  ArrivalLedger heard_;
  Pacer pacer_;
  Clock::time_point started_;
  bool quit_ = false;
  std::optional<Utime> wanted_;  // a seek that was asked for
};

}  // namespace rover::replay
