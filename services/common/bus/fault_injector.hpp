// Fault injection on the receiving side of a node. Exists only if injection is allowed or a replay mutes channels.
//
// Messages are processed in release order, so the faults do not depend on the order of arrival.
#pragma once

#include <cstdint>
#include <map>
#include <random>
#include <rover/header_t.hpp>
#include <rover/injection_t.hpp>
#include <set>
#include <string>
#include <vector>

#include "common/core/time.hpp"

namespace rover {

class FaultInjector {
 public:
  using Bytes = std::vector<std::uint8_t>;
  // A message to deliver, and its extra delay.
  struct Output {
    Bytes bytes;
    Utime delay = 0;
  };

  // The node's name seeds the random generator: each node loses different messages.
  explicit FaultInjector(const std::string& node_name);

  void mute(const std::string& channel) { muted_.insert(channel); }
  bool mutes(const std::string& channel) const { return muted_.contains(channel); }
  // Activates a fault of channels, fields or the bus (faults.hpp); false for other faults. Repetitions of an id are
  // ignored.
  bool inject(const injection_t& injection);
  // Applies the active faults to a message.
  std::vector<Output> apply(const std::string& channel, const header_t& header, Bytes bytes);

 private:
  struct Active {
    injection_t injection{};
    std::string channel;  // "*": all; empty: of the publisher
    std::string publisher;
    Bytes frozen;
  };
  struct Outcome {
    Bytes bytes;
    Utime delay = 0;
    int copies = 1;  // 0: lost
  };
  void apply_one(Active& active, Outcome& outcome);
  void change_content(Active& active, Outcome& outcome);
  bool chance(double probability);

  std::mt19937_64 random_;
  std::set<std::string> muted_;
  std::vector<Active> active_;
};

}  // namespace rover
