#include "common/bus/checkpoint_store.hpp"

#include <rover/service_state_t.hpp>

#include "common/bus/checkpoint.hpp"

namespace rover {
namespace {

constexpr Utime kPeriod = 1'000'000;

}  // namespace

void CheckpointStore::restore(const std::function<bool(const Bytes&)>& take) {
  if (node_.options().run_dir.empty()) return;
  if (!checkpoint_exists(node_.options().run_dir, node_.options().name)) return;
  const Bytes bytes = load_checkpoint(node_.options().run_dir, node_.options().name).value_or(Bytes{});
  if (!take(bytes)) return node_.log("WARN", "CHECKPOINT unusable");
  restored_ = bytes;
  node_.log("INFO", "CHECKPOINT restored bytes=" + std::to_string(restored_.size()));
}

void CheckpointStore::publish_restored() {
  if (restored_.empty()) return;
  service_state_t state{};
  state.service = node_.options().name;
  state.size = static_cast<std::int32_t>(restored_.size());
  state.data = restored_;
  node_.publish(channel::kServiceState, state, node_.now());
  restored_.clear();
}

bool CheckpointStore::due() const {
  return !node_.options().run_dir.empty() && node_.now() >= next_save_;
}

bool CheckpointStore::save(const Bytes& bytes) {
  if (node_.options().run_dir.empty()) return true;
  next_save_ = node_.now() + kPeriod;
  if (save_checkpoint(node_.options().run_dir, node_.options().name, bytes)) return true;
  node_.log("WARN", "CHECKPOINT not saved");
  return false;
}

}  // namespace rover
