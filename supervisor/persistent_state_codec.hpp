// Serialises the persistent state as the JSON text of a checkpoint.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "supervisor/supervisor.hpp"

namespace rover::supervisor {

std::vector<std::uint8_t> bytes_of(const PersistentState& persistent_state);
// Returns nullopt for malformed text, another version, or an unknown state or level.
std::optional<PersistentState> persistent_state_from(const std::vector<std::uint8_t>& bytes);

}  // namespace rover::supervisor
