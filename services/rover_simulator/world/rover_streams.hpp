// Random streams of the rover in its world, and where it really stands at the start.
#pragma once

#include <array>
#include <cstdint>
#include <random>

namespace rover {

// Independent, so that an extra draw in one part does not change the others.
enum class RoverStream : std::uint64_t { kSensors = 1, kCamera = 2, kStart = 3, kNavCam = 4, kPanTilt = 5 };

inline std::uint64_t seed_of(std::uint64_t seed, RoverStream stream) {
  std::seed_seq sequence{seed, static_cast<std::uint64_t>(stream)};
  std::uint32_t words[2];
  sequence.generate(std::begin(words), std::end(words));
  return (std::uint64_t{words[0]} << 32) | words[1];
}

// Error of the start pose given to the rover: x, y and yaw, in standard deviations. `seed`: of the run.
inline std::array<double, 3> start_error(std::uint64_t seed) {
  std::mt19937_64 random(seed_of(seed, RoverStream::kStart));
  std::normal_distribution<double> normal(0.0, 1.0);
  std::array<double, 3> error{};
  for (double& part : error) part = normal(random);
  return error;
}

}  // namespace rover
