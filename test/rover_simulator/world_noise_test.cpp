#include <gtest/gtest.h>

#include <cmath>

#include "rover_simulator/world/noise.hpp"

namespace rover {
namespace {

TEST(GradientNoise, HasMeanZeroAndDeviationOne) {
  double sum = 0.0, squares = 0.0;
  constexpr int kSide = 600;
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) {
      const double v = gradient_noise(5, i * 0.37, j * 0.37);
      sum += v;
      squares += v * v;
    }
  constexpr double kCount = kSide * kSide;
  EXPECT_NEAR(sum / kCount, 0.0, 0.03);
  EXPECT_NEAR(std::sqrt(squares / kCount), 1.0, 0.03);
}

TEST(GradientNoise, IsContinuousAcrossLatticeCells) {
  for (double y : {-3.4, 0.2, 7.9})
    for (int cell = -5; cell < 5; ++cell)
      EXPECT_NEAR(gradient_noise(1, cell - 1e-7, y), gradient_noise(1, cell + 1e-7, y), 1e-5);
}

TEST(GradientNoise, DependsOnSeed) {
  EXPECT_EQ(gradient_noise(1, 2.3, 4.5), gradient_noise(1, 2.3, 4.5));
  EXPECT_NE(gradient_noise(1, 2.3, 4.5), gradient_noise(2, 2.3, 4.5));
}

TEST(HashStream, IsUniform) {
  HashStream stream(hash_cell(3, 4, 5));
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < 100000; ++i) {
    const double u = stream.unit();
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
    squares += u * u;
  }
  EXPECT_NEAR(sum / 1e5, 0.5, 0.005);
  EXPECT_NEAR(squares / 1e5, 1.0 / 3.0, 0.005);
}

}  // namespace
}  // namespace rover
