// The receive-side tap: what arrives passes through it where injection or replay asked for it, and only there.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <random>
#include <rover/injection_t.hpp>
#include <set>
#include <string>
#include <vector>

#include "common/core/time.hpp"

namespace rover {

class Tap {
 public:
  using Bytes = std::vector<std::uint8_t>;
  // A message that goes on, and by how much later than it would.
  struct Passed {
    Bytes bytes;
    Utime delay = 0;
  };

  explicit Tap(std::uint64_t seed) : random_(seed) {}

  void mute(const std::string& channel) { muted_.insert(channel); }
  // Faults on channels: drop (amount: share), delay (amount: s), duplicate, reorder (amount: share), corrupt (flips a
  // byte, amount: share), freeze (repeats the content of the first message). False where the fault is not a channel's.
  bool inject(const injection_t& injection);
  // What becomes of a message of the channel, by its measurement time.
  std::vector<Passed> pass(const std::string& channel, Utime utime, const void* data, int size);

 private:
  struct Active {
    injection_t injection{};
    Bytes frozen;
  };
  bool chance(double share);

  std::mt19937_64 random_;
  std::set<std::string> muted_;
  std::multimap<std::string, Active> active_;
};

}  // namespace rover
