#include "mission_control/telemetry_subscriber.hpp"

#include <chrono>

#include "common/bus/channels.hpp"
#include "common/bus/streams.hpp"

namespace rover::mission {
namespace {

constexpr double kLingerS = 5.0;  // after the last page closed, so that a reload keeps the subscriptions

}  // namespace

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

TelemetrySubscriber::TelemetrySubscriber(lcm::LCM& bus, PageClients& clients, const std::vector<std::string>& services)
    : bus_(bus), clients_(clients), store_(services) {}

TelemetrySubscriber::~TelemetrySubscriber() {
  unsubscribe_all();
}

// Undecodable messages are ignored here; the services count and report them.
template <class Message, class Callback>
TelemetrySubscriber::Subscription* TelemetrySubscriber::subscribe(const char* channel, Callback callback) {
  Subscription& subscription = subscriptions_.emplace_back();
  subscription.handler = [this, callback](const lcm::ReceiveBuffer* buffer) {
    Message message;
    if (!decode_message(buffer->data, static_cast<int>(buffer->data_size), message)) return;
    const std::lock_guard lock(mutex_);
    callback(message);
  };
  subscription.handle = bus_.subscribeFunction(
      channel, +[](const lcm::ReceiveBuffer* buffer, const std::string&, Handler* handler) { (*handler)(buffer); },
      &subscription.handler);
  return &subscription;
}

template <class Message>
TelemetrySubscriber::Subscription* TelemetrySubscriber::subscribe(const char* channel) {
  return subscribe<Message>(channel, [this](const Message& message) {
    if constexpr (requires { store_.add(message, 0.0); })
      store_.add(message, wall_seconds());
    else
      store_.add(message);
  });
}

void TelemetrySubscriber::unsubscribe(Subscription*& subscription) {
  bus_.unsubscribe(subscription->handle);
  subscriptions_.remove_if([&](const Subscription& h) { return &h == subscription; });
  subscription = nullptr;
}

void TelemetrySubscriber::subscribe_all() {
  subscribe<tick_t>(channel::kTick);
  subscribe<heartbeat_t>(channel::kHeartbeat);
  subscribe<supervisor_state_t>(channel::kState);
  subscribe<fault_t>(channel::kFault);
  subscribe<drive_permit_t>(channel::kDrivePermit);
  subscribe<pose_t>(channel::kPose);
  subscribe<planner_status_t>(channel::kPlannerStatus);
  subscribe<control_status_t>(channel::kControlStatus);
  subscribe<slip_t>(channel::kSlip);
  subscribe<wheel_state_t>(channel::kWheelState);
  subscribe<path_t>(channel::kPath);
  subscribe<hazards_t>(channel::kHazards);
  subscribe<traversability_t>(channel::kTraversability);
  subscribe<elevation_t>(channel::kElevation);
  subscribe<ptu_state_t>(channel::kPtuState);
  subscribe<slam_pose_t>(channel::kSlamPose);
  subscribe<correction_t>(channel::kCorrection);
  subscribe<image_t>(channel::kLocCamRectLeft, [this](const image_t& image) { store_.add_loccam(image); });
  subscribe<image_t>(channel::kNavCamLeft, [this](const image_t& image) { store_.add_navcam(image); });
  // Only the constant camera parameters are used, so unsubscribe from this large message once they are known.
  if (!with([](const TelemetryStore& g) { return g.camera().has_value(); }))
    disparity_ = subscribe<disparity_t>(channel::kDisparity);
}

void TelemetrySubscriber::unsubscribe_all() {
  for (const Subscription& subscription : subscriptions_) bus_.unsubscribe(subscription.handle);
  subscriptions_.clear();
  disparity_ = truth_ = nullptr;
  with([](TelemetryStore& store) { store.reset(); });
}

void TelemetrySubscriber::update(double wall_s) {
  if (clients_.pages() > 0) {
    page_seen_s_ = wall_s;
    if (!subscribed()) subscribe_all();
  }
  if (!subscribed()) return;
  if (wall_s - page_seen_s_ > kLingerS) return unsubscribe_all();
  if (disparity_ != nullptr && with([](const TelemetryStore& g) { return g.camera().has_value(); }))
    unsubscribe(disparity_);
  if (clients_.truth_wanted() && truth_ == nullptr) truth_ = subscribe<truth_t>(channel::kTruth);
  if (!clients_.truth_wanted() && truth_ != nullptr) unsubscribe(truth_);
}

}  // namespace rover::mission
