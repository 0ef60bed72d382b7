// Plays a log tick by tick in recorded order. Messages of live services are muted.
#pragma once

#include <chrono>
#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/replay/clock_master.hpp"
#include "tools/replay/comparison.hpp"
#include "tools/replay/keyboard.hpp"
#include "tools/replay/pacer.hpp"
#include "tools/replay/recorded_log.hpp"

namespace rover::replay {

struct PlayerOptions {
  std::vector<std::string> live;  // running services; their recorded messages are muted
  struct Process {
    std::int64_t boot_id = 0;
    Utime last_release = kNever;  // of its messages
    Utime left = kNever;          // first tick without it
  };
  // First process of a live service whose process ended in the log: after it the recorded messages are played.
  std::map<std::string, Process> ended;
  double speed = 1.0;   // 0: as fast as possible
  Utime from = kNever;  // first and last tick to play; kNever: those of the log
  Utime until = kNever;
};

struct PlayerHooks {
  std::function<bool()> running = [] { return true; };
  std::function<std::optional<Key>()> key = [] { return std::nullopt; };
  std::function<void(Utime now, const Pacer& pacer)> show = [](Utime, const Pacer&) {};
};

struct PlayResult {
  Utime first = kNever;  // tick times
  Utime last = kNever;
  double wall_s = 0.0;
  bool quit = false;  // by key or by request
  double sim_s() const { return to_seconds(last - first); }
};

class Player {
 public:
  // `comparison` null: messages are not compared.
  Player(const PlayerOptions& options, RecordedLog& log, lcm::LCM& bus, lcm::LCM& reports, Comparison* comparison);
  // Throws ServiceGone.
  PlayResult play(const PlayerHooks& hooks);

 private:
  using Clock = std::chrono::steady_clock;
  double wall_s() const { return std::chrono::duration<double>(Clock::now() - started_).count(); }
  bool is_live(const header_t& header) const;
  void stop_ended(Utime t, const PlayerHooks& hooks);
  void play_group(const TickGroup& group, const PlayerHooks& hooks);
  void publish(const LogMessage& message);
  bool wait_until_due(Utime t, const PlayerHooks& hooks);
  void handle_key(Key key, Utime t);
  void resume_from(Utime t, const PlayerHooks& hooks);
  void seek(Utime t, const PlayerHooks& hooks);
  void receive();
  void finish(const PlayerHooks& hooks);
  void on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel);

  PlayerOptions options_;
  std::set<std::string> live_;
  std::set<std::string> stopped_;  // of them
  RecordedLog& log_;
  lcm::LCM& bus_;
  Comparison* comparison_;
  ClockMaster ticks_;
  ArrivalLedger arrivals_;
  Pacer pacer_;
  Clock::time_point started_;
  bool quit_ = false;
  std::optional<Utime> seek_time_;  // requested seek time
};

}  // namespace rover::replay
