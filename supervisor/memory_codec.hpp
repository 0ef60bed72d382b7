// The supervisor's memory as the text of a checkpoint.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "supervisor/supervisor.hpp"

namespace rover::supervisor {

std::vector<std::uint8_t> bytes_of(const Memory& memory);
// Empty where the bytes are not such a text, or name a state or level that there is not.
std::optional<Memory> memory_from(const std::vector<std::uint8_t>& bytes);

}  // namespace rover::supervisor
