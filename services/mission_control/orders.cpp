#include "mission_control/orders.hpp"

namespace rover {
namespace {

constexpr Utime kRepeatAfter = 1'000'000;

Order after(Order order) {
  return static_cast<Order>(static_cast<int>(order) + 1);
}

}  // namespace

std::optional<Orders::Given> Orders::step(Utime now, bool standby, std::int64_t command_id) {
  if (all_accepted()) return std::nullopt;
  if (given_at_ != kNever && now - given_at_ < kRepeatAfter) return std::nullopt;
  if (next_ == Order::kGo && !standby) return std::nullopt;
  given_at_ = now;
  command_id_ = command_id;
  return Given{next_, command_id_};
}

void Orders::resume_at(int progress) {
  const int done = static_cast<int>(Order::kGo) + 1;
  if (progress >= 0 && progress <= done) next_ = static_cast<Order>(progress);
}

bool Orders::acknowledge(std::int64_t command_id, bool accepted, const std::string& reason) {
  if (all_accepted() || given_at_ == kNever || command_id != command_id_) return false;
  refusal_ = accepted ? "" : reason;
  if (!accepted) return true;
  next_ = after(next_);
  given_at_ = kNever;
  return true;
}

}  // namespace rover
