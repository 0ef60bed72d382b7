#include "driver/driver.hpp"

#include <cstdio>
#include <rover/tick_t.hpp>

#include "common/bus/channels.hpp"
#include "common/bus/convert.hpp"

namespace example {
namespace {

using namespace rover;

constexpr Utime kFramePeriod = 400'000;

}  // namespace

Driver::Driver(const DriverConfig& config, const Vehicle& vehicle, const StereoRig& rig, lcm::LCM& lcm)
    : config_(config),
      lcm_(lcm),
      streams_(config.name, config.boot_id),
      rover_(vehicle, config.start),
      camera_(rig, vehicle.origin_height_m) {
  commands_ = lcm_.subscribeFunction(
      channel::kWheelCommand,
      +[](const lcm::ReceiveBuffer* buffer, const std::string& channel, Driver* driver) {
        driver->on_wheel_command(buffer, channel);
      },
      this);
}

Driver::~Driver() {
  lcm_.unsubscribe(commands_);
}

// Anything may come over a bus: what is not a whole message of the type is dropped and counted.
void Driver::on_wheel_command(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
  wheel_command_t command{};
  if (decode_message(buffer->data, static_cast<int>(buffer->data_size), command)) return watchdog_.take(command);
  if (++malformed_ == 1) std::printf("WARN BAD_MESSAGE channel=%s\n", channel.c_str());
}

void Driver::tick(Utime t) {
  while (lcm_.handleTimeout(0) > 0) {
  }
  rover_.step(watchdog_.in_force(t), to_seconds(kTickUs));
  imu_t imu = rover_.imu();
  wheel_state_t wheels = rover_.wheels(watchdog_.expired(t));
  publish(channel::kImu, imu, t, t);
  publish(channel::kWheelState, wheels, t, t);
  attend_camera(t);
  give_tick(t);  // last: who hears it shall hold all that is released until t
}

// A picture takes longer than a tick. It carries the time of its exposure and is released when it is there.
void Driver::attend_camera(Utime t) {
  if (exposure_ && exposure_->pair.wait_for(std::chrono::seconds(0)) != std::future_status::timeout) {
    const StereoPair pair = exposure_->pair.get();
    publish_image(channel::kLocCamLeft, pair.left, pair.exposure_s, exposure_->utime, t);
    publish_image(channel::kLocCamRight, pair.right, pair.exposure_s, exposure_->utime, t);
    exposure_.reset();
  }
  if (exposure_ || t < next_exposure_) return;
  next_exposure_ = t + kFramePeriod;
  exposure_ = Exposure{t, std::async(config_.exposure, [this, pose = rover_.pose(), frame = frame_++] {
                         return camera_.expose(pose, frame);
                       })};
}

void Driver::publish_image(const char* channel, const GrayImage& image, float exposure_s, Utime utime, Utime t) {
  image_t message{};
  image_to(image, message);
  message.exposure_s = exposure_s;
  publish(channel, message, utime, t);
}

// By the clock, for all who listen.
void Driver::give_tick(Utime t) {
  tick_t tick{};
  tick.mode = tick_t::REALTIME;
  publish(channel::kTick, tick, t, t);
}

}  // namespace example
