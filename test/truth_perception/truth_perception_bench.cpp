// Time of the true maps in a rock field, at 0.08 m per exposure, as the rover drives.
#include <benchmark/benchmark.h>

#include "common/core/frames.hpp"
#include "rover_simulator/world/world.hpp"
#include "test/stereo/synthetic_world.hpp"
#include "test/truth_perception/scene.hpp"
#include "tools/truth_perception/true_hazards.hpp"
#include "tools/truth_perception/true_terrain.hpp"
#include "traversability/traversability.hpp"

namespace rover::truth {
namespace {

World rock_field() {
  WorldConfig config;
  config.rocks.k = 0.12;
  return World(config, plane_raster(200.0, 60.0, 1.0, 0.0, 0.0), 1);
}

void hazards(benchmark::State& state) {
  const World world = rock_field();
  TrueHazards hazards({}, synthetic::loccam_camera(), std::make_shared<TrueSurface>(world));
  double x_m = 10.0;
  for (auto _ : state) {
    x_m += 0.08;
    benchmark::DoNotOptimize(
        hazards.step(make_pose(Eigen::Matrix3d::Identity(), {x_m, 30.0, world.ground_height_m(x_m, 30.0) + 0.62})));
  }
}
BENCHMARK(hazards)->Unit(benchmark::kMillisecond)->Iterations(1000);

void traversability(benchmark::State& state) {
  const World world = rock_field();
  TrueTerrain terrain(200, 0.1, std::make_shared<TrueSurface>(world));
  double x_m = 10.0;
  for (auto _ : state) {
    x_m += 0.5;
    terrain.add(navcam_at(x_m, 30.0, world.ground_height_m(x_m, 30.0)));
    const trav::GridShape shape{200, 200, 0.1, std::floor(x_m) - 10.0, 20.0};
    const Pose2 body{x_m, 30.0, 0.0};
    benchmark::DoNotOptimize(trav::compute_traversability(terrain.grid(shape, body, body), {}));
  }
}
BENCHMARK(traversability)->Unit(benchmark::kMillisecond)->Iterations(300);

}  // namespace
}  // namespace rover::truth

BENCHMARK_MAIN();
