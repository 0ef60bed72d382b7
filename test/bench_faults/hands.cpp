#include "test/bench_faults/hands.hpp"

#include <rover/injection_t.hpp>

#include "common/bus/channels.hpp"

namespace rover::bench_faults {

void Hands::tap(const std::string& fault, const std::string& target, double amount, double for_s) {
  injection_t out{};
  out.injection_id = ++injection_id_;
  out.target = target;
  out.fault = fault;
  out.amount = amount;
  out.from_utime = now;
  out.until_utime = now + to_utime(for_s);
  out.header = streams_.next(channel::kInject, now, now);
  bus_.publish(channel::kInject, &out);
}

}  // namespace rover::bench_faults
