// The bench's LCM log: the messages that the judge needs, and the injections.
#pragma once

#include <lcm/lcm-cpp.hpp>
#include <rover/injection_t.hpp>
#include <string>

#include "common/core/time.hpp"
#include "test/report/message_log.hpp"

namespace rover::bench_faults {

// Only in the log: injection_t with `target` = the row, `fault` = the cause, header.publisher = the phase. The first
// is written before the tick at which the cause begins, the second when the stack has recovered.
inline constexpr char kInjectionBegins[] = "INJECTION_BEGINS";
inline constexpr char kInjectionOver[] = "INJECTION_OVER";
// The supervisor kills a service; injection_t with `target` = the service.
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
