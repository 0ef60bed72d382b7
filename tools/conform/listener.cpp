#include "tools/conform/listener.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/bus/channels.hpp"
#include "common/bus/convert.hpp"
#include "common/bus/streams.hpp"

namespace rover::conform {
namespace {

constexpr size_t kMaxImages = 4;  // of each side: enough for one pair

ReceivedImage received_image(const image_t& message, const Stamp& stamp, bool keep) {
  ReceivedImage out{stamp, message.width, message.height, message.encoding == image_t::MONO8, message.size, {}};
  if (keep) out.image = image_from(message);
  return out;
}

bool all_finite(const wheel_state_t& message) {
  const auto finite = [](const auto& values) {
    return std::all_of(std::begin(values), std::end(values), [](double value) { return std::isfinite(value); });
  };
  return finite(message.drive_angle_rad) && finite(message.drive_rate_radps) && finite(message.drive_current_a) &&
         finite(message.steer_angle_rad) && finite(message.steer_current_a) && finite(message.bogie_angle_rad);
}

}  // namespace

Listener::Listener(lcm::LCM& lcm, std::function<double()> clock) : lcm_(lcm), clock_(std::move(clock)) {
  listen<tick_t>(channel::kTick);
  listen<imu_t>(channel::kImu);
  listen<wheel_state_t>(channel::kWheelState);
  listen<image_t>(channel::kLocCamLeft);
  listen<image_t>(channel::kLocCamRight);
  subscriptions_.push_back(lcm_.subscribeFunction(
      channel::kHeartbeat,
      +[](const lcm::ReceiveBuffer*, const std::string&, Listener* self) { self->received_.stack = true; }, this));
}

Listener::~Listener() {
  for (lcm::Subscription* subscription : subscriptions_) lcm_.unsubscribe(subscription);
}

template <class Message>
void Listener::listen(const char* channel) {
  auto* subscription = lcm_.subscribeFunction(
      channel,
      +[](const lcm::ReceiveBuffer* buffer, const std::string& from, Listener* self) {
        Message message;
        if (!decode_message(buffer->data, static_cast<int>(buffer->data_size), message)) {
          ++self->received_.malformed[from];
          return;
        }
        const header_t& h = message.header;
        self->receive(message, {self->clock_(), self->now_, h.utime, h.release_utime, h.seq, h.publisher, h.boot_id},
                      from);
      },
      this);
  subscription->setQueueCapacity(0);
  subscriptions_.push_back(subscription);
}

void Listener::receive(const tick_t& message, const Stamp& stamp, const std::string&) {
  received_.ticks.push_back({stamp, message.mode == tick_t::REALTIME});
  now_ = std::max(now_, message.header.utime);
}

void Listener::receive(const imu_t& message, const Stamp& stamp, const std::string&) {
  received_.imu.push_back({stamp, message.dt_s, Eigen::Vector3d(message.delta_angle_rad),
                           Eigen::Vector3d(message.delta_velocity_mps), message.fog_delta_yaw_rad,
                           message.status == imu_t::OK});
}

void Listener::receive(const wheel_state_t& message, const Stamp& stamp, const std::string&) {
  ReceivedWheels out;
  out.stamp = stamp;
  std::copy_n(message.drive_angle_rad, 6, out.angle_rad.begin());
  std::copy_n(message.drive_rate_radps, 6, out.rate_radps.begin());
  std::copy_n(message.steer_angle_rad, 4, out.steer_rad.begin());
  out.finite = all_finite(message);
  out.fault = message.status == wheel_state_t::FAULT;
  out.command_expired = message.status == wheel_state_t::COMMAND_EXPIRED;
  received_.wheels.push_back(out);
}

void Listener::receive(const image_t& message, const Stamp& stamp, const std::string& channel) {
  auto& side = channel == channel::kLocCamLeft ? received_.left : received_.right;
  side.push_back(received_image(message, stamp, side.size() < kMaxImages));
}

Received Listener::take() {
  return std::exchange(received_, {});
}

}  // namespace rover::conform
