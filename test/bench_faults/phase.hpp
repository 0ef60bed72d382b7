// Phase of the drive at an injection.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <rover/control_status_t.hpp>
#include <rover/planner_status_t.hpp>
#include <rover/supervisor_state_t.hpp>

namespace rover::bench_faults {

enum class Phase : std::int8_t { kStraight, kPointTurn, kHazardStop, kRepair, kStandstill };

inline constexpr std::array<const char*, 5> kPhaseNames = {"straight", "point turn", "hazard stop", "repair",
                                                           "standstill"};

// From the supervisor's state, and while driving from planner and controller; none: any other.
inline std::optional<Phase> phase_of(std::int8_t state, std::int8_t planner, std::int8_t control) {
  switch (state) {
    case supervisor_state_t::STANDBY:
      return Phase::kStandstill;
    case supervisor_state_t::HAZARD_STOP:
      return Phase::kHazardStop;
    case supervisor_state_t::REPAIRING:
      return Phase::kRepair;
    case supervisor_state_t::DRIVING:
      break;
    default:
      return std::nullopt;
  }
  if (control == control_status_t::POINT_TURN) return Phase::kPointTurn;
  if (control != control_status_t::FOLLOWING) return std::nullopt;
  return planner == planner_status_t::REPAIRING ? Phase::kRepair : Phase::kStraight;
}

}  // namespace rover::bench_faults
