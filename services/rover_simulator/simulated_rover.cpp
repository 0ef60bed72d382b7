#include "rover_simulator/simulated_rover.hpp"

#include <random>

namespace rover {
namespace {

// Each part draws from a stream of its own, so that one more draw in one part changes no other.
enum class Stream : std::uint64_t { kSensors = 1, kCamera = 2, kStart = 3 };

std::uint64_t seed_of(std::uint64_t seed, Stream stream) {
  std::seed_seq sequence{seed, static_cast<std::uint64_t>(stream)};
  std::uint32_t words[2];
  sequence.generate(std::begin(words), std::end(words));
  return (std::uint64_t{words[0]} << 32) | words[1];
}

Pose2 true_start(const SimulatedRoverConfig& config, const Pose2& believed, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  Pose2 start = believed;
  start.x_m += config.start_sigma_m * normal(random);
  start.y_m += config.start_sigma_m * normal(random);
  start.yaw_rad += config.start_sigma_yaw_rad * normal(random);
  return start;
}

}  // namespace

SimulatedRover::SimulatedRover(const SimulatedRoverConfig& config, const Vehicle& vehicle, const StereoRig& loccam,
                               std::unique_ptr<World> world, const Pose2& believed_start, std::uint64_t seed)
    : world_(std::move(world)),
      vehicle_(vehicle, config.vehicle, *world_, true_start(config, believed_start, seed_of(seed, Stream::kStart))),
      sensors_(config.sensors, seed_of(seed, Stream::kSensors)),
      loccam_(loccam, config.loccam, *world_, seed_of(seed, Stream::kCamera)) {
  advance(to_seconds(kTickUs), hold_command());
}

void SimulatedRover::advance(double dt_s, const WheelCommand& command) {
  vehicle_.advance(dt_s, command);
  imu_ = sensors_.sample_imu(vehicle_.truth());
  wheels_ = sensors_.sample_wheels(vehicle_.truth());
}

WheelCommand SimulatedRover::hold_command() const {
  WheelCommand hold;
  hold.steer_angle_rad = vehicle_.truth().steer_angle_rad;
  return hold;
}

}  // namespace rover
