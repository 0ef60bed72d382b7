// What a service keeps over its own restarts: a checkpoint in the run's folder, told as SERVICE_STATE when it is used.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "common/bus/node.hpp"

namespace rover {

class KeptState {
 public:
  using Bytes = std::vector<std::uint8_t>;
  // The checkpoint bears the service's name. Without a run folder nothing is kept.
  explicit KeptState(Node& node) : node_(node) {}

  // Hands what the process before has kept, where there is something, to `take`, which says whether it was of use.
  void restore(const std::function<bool(const Bytes&)>& take);
  // At the first tick: publishes what was restored, so that a replay has no hidden input.
  void tell();
  // Whether a second has passed since the newest one was kept.
  bool due() const;
  // False where the disk does not take it; the one before then stays.
  bool save(const Bytes& bytes);

 private:
  Node& node_;
  Bytes restored_;
  Utime next_save_ = 0;
};

}  // namespace rover
