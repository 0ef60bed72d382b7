// Lattice noise from hashes: pure functions of seed and position.
#pragma once

#include <cstdint>

namespace rover {

// SplitMix64 (Steele, Lea and Flood 2014): a bijection whose output passes as random for consecutive inputs.
constexpr std::uint64_t mix64(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}
constexpr std::uint64_t hash_cell(std::uint64_t seed, std::int64_t ix, std::int64_t iy) {
  return mix64(mix64(seed ^ static_cast<std::uint64_t>(ix)) + static_cast<std::uint64_t>(iy));
}
// In [0, 1).
constexpr double unit_of(std::uint64_t bits) {
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

// Pseudo-random sequence seeded by a hash.
class HashStream {
 public:
  explicit HashStream(std::uint64_t state) : state_(state) {}
  std::uint64_t bits() { return mix64(state_++); }
  double unit() { return unit_of(bits()); }
  double range(double low, double high) { return low + (high - low) * unit(); }

 private:
  std::uint64_t state_;
};

// Gradient noise (Perlin 2002, quintic fade) with unit lattice, mean 0 and standard deviation 1; C2 continuous.
double gradient_noise(std::uint64_t seed, double x, double y);

}  // namespace rover
