#include "mission_control/ear.hpp"

#include <chrono>
#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <list>

#include "common/bus/channels.hpp"
#include "common/bus/streams.hpp"

namespace rover::mission {
namespace {

using namespace std::chrono_literals;

constexpr double kLingerS = 5.0;  // after the last page has gone: it may only be loaded anew

// Subscriptions of one stay on the bus. What does not decode is left to the services to count and name.
class Listeners {
 public:
  explicit Listeners(lcm::LCM& bus) : bus_(bus) {}

  template <class Message>
  lcm::Subscription* add(const char* channel, std::function<void(const Message&)> handler) {
    handlers_.push_back([handler](const lcm::ReceiveBuffer* buffer) {
      Message message;
      if (decode_message(buffer->data, static_cast<int>(buffer->data_size), message)) handler(message);
    });
    return bus_.subscribeFunction(
        channel,
        +[](const lcm::ReceiveBuffer* buffer, const std::string&, Handler* handle) { (*handle)(buffer); },
        &handlers_.back());
  }

 private:
  using Handler = std::function<void(const lcm::ReceiveBuffer*)>;
  lcm::LCM& bus_;
  std::list<Handler> handlers_;
};

}  // namespace

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Ear::Ear(std::string bus_url, Audience& audience, const std::vector<std::string>& services)
    : bus_url_(std::move(bus_url)), audience_(audience), gatherer_(services), thread_([this] { run(); }) {}

Ear::~Ear() {
  running_ = false;
  audience_.end();
  thread_.join();
}

void Ear::run() {
  while (running_)
    if (audience_.wait_for_page(1s)) listen();
}

void Ear::listen() {
  lcm::LCM bus(bus_url_);
  if (!bus.good()) return std::this_thread::sleep_for(1s);
  Listeners listeners(bus);
  const auto take = [&]<class Message>(const char* channel, Message) {
    return listeners.add<Message>(channel, [this](const Message& message) {
      const std::lock_guard lock(mutex_);
      if constexpr (requires { gatherer_.take(message, 0.0); })
        gatherer_.take(message, wall_seconds());
      else
        gatherer_.take(message);
    });
  };
  take(channel::kTick, tick_t{});
  take(channel::kHeartbeat, heartbeat_t{});
  take(channel::kState, supervisor_state_t{});
  take(channel::kFault, fault_t{});
  take(channel::kDrivePermit, drive_permit_t{});
  take(channel::kPose, pose_t{});
  take(channel::kPlannerStatus, planner_status_t{});
  take(channel::kControlStatus, control_status_t{});
  take(channel::kSlip, slip_t{});
  take(channel::kWheelState, wheel_state_t{});
  take(channel::kPath, path_t{});
  take(channel::kHazards, hazards_t{});
  take(channel::kTraversability, traversability_t{});
  take(channel::kElevation, elevation_t{});
  listeners.add<image_t>(channel::kLocCamRectLeft, [this](const image_t& image) {
    const std::lock_guard lock(mutex_);
    gatherer_.take_loccam(image);
  });
  listeners.add<image_t>(channel::kNavCamLeft, [this](const image_t& image) {
    const std::lock_guard lock(mutex_);
    gatherer_.take_navcam(image);
  });
  // Large, and all that is wanted of it is the camera, which does not change.
  lcm::Subscription* disparity = take(channel::kDisparity, disparity_t{});
  lcm::Subscription* truth = nullptr;
  double page_seen = wall_seconds();
  while (running_ && wall_seconds() - page_seen < kLingerS) {
    if (audience_.pages() > 0) page_seen = wall_seconds();
    if (disparity != nullptr && with([](Gatherer& g) { return g.camera().has_value(); })) {
      bus.unsubscribe(disparity);
      disparity = nullptr;
    }
    if (audience_.truth_wanted() && truth == nullptr)
      truth = take(channel::kTruth, truth_t{});
    if (!audience_.truth_wanted() && truth != nullptr) {
      bus.unsubscribe(truth);
      truth = nullptr;
    }
    if (bus.handleTimeout(100) < 0) return;
  }
}

}  // namespace rover::mission
