// What the planner's configuration takes from the vehicle's.
#include "path_planner/config.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "test/common/temp_folder.hpp"

namespace rover::planning {
namespace {

TEST(PathPlannerConfig, AVehicleThatTurnsInWiderArcsIsPlannedForInWiderArcs) {
  const std::string shipped = ROVER_SOURCE_DIR "/config";
  const rover::testing_support::TempFolder folder;
  for (const char* name : {"path_planner.yaml", "navigation.yaml", "cameras.yaml"})
    std::filesystem::copy_file(shipped + "/" + name, folder.path() / name);
  std::stringstream vehicle;
  vehicle << std::ifstream(shipped + "/vehicle.yaml").rdbuf();
  std::string text = vehicle.str();
  const std::string key = "min_turn_radius_m: 1.0";
  ASSERT_NE(text.find(key), std::string::npos);
  std::ofstream(folder.file("vehicle.yaml")) << text.replace(text.find(key), key.size(), "min_turn_radius_m: 2.0");
  const double factor = load_config(folder.path().string()).planner.motion.max_curvature_per_m /
                        load_config(shipped).planner.motion.max_curvature_per_m;
  EXPECT_NEAR(factor, 0.5, 1e-9);
}

}  // namespace
}  // namespace rover::planning
