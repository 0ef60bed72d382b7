#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "common/core/frames.hpp"
#include "tools/report/map_layers.hpp"
#include "tools/report/plot.hpp"
#include "tools/report/svg.hpp"

namespace rover::report {
namespace {

std::vector<std::uint8_t> bytes_of(const std::string& text) {
  return {text.begin(), text.end()};
}

// RFC 4648, section 10.
TEST(Svg, Base64OfTheStandardsVectors) {
  EXPECT_EQ(base64(bytes_of("")), "");
  EXPECT_EQ(base64(bytes_of("f")), "Zg==");
  EXPECT_EQ(base64(bytes_of("fo")), "Zm8=");
  EXPECT_EQ(base64(bytes_of("foo")), "Zm9v");
  EXPECT_EQ(base64(bytes_of("foobar")), "Zm9vYmFy");
}

TEST(Svg, NumbersAreShort) {
  EXPECT_EQ(number_text(1.50), "1.5");
  EXPECT_EQ(number_text(2.0), "2");
  EXPECT_EQ(number_text(-0.001), "0");
  EXPECT_EQ(number_text(100.0, 0), "100");
}

TEST(Svg, TextCannotBreakTheDocument) {
  EXPECT_EQ(escaped("a<b & \"c\">"), "a&lt;b &amp; &quot;c&quot;&gt;");
}

TEST(Plot, AxesAreRoundAndCoverTheirRange) {
  for (const auto& [low, high] :
       {std::pair{-0.031, 0.028}, {0.0, 0.2}, {3.0, 977.0}, {-8.5, 8.5}, {1.0, 1.0}, {0.0, 0.0}}) {
    const Axis axis = round_axis(low, high, 4);
    EXPECT_LE(axis.low, low);
    EXPECT_GE(axis.high, high);
    EXPECT_LT(axis.low, axis.high);
    const double digit = axis.step / std::pow(10.0, std::floor(std::log10(axis.step) + 1e-9));
    EXPECT_TRUE(std::abs(digit - 1) < 1e-9 || std::abs(digit - 2) < 1e-9 || std::abs(digit - 5) < 1e-9) << digit;
  }
}

TEST(Plot, ValuesThatDifferByRoundingAloneAreAFlatLine) {
  for (const double base : {0.0, 5.0}) {
    Plot plot{"rounding", "m", {}, {}, base == 0.0};
    plot.series.push_back({"", "#000", 1.0, false, {{0.0, base}, {1.0, base + 1e-15}, {2.0, base - 3e-17}}});
    EXPECT_LT(draw_plot(plot, {}, 2.0, "plot").size(), 20'000u);
  }
}

TEST(Plot, TheEnvelopeKeepsPeaksAndGaps) {
  Points points;
  for (int i = 0; i < 10'000; ++i) points.emplace_back(i * 0.01, 0.0);
  points[5'432].y() = 7.0;
  points[8'000].y() = -3.0;
  points[9'000].y() = kNaN;
  const Points thin = envelope(points, 0.0, 100.0, 200);
  EXPECT_LT(thin.size(), 500u);
  double low = 0.0;
  double high = 0.0;
  int gaps = 0;
  for (const Eigen::Vector2d& p : thin) {
    low = std::fmin(low, p.y());
    high = std::fmax(high, p.y());
    gaps += std::isnan(p.y()) ? 1 : 0;
  }
  EXPECT_EQ(low, -3.0);
  EXPECT_EQ(high, 7.0);
  EXPECT_EQ(gaps, 1);
}

TEST(Map, NorthIsUpAndEastIsRight) {
  const MapView view{{10.0, 20.0, 30.0, 30.0}, 5.0, 7.0, 2.0};
  EXPECT_EQ(view.px(Eigen::Vector2d(10.0, 30.0)), Eigen::Vector2d(5.0, 7.0));
  EXPECT_EQ(view.px(Eigen::Vector2d(30.0, 20.0)), Eigen::Vector2d(45.0, 27.0));
}

TEST(Map, AspectIsReachedByGrowingAboutTheMiddle) {
  const Box wide = with_aspect({0.0, 0.0, 100.0, 10.0}, 0.4, 1.0);
  EXPECT_DOUBLE_EQ(wide.height_m(), 40.0);
  EXPECT_DOUBLE_EQ(wide.y0_m, -15.0);
  const Box tall = with_aspect({0.0, 0.0, 10.0, 100.0}, 0.4, 1.0);
  EXPECT_DOUBLE_EQ(tall.width_m(), 100.0);
}

TEST(Relief, TheSlopeThatFacesTheSunIsTheLighter) {
  // A ridge along the south-west to north-east line: its north-western flank faces the sun.
  const auto ridge = [](double x, double y) { return -std::abs(y - x) * 0.3; };
  const auto brightness = [&](const Box& box) {
    return cv::mean(cv::imdecode(relief_jpeg(ridge, box, 32, 32, {1.0, 0.0, 0.0}), cv::IMREAD_GRAYSCALE))[0];
  };
  const double lit = brightness({0.0, 10.0, 4.0, 14.0});
  const double shaded = brightness({10.0, 0.0, 14.0, 4.0});
  EXPECT_GT(lit, shaded + 20.0);
}

TEST(Relief, ARasterLiesWhereItsLowerLeftCornerIsTheOrigin) {
  // 10 x 20 m at 1 m; all heights fall to the south-east, but for a flat upper half.
  HeightRaster raster{10, 20, 1.0, {}};
  for (int row = 0; row < 20; ++row)
    for (int column = 0; column < 10; ++column)
      raster.z_m.push_back(row < 10 ? 0.5F * static_cast<float>(row - column) : 0.0F);
  const auto brightness = [&](const Box& box) {
    const auto jpeg = relief_jpeg(raster, box, 32, 32, {1.0, 0.3, 0.0});
    return cv::mean(cv::imdecode(jpeg, cv::IMREAD_GRAYSCALE))[0];
  };
  EXPECT_LT(brightness({2.0, 2.0, 7.0, 7.0}), brightness({2.0, 13.0, 7.0, 18.0}) - 20.0);
}

}  // namespace
}  // namespace rover::report
