// Known fractions on maps whose known cells are given by a predicate.
#include "supervisor/terrain_view.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace rover::supervisor {
namespace {

// Map of 20 x 20 m around the body, cells of 0.1 m; the predicate `known` takes body coordinates.
template <class Known>
KnownFractions fractions(const Pose2& body, Known known) {
  std::vector<std::uint8_t> cells(200 * 200, 255);
  const CostmapView map{0.1, body.x_m - 10.0, body.y_m - 10.0, 200, 200, cells};
  for (int row = 0; row < 200; ++row)
    for (int column = 0; column < 200; ++column) {
      const double dx = 0.1 * (column + 0.5) - 10.0, dy = 0.1 * (row + 0.5) - 10.0;
      const double c = std::cos(body.yaw_rad), s = std::sin(body.yaw_rad);
      if (known(c * dx + s * dy, -s * dx + c * dy)) cells[static_cast<size_t>(row * 200 + column)] = 0;
    }
  return known_fractions(map, body);
}

TEST(TerrainView, CountsKnownCellsAheadForAnyHeading) {
  for (const double yaw : {0.0, 0.7, -2.5}) {
    const Pose2 body{3.0, -40.0, yaw};
    const KnownFractions right = fractions(body, [](double, double left) { return left < 0.0; });
    EXPECT_NEAR(right.ahead, 0.5, 0.1);
    EXPECT_EQ(right.around, 0.0) << "of both sides the lesser";
    const KnownFractions near =
        fractions(body, [](double forward, double left) { return std::hypot(forward, left) < 2.8; });
    EXPECT_NEAR(near.around, 0.5, 0.1);
    const KnownFractions strip = fractions(body, [](double, double left) { return std::abs(left) < 0.8; });
    EXPECT_EQ(strip.ahead, 1.0);
    EXPECT_LT(strip.around, 0.5);
    const KnownFractions behind = fractions(body, [](double forward, double) { return forward < 0.5; });
    EXPECT_EQ(behind.ahead, 0.0);
    EXPECT_EQ(behind.around, 0.0);
  }
}

TEST(TerrainView, CellsOutsideTheMapAreUnknown) {
  const std::vector<std::uint8_t> cells(100, 0);
  EXPECT_EQ(known_fractions({0.1, 500.0, 500.0, 10, 10, cells}, {}).ahead, 0.0);
  EXPECT_EQ(known_fractions({0.0, 0.0, 0.0, 10, 10, cells}, {}).ahead, 0.0);
  EXPECT_EQ(known_fractions({0.1, 0.0, 0.0, 10, 10, cells}, {kNaN, 0.0, 0.0}).ahead, 0.0);
  EXPECT_EQ(known_fractions({0.1, kNaN, 0.0, 10, 10, cells}, {}).ahead, 0.0);
  // Fewer cells than the header states.
  EXPECT_EQ(known_fractions({0.1, -10.0, -10.0, 200, 200, std::vector<std::uint8_t>{0, 0}}, {}).ahead, 0.0);
}

}  // namespace
}  // namespace rover::supervisor
