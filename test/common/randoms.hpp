// Random numbers that are the same with every standard library: the distributions of <random> are not.
#pragma once

#include <random>

namespace rover::testing_support {

inline double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1.0p-53;
}

}  // namespace rover::testing_support
