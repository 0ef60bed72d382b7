// What a vehicle does for the stack, each tick: obey WHEEL_COMMAND, publish IMU and WHEEL_STATE, expose and publish
// LOCCAM_LEFT and LOCCAM_RIGHT, and give TICK. The duties are written down in docs/drivers.md.
#pragma once

#include <future>
#include <lcm/lcm-cpp.hpp>
#include <optional>
#include <rover/image_t.hpp>
#include <string>

#include "common/bus/streams.hpp"
#include "driver/plane_camera.hpp"
#include "driver/plane_rover.hpp"
#include "driver/wheel_watchdog.hpp"

namespace example {

struct DriverConfig {
  std::string name = "example_driver";
  std::int64_t boot_id = 1;  // larger at each start of the process
  rover::Pose2 start;
  // How pictures are made: beside the ticks, or (deferred) within them, for tests whose time is not the clock's.
  std::launch exposure = std::launch::async;
};

class Driver {
 public:
  // The bus outlives the driver.
  Driver(const DriverConfig& config, const rover::Vehicle& vehicle, const rover::StereoRig& rig, lcm::LCM& lcm);
  ~Driver();
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  // One period of 20 ms that ends at t; t is a multiple of it.
  void tick(Utime t);

  const PlaneRover& rover() const { return rover_; }

 private:
  struct Exposure {
    Utime utime = 0;
    std::future<StereoPair> pair;
  };
  void on_wheel_command(const lcm::ReceiveBuffer* buffer, const std::string& channel);
  void attend_camera(Utime t);
  void publish_image(const char* channel, const rover::GrayImage& image, float exposure_s, Utime utime, Utime t);
  void give_tick(Utime t);
  template <class Message>
  void publish(const char* channel, Message& message, Utime utime, Utime release) {
    message.header = streams_.next(channel, utime, release);
    lcm_.publish(channel, &message);
  }

  DriverConfig config_;
  lcm::LCM& lcm_;
  lcm::Subscription* commands_;
  rover::StreamCounter streams_;
  PlaneRover rover_;
  PlaneCamera camera_;
  WheelWatchdog watchdog_;
  std::optional<Exposure> exposure_;
  Utime next_exposure_ = 0;
  std::uint64_t frame_ = 0;
  std::int64_t malformed_ = 0;
};

}  // namespace example
