// A service's checkpoint in the run's folder. A restored checkpoint is published as SERVICE_STATE.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "common/bus/node.hpp"

namespace rover {

class CheckpointStore {
 public:
  using Bytes = std::vector<std::uint8_t>;
  // The checkpoint has the service's name. Does nothing without a run folder.
  explicit CheckpointStore(Node& node) : node_(node) {}

  // Passes the previous process's checkpoint, if any, to `take`, which returns whether it could use it. A damaged one
  // has no bytes.
  void restore(const std::function<bool(const Bytes&)>& take);
  // Call at the first tick: publishes the restored checkpoint, so that a replay has no hidden input.
  void publish_restored();
  // One second after the last save.
  bool due() const;
  // False if the disk refuses; the previous checkpoint remains.
  bool save(const Bytes& bytes);

 private:
  Node& node_;
  Bytes restored_;
  Utime next_save_ = 0;
};

}  // namespace rover
