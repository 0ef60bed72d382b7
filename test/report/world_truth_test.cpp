#include "tools/report/world_truth.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "../common/temp_folder.hpp"
#include "common/geo/geotiff_writer.hpp"

namespace rover::report {
namespace {

class WorldTruth : public testing::Test {
 protected:
  RunFolder folder_with(const std::string& scenario) const {
    RunFolder folder;
    folder.dir = temp_.path();
    folder.scenario = temp_.file("scenario.yaml");
    std::ofstream(folder.scenario) << scenario;
    folder.info.seed = 5;
    return folder;
  }

 private:
  testing_support::TempFolder temp_;
};

constexpr char kPlane[] =
    "world:\n  plane: {width_m: 60, height_m: 40, slope_deg: 5}\n  rock_area_k: 0.1\n"
    "path: {x_m: [10, 50], y_m: [20, 20]}\n";

TEST_F(WorldTruth, SeedRegeneratesRocks) {
  RunFolder folder = folder_with(kPlane);
  const Box box{5.0, 5.0, 55.0, 35.0};
  const auto first = load_true_world(folder, box);
  const auto again = load_true_world(folder, box);
  ASSERT_TRUE(first && again);
  ASSERT_GT(first->rocks.size(), 100u);
  ASSERT_EQ(first->rocks.size(), again->rocks.size());
  for (size_t i = 0; i < first->rocks.size(); ++i) {
    EXPECT_EQ(first->rocks[i].x_m, again->rocks[i].x_m);
    EXPECT_EQ(first->rocks[i].height_m, again->rocks[i].height_m);
    EXPECT_TRUE(box.contains({first->rocks[i].x_m, first->rocks[i].y_m}));
  }
  folder.info.seed = 6;
  EXPECT_NE(load_true_world(folder, box)->rocks[0].x_m, first->rocks[0].x_m);
  EXPECT_GT(first->height_m(50.0, 20.0), first->height_m(10.0, 20.0) + 2.0);
  const Rock& rock = first->rocks[0];
  EXPECT_GT(first->height_m(rock.x_m, rock.y_m) - first->ground_m(rock.x_m, rock.y_m), 0.5 * rock.height_m);
}

TEST_F(WorldTruth, EmptyWithoutSeedOrValidScenario) {
  RunFolder folder = folder_with(kPlane);
  folder.info.seed.reset();
  EXPECT_FALSE(load_true_world(folder, {0, 0, 10, 10}));
  EXPECT_FALSE(load_true_world(folder_with("world: {}\n"), {0, 0, 10, 10}));
}

TEST_F(WorldTruth, TheOrbitalMapLiesSouthFirst) {
  RunFolder folder = folder_with(kPlane);
  folder.orbital_map = folder.dir + "/orbital_map.tif";
  ElevationRaster raster = plane_raster(8.0, 6.0, 0.5, 0.0, 0.0);
  raster.projection_wkt.clear();
  write_geotiff(folder.orbital_map, raster);
  EXPECT_TRUE(load_orbital_map(folder).empty());  // no projection
  raster.at(0, 0) = 7.0F;
  raster.projection_wkt = R"(LOCAL_CS["map",UNIT["metre",1]])";
  write_geotiff(folder.orbital_map, raster);
  const HeightRaster map = load_orbital_map(folder);
  EXPECT_EQ(map.columns, 16);
  EXPECT_EQ(map.rows, 12);
  EXPECT_EQ(map.resolution_m, 0.5);
  EXPECT_EQ(map.z_m[0], 7.0F);
  folder.orbital_map.clear();
  EXPECT_TRUE(load_orbital_map(folder).empty());
}

}  // namespace
}  // namespace rover::report
