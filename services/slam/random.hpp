// Gaussian random numbers that are identical for every standard library; those of <random> are not.
#pragma once

#include <cmath>
#include <numbers>
#include <random>

namespace rover::slam {

class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}
  // In [0, 1).
  double unit() { return static_cast<double>(bits_() >> 11) * 0x1.0p-53; }
  double gauss() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - unit()));  // Box and Muller
    return radius * std::cos(2.0 * std::numbers::pi * unit());
  }

 private:
  std::mt19937_64 bits_;
};

}  // namespace rover::slam
