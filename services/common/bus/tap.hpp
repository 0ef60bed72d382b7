// The receive-side tap: what a node takes passes through it where injection or replay asked for it, and only there.
//
// Messages pass in the order in which the node takes them, so the same injections on the same messages give the same
// faults, whatever the order of arrival.
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

class Tap {
 public:
  using Bytes = std::vector<std::uint8_t>;
  // A message that goes on, and by how much later than it would.
  struct Passed {
    Bytes bytes;
    Utime delay = 0;
  };

  // The name of the node is the seed: each loses other messages.
  explicit Tap(const std::string& node_name);

  void mute(const std::string& channel) { muted_.insert(channel); }
  bool mutes(const std::string& channel) const { return muted_.contains(channel); }
  // Takes the faults that the table (faults.hpp) leaves to taps; false for others. One that is announced again under
  // its id is the same.
  bool inject(const injection_t& injection);
  // What becomes of a message, by its channel, publisher and measurement time.
  std::vector<Passed> pass(const std::string& channel, const header_t& header, Bytes bytes);

 private:
  struct Active {
    injection_t injection{};
    std::string channel;  // "*": all; empty: of the publisher
    std::string publisher;
    Bytes frozen;
  };
  struct Fate {
    Bytes bytes;
    Utime delay = 0;
    int copies = 1;  // 0: lost
  };
  void strike(Active& active, Fate& fate);
  void strike_content(Active& active, Fate& fate);
  bool chance(double share);

  std::mt19937_64 random_;
  std::set<std::string> muted_;
  std::vector<Active> active_;
};

}  // namespace rover
