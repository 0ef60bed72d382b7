#include "rover_simulator/world/noise.hpp"

#include <array>
#include <cmath>

namespace rover {
namespace {

constexpr int kDirections = 16;

struct Directions {
  std::array<double, kDirections> x, y;
};

Directions make_directions() {
  Directions table{};
  for (int i = 0; i < kDirections; ++i) {
    table.x[i] = std::cos(2.0 * M_PI * i / kDirections);
    table.y[i] = std::sin(2.0 * M_PI * i / kDirections);
  }
  return table;
}
const Directions kTable = make_directions();

// Two multiply-shift rounds: sufficient for a gradient direction, at half the cost of mix64 twice.
std::uint64_t corner_key(std::uint64_t seed, std::int64_t ix, std::int64_t iy) {
  std::uint64_t h = seed ^ (static_cast<std::uint64_t>(ix) * 0x9e3779b97f4a7c15ULL) ^
                    (static_cast<std::uint64_t>(iy) * 0xc2b2ae3d27d4eb4fULL);
  h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93ULL;
  h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93ULL;
  return h >> 60;
}

double fade(double t) {
  return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

// Variance of the raw noise, over the cell and all directions: 4 corners x |r|^2 / 2 = 4 A B with
// A = int (1 - fade)^2 t^2 dt, B = int (1 - fade)^2 dt.
constexpr double kInverseDeviation = 1.0 / 0.215711;

}  // namespace

double gradient_noise(std::uint64_t seed, double x, double y) {
  const double fx = std::floor(x), fy = std::floor(y);
  const auto ix = static_cast<std::int64_t>(fx), iy = static_cast<std::int64_t>(fy);
  const double u = x - fx, v = y - fy;
  const auto corner = [&](int dx, int dy) {
    const std::uint64_t key = corner_key(seed, ix + dx, iy + dy);
    return kTable.x[key] * (u - dx) + kTable.y[key] * (v - dy);
  };
  const double a = fade(u), b = fade(v);
  const double low = corner(0, 0) + a * (corner(1, 0) - corner(0, 0));
  const double high = corner(0, 1) + a * (corner(1, 1) - corner(0, 1));
  return (low + b * (high - low)) * kInverseDeviation;
}

}  // namespace rover
