// Delivery times of messages to a receiver: by release, after the faults of INJECT on the channel. The log contains
// what was sent; this computes what was received.
#pragma once

#include <cstdint>
#include <map>
#include <rover/header_t.hpp>
#include <rover/injection_t.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "common/core/time.hpp"

namespace rover::bench_faults {

struct Delivery {
  std::string channel;
  header_t header{};
  std::vector<std::uint8_t> bytes;
};

class Deliveries {
 public:
  void inject(const injection_t& injection);
  void sent(Delivery delivery);
  // All messages processed at the tick, in order; messages older than the newest of their stream are dropped.
  std::vector<Delivery> take(Utime tick);

 private:
  struct Waiting {
    Utime at;
    Delivery delivery;
  };
  std::vector<injection_t> injections_;
  std::vector<Waiting> waiting_;
  std::map<std::tuple<std::string, std::string>, std::pair<std::int64_t, std::int64_t>> newest_;  // boot and sequence
};

}  // namespace rover::bench_faults
