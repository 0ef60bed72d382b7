// A small log: a world that publishes IMU, and a service that replies one tick later.
#pragma once

#include <lcm/lcm-cpp.hpp>
#include <rover/imu_t.hpp>
#include <rover/slip_t.hpp>
#include <rover/tick_t.hpp>
#include <string>
#include <vector>

#include "common/bus/channels.hpp"
#include "common/bus/streams.hpp"

namespace rover::replay {

// For each tick k = 1 .. count (20 ms apart, from 1 s): IMU with dt_s = k, and SLIP of "echo" with slip_ratio = k - 1.
class MadeLog {
 public:
  static Utime tick_time(int k) { return 1'000'000 + (k - 1) * kTickUs; }

  // mode "a": append to the file, as `cat` joins logs. From tick `jump_at` on, the clock is shifted by `jump`. For 20
  // ticks from `left_at` on there is no service; then another process of it adds 1000 to its replies.
  MadeLog(const std::string& path, int count, const char* mode = "w", int jump_at = 0, Utime jump = 0, int left_at = 0)
      : path_(path), log_(path, mode), world_("world", 1), echo_("echo", 1) {
    const auto first = [left_at](int k) { return left_at == 0 || k < left_at; };
    const auto second = [left_at](int k) { return left_at > 0 && k >= left_at + 20; };
    for (int k = 1; k <= count; ++k) {
      const Utime t = tick_time(k) + (jump_at > 0 && k >= jump_at ? jump : 0);
      imu_t imu{};
      imu.header = world_.next(channel::kImu, t, t);
      imu.dt_s = k;
      write(channel::kImu, encoded(imu), t);
      if (second(k) && !second(k - 1)) echo_ = StreamCounter("echo", 2);
      if (k > 1 && (first(k - 1) || second(k - 1))) {
        slip_t slip{};
        slip.header = echo_.next(channel::kSlip, t - kTickUs, t);
        slip.slip_ratio = k - 1 + (second(k) ? 1000 : 0);
        write(channel::kSlip, encoded(slip), t);
      }
      tick_t tick{};
      tick.header = world_.next(channel::kTick, t, t);
      tick.mode = tick_t::LOCKSTEP;
      if (first(k) || second(k)) tick.members = {"echo"};
      tick.member_count = static_cast<std::int32_t>(tick.members.size());
      tick.stream_count = 0;
      write(channel::kTick, encoded(tick), t);
    }
  }

 private:
  void write(const char* channel, std::vector<std::uint8_t> bytes, Utime t) {
    lcm::LogEvent event{};
    event.timestamp = t;
    event.channel = channel;
    event.data = bytes.data();
    event.datalen = static_cast<std::int32_t>(bytes.size());
    log_.writeEvent(&event);
  }

  std::string path_;
  lcm::LogFile log_;
  StreamCounter world_;
  StreamCounter echo_;
};

}  // namespace rover::replay
