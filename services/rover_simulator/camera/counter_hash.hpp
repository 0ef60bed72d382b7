// Counter-based random numbers: independent of thread and order.
// Finalisers: MurmurHash3 (32 bit) and its Stafford variant 13 (64 bit, "splitmix64").
#pragma once

#include <cstdint>

namespace rover {

constexpr std::uint32_t hash32(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x85EBCA6BU;
  x ^= x >> 13;
  x *= 0xC2B2AE35U;
  return x ^ (x >> 16);
}

constexpr std::uint64_t hash64(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

constexpr std::uint64_t hash64(std::uint64_t a, std::uint64_t b) {
  return hash64(hash64(a) ^ b);
}

// In [0, 1).
constexpr double unit_random(std::uint64_t hash) {
  return static_cast<double>(hash >> 11) * 0x1.0p-53;
}

// Approximately normal (zero mean, unit variance, bounded at 3.5 sigma): sum of four uniform numbers from 64 bits.
constexpr float near_normal(std::uint32_t a, std::uint32_t b) {
  const auto sum = static_cast<std::int32_t>((a & 0xFFFFU) + (a >> 16) + (b & 0xFFFFU) + (b >> 16));
  constexpr float kSigma = 37837.2F;  // sqrt(4 (65536^2 - 1) / 12)
  return static_cast<float>(sum - 131070) / kSigma;
}

}  // namespace rover
