#include "mission_control/mission_sequence.hpp"

namespace rover {
namespace {

constexpr Utime kRetryPeriod = 1'000'000;

MissionStep following(MissionStep mission_step) {
  return static_cast<MissionStep>(static_cast<int>(mission_step) + 1);
}

}  // namespace

std::optional<MissionSequence::Issued> MissionSequence::step(Utime now, bool standby, std::int64_t command_id) {
  if (all_accepted()) return std::nullopt;
  if (issued_at_ != kNever && now - issued_at_ < kRetryPeriod) return std::nullopt;
  if (next_ == MissionStep::kGo && !standby) return std::nullopt;
  issued_at_ = now;
  command_id_ = command_id;
  return Issued{next_, command_id_};
}

void MissionSequence::resume_at(int progress) {
  const int done = static_cast<int>(MissionStep::kGo) + 1;
  if (progress >= 0 && progress <= done) next_ = static_cast<MissionStep>(progress);
}

bool MissionSequence::acknowledge(std::int64_t command_id, bool accepted, const std::string& reason) {
  if (all_accepted() || issued_at_ == kNever || command_id != command_id_) return false;
  refusal_ = accepted ? "" : reason;
  if (!accepted) return true;
  next_ = following(next_);
  issued_at_ = kNever;
  return true;
}

}  // namespace rover
