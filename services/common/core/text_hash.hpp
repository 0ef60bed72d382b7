// A hash that is the same on each machine, as std::hash need not be: FNV-1a.
#pragma once

#include <cstdint>
#include <string_view>

namespace rover {

inline std::uint64_t text_hash(std::string_view text) {
  std::uint64_t hash = 14695981039346656037u;
  for (const char c : text) hash = (hash ^ static_cast<std::uint8_t>(c)) * 1099511628211u;
  return hash;
}

}  // namespace rover
