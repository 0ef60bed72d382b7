// The example driver behind a relay that can change its messages and commands. Time is simulated.
#pragma once

#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <optional>
#include <rover/wheel_command_t.hpp>
#include <vector>

#include "common/bus/channels.hpp"
#include "driver/driver.hpp"
#include "tools/conform/checks.hpp"
#include "tools/conform/listener.hpp"
#include "tools/conform/trial_publisher.hpp"

namespace rover::conform {

// A quarter of the LocCam's size: 16 times faster to render.
inline StereoRig small_rig() {
  StereoRig rig;
  rig.width = 128;
  rig.height = 96;
  rig.left = rig.right = {104.0, 104.0, 63.5, 47.5, {-0.05, 0.01, 0.0, 0.0, 0.0}};
  rig.T_left_right = make_pose(Eigen::Matrix3d::Identity(), {0.12, 0.0, 0.0});
  rig.T_body_left = make_pose(camera_rotation(to_rad(33.0)), {0.527, 0.06, 0.06});
  return rig;
}

inline Vehicle small_vehicle() {
  Vehicle vehicle;
  vehicle.origin_height_m = 0.62;
  vehicle.wheel_radius_m = 0.125;
  vehicle.wheel_x_m = {0.75, 0.75, 0.0, 0.0, -0.75, -0.75};
  vehicle.wheel_y_m = {0.41, -0.41, 0.41, -0.41, 0.41, -0.41};
  vehicle.steer_max_rad = 1.5;
  vehicle.steer_rate_radps = 0.2;
  return vehicle;
}

class BrokenDriver {
 public:
  // Maps a message to zero or more messages.
  template <class Message>
  using Hook = std::function<std::vector<Message>(Message)>;

  BrokenDriver()
      : driver_({.boot_id = 7, .exposure = std::launch::deferred}, small_vehicle(), small_rig(), driver_bus_),
        listener_(bus_, [this] { return arrival(now_); }),
        publisher_(bus_, 1) {
    relay<tick_t>(channel::kTick, &tick);
    relay<imu_t>(channel::kImu, &imu);
    relay<wheel_state_t>(channel::kWheelState, &wheels);
    relay<image_t>(channel::kLocCamLeft, &left);
    relay<image_t>(channel::kLocCamRight, &right);
    bus_.subscribeFunction(
        channel::kWheelCommand,
        +[](const lcm::ReceiveBuffer* buffer, const std::string&, BrokenDriver* self) { self->tell(*buffer); }, this);
  }

  // The complete test: stationary, then the trial.
  std::vector<Line> examine(bool move = true) {
    constexpr Utime kRest = 4'000'000;
    const Utime begin = 100 * kTickUs;
    for (now_ = begin; now_ < begin + kRest; now_ += kTickUs) period();
    const Received at_rest = listener_.take();
    std::vector<Line> lines = check_time(at_rest);
    for (Line& line : check_content(at_rest, small_rig())) lines.push_back(line);
    const Trial trial({.move = move}, now_);
    for (trial_ = &trial; !trial.over(now_); now_ += kTickUs) {
      period();
      publisher_.publish(trial, now_);
      drain();
    }
    trial_ = nullptr;
    for (Line& line : check_trial(listener_.take(), trial)) lines.push_back(line);
    return lines;
  }

  Utime now() const { return now_; }
  bool at_rest() const { return trial_ == nullptr; }
  lcm::LCM& bus() { return bus_; }
  // Sends the driver a command that is not part of the trial.
  void tell(wheel_command_t said) {
    said.header.utime = said.header.release_utime = now_;
    said.valid_until_utime = now_ + 10 * kTickUs;
    driver_bus_.publish(channel::kWheelCommand, &said);
  }

  Hook<tick_t> tick;
  Hook<imu_t> imu;
  Hook<wheel_state_t> wheels;
  Hook<image_t> left;
  Hook<image_t> right;
  Hook<wheel_command_t> command;
  std::function<void()> damaged;  // called for bytes that are not a command
  std::function<double(Utime)> arrival = [](Utime t) { return to_seconds(t); };

 private:
  template <class Message>
  void relay(const char* channel, Hook<Message>* hook) {
    struct Context {
      BrokenDriver* self;
      Hook<Message>* hook;
    };
    driver_bus_.subscribeFunction(
        channel,
        +[](const lcm::ReceiveBuffer* buffer, const std::string& name, Context context) {
          Message message;
          if (!decode_message(buffer->data, static_cast<int>(buffer->data_size), message)) return;
          const auto out = *context.hook ? (*context.hook)(message) : std::vector{message};
          for (const Message& one : out) context.self->bus_.publish(name, &one);
        },
        Context{this, hook});
  }

  void tell(const lcm::ReceiveBuffer& buffer) {
    wheel_command_t message;
    if (!decode_message(buffer.data, static_cast<int>(buffer.data_size), message)) {
      if (damaged) damaged();
      driver_bus_.publish(channel::kWheelCommand, buffer.data, buffer.data_size);
      return;
    }
    const auto out = command ? command(message) : std::vector{message};
    for (const wheel_command_t& one : out) driver_bus_.publish(channel::kWheelCommand, &one);
  }

  void period() {
    driver_.tick(now_);
    drain();
  }
  void drain() {
    while (driver_bus_.handleTimeout(0) > 0 || bus_.handleTimeout(0) > 0) {
    }
  }

  lcm::LCM driver_bus_{"memq://"};
  lcm::LCM bus_{"memq://"};
  Utime now_ = 0;
  const Trial* trial_ = nullptr;
  example::Driver driver_;
  Listener listener_;
  TrialPublisher publisher_;
};

}  // namespace rover::conform
