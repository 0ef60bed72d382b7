// Rendering time of a stereo pair per camera, and build time of a ground tile.
#include <benchmark/benchmark.h>

#include "camera_test_world.hpp"
#include "rover_simulator/camera/stereo_camera_sim.hpp"

namespace rover::test {
namespace {

void render_pairs(benchmark::State& state, const StereoRig& rig) {
  const RockySurface surface;
  CameraSimConfig config;
  config.scene.threads = static_cast<int>(state.range(0));
  StereoCameraSim camera(rig, config, surface, 1);
  const Eigen::Isometry3d T_map_body = body_at(surface, 100.0, 120.0);
  std::int64_t frame = 0;
  const Eigen::Vector3d p_map_left = (T_map_body * rig.T_body_left).translation();
  for (int i = 0; i < 200; ++i) camera.scene().focus(p_map_left.x(), p_map_left.y());  // until all is built ahead
  for (auto _ : state) benchmark::DoNotOptimize(camera.render(T_map_body, frame++));
}

void loccam_pair(benchmark::State& state) {
  render_pairs(state, loccam_rig());
}
void navcam_pair(benchmark::State& state) {
  render_pairs(state, navcam_rig());
}
BENCHMARK(loccam_pair)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(navcam_pair)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

// The first view of a place, without the surface's own cost.
void first_focus(benchmark::State& state) {
  const PlaneSurface surface;
  TileSceneConfig config;
  config.threads = 1;
  for (auto _ : state) {
    TileScene scene(surface, config);
    scene.focus(100.0, 120.0);
    state.counters["tiles"] = static_cast<double>(scene.tile_count());
  }
}
BENCHMARK(first_focus)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace rover::test

BENCHMARK_MAIN();
