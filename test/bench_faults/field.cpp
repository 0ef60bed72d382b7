#include "test/bench_faults/field.hpp"

#include <cmath>

namespace rover::bench_faults {
namespace {

constexpr double kTileM = 10.0;
constexpr double kAbundance = 0.03;  // Golombek's k: a hazard every 30 m
constexpr double kLeastDiameterM = 0.2;
constexpr double kLaidRadiusM = 0.2;
constexpr double kLaidHeightM = 0.3;
constexpr double kRingM = 1.55;
constexpr double kLaidApartM = 0.45;

}  // namespace

void Field::lay_rocks(const Pose2& pose, double ahead_m) {
  const double c = std::cos(pose.yaw_rad), s = std::sin(pose.yaw_rad);
  ahead_m += kLaidRadiusM;
  for (const double left_m : {-kLaidApartM, 0.0, kLaidApartM})
    laid_.push_back(
        {{pose.x_m + ahead_m * c - left_m * s, pose.y_m + ahead_m * s + left_m * c}, kLaidRadiusM, kLaidHeightM});
}

void Field::enclose(const Pose2& pose) {
  for (double angle = 0.0; angle < 2.0 * kPi; angle += 0.2)
    laid_.push_back(
        {{pose.x_m + kRingM * std::cos(angle), pose.y_m + kRingM * std::sin(angle)}, kLaidRadiusM, kLaidHeightM});
}

const std::vector<Rock>& Field::tile(int ix, int iy) {
  const auto known = tiles_.find({ix, iy});
  if (known != tiles_.end()) return known->second;
  std::mt19937_64 random(seed_ + 0x9E3779B97F4A7C15ull * static_cast<std::uint32_t>(ix) +
                         0xC2B2AE3D27D4EB4Full * static_cast<std::uint32_t>(iy));
  const planning::Point2 low{kTileM * ix, kTileM * iy};
  const planning::Point2 high{low.x_m + kTileM, low.y_m + kTileM};
  return tiles_[{ix, iy}] = planning::testing_support::rock_field(kAbundance, low, high, kLeastDiameterM, random);
}

std::vector<Rock> Field::around(const Pose2& pose, double reach_m) {
  std::vector<Rock> near;
  const auto take = [&](Rock rock) {
    rock.p = planning::to_body(pose, rock.p);
    if (std::hypot(rock.p.x_m, rock.p.y_m) < reach_m) near.push_back(rock);
  };
  const auto index = [](double m) { return static_cast<int>(std::floor(m / kTileM)); };
  for (int ix = index(pose.x_m - reach_m); ix <= index(pose.x_m + reach_m); ++ix)
    for (int iy = index(pose.y_m - reach_m); iy <= index(pose.y_m + reach_m); ++iy)
      for (const Rock& rock : tile(ix, iy)) take(rock);
  for (const Rock& rock : laid_) take(rock);
  return near;
}

}  // namespace rover::bench_faults
