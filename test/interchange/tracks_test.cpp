#include "tools/interchange/tracks.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "common/core/frames.hpp"

namespace rover::interchange {
namespace {

StampedPose at(Utime utime, double x, double yaw_rad = 0.0) {
  return {utime, make_pose(rotation_from_rpy(0.0, 0.0, yaw_rad), {x, -2.0, 0.5})};
}

TEST(Tum, IsTimePositionAndQuaternionWithTheScalarLast) {
  std::ostringstream out;
  write_tum(out, {at(1'020'000, 0.25, kPi)});
  std::istringstream in(out.str());
  double t, x, y, z, qx, qy, qz, qw;
  ASSERT_TRUE(in >> t >> x >> y >> z >> qx >> qy >> qz >> qw);
  EXPECT_EQ(t, 1.02);
  EXPECT_EQ(x, 0.25);
  EXPECT_EQ(y, -2.0);
  EXPECT_EQ(z, 0.5);
  EXPECT_NEAR(std::abs(qz), 1.0, 1e-8);
  EXPECT_NEAR(qw, 0.0, 1e-8);
}

TEST(GeoJson, HasALineForEachTrack) {
  Tracks tracks;
  for (int i = 0; i <= 100; ++i) tracks.truth.push_back(at(i * 20'000, 0.01 * i));
  tracks.estimate = {at(0, 0.0)};
  tracks.global_paths.push_back({7, 0, {{0.0, 0.0}, {5.0, 1.0}}});
  const auto parsed = nlohmann::json::parse(geojson(tracks, {}, 0.1));
  EXPECT_EQ(parsed["type"], "FeatureCollection");
  ASSERT_EQ(parsed["features"].size(), 3U);
  const auto& truth = parsed["features"][0];
  EXPECT_EQ(truth["properties"]["track"], "truth");
  EXPECT_EQ(truth["properties"]["coordinates"], "map, metres");
  EXPECT_EQ(truth["geometry"]["type"], "LineString");
  EXPECT_LE(truth["geometry"]["coordinates"].size(), 12U);
  EXPECT_EQ(truth["geometry"]["coordinates"].back()[0], 1.0);
  EXPECT_EQ(parsed["features"][1]["geometry"]["coordinates"].size(), 2U) << "a line has two points at least";
  EXPECT_EQ(parsed["features"][2]["properties"]["path_id"], 7);
}

TEST(GeoJson, CoordinatesAreThoseOfThePlanet) {
  Tracks tracks;
  tracks.truth = {at(0, 10.0), at(1, 20.0)};
  const auto parsed = nlohmann::json::parse(geojson(
      tracks, [](const Eigen::Vector2d& p) { return Eigen::Vector2d(137.0 + 1e-5 * p.x(), -4.5); }, 0.1));
  EXPECT_EQ(parsed["features"][0]["geometry"]["coordinates"][1][0], 137.0002);
  EXPECT_EQ(parsed["features"][0]["properties"]["coordinates"], "longitude, latitude");
}

}  // namespace
}  // namespace rover::interchange
