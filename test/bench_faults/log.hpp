// The bench's record as an LCM log: what a judge needs of the bus, and beside it what was injected when.
#pragma once

#include <lcm/lcm-cpp.hpp>
#include <rover/injection_t.hpp>
#include <string>

#include "common/core/time.hpp"
#include "test/report/message_log.hpp"

namespace rover::bench_faults {

// Of the log alone: injection_t with `target` = the row, `fault` = the cause, header.publisher = the phase. The first
// is written before the tick at which the cause begins, the second when the stack is well again.
inline constexpr char kInjectionBegins[] = "INJECTION_BEGINS";
inline constexpr char kInjectionOver[] = "INJECTION_OVER";
// A service is killed on the supervisor's order; injection_t with `target` = the service.
inline constexpr char kKillOrdered[] = "KILL_ORDERED";

class Log {
 public:
  Log(lcm::LCM& bus, const std::string& path);

  void set_time(Utime now) { now_ = now; }
  void note(const char* channel, injection_t what);

 private:
  void take(const lcm::ReceiveBuffer* buffer, const std::string& channel);

  report::MessageLog log_;
  Utime now_ = 0;
};

}  // namespace rover::bench_faults
