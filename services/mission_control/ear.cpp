#include "mission_control/ear.hpp"

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

Ear::Ear(lcm::LCM& bus, Audience& audience, const std::vector<std::string>& services)
    : bus_(bus), audience_(audience), gatherer_(services) {}

Ear::~Ear() {
  end();
}

// Undecodable messages are ignored here; the services count and report them.
template <class Message, class Take>
Ear::Hearing* Ear::hear(const char* channel, Take take) {
  Hearing& hearing = handlers_.emplace_back();
  hearing.handler = [this, take](const lcm::ReceiveBuffer* buffer) {
    Message message;
    if (!decode_message(buffer->data, static_cast<int>(buffer->data_size), message)) return;
    const std::lock_guard lock(mutex_);
    take(message);
  };
  hearing.subscription = bus_.subscribeFunction(
      channel, +[](const lcm::ReceiveBuffer* buffer, const std::string&, Handler* handler) { (*handler)(buffer); },
      &hearing.handler);
  return &hearing;
}

template <class Message>
Ear::Hearing* Ear::hear(const char* channel) {
  return hear<Message>(channel, [this](const Message& message) {
    if constexpr (requires { gatherer_.take(message, 0.0); })
      gatherer_.take(message, wall_seconds());
    else
      gatherer_.take(message);
  });
}

void Ear::drop(Hearing*& hearing) {
  bus_.unsubscribe(hearing->subscription);
  handlers_.remove_if([&](const Hearing& h) { return &h == hearing; });
  hearing = nullptr;
}

void Ear::begin() {
  hear<tick_t>(channel::kTick);
  hear<heartbeat_t>(channel::kHeartbeat);
  hear<supervisor_state_t>(channel::kState);
  hear<fault_t>(channel::kFault);
  hear<drive_permit_t>(channel::kDrivePermit);
  hear<pose_t>(channel::kPose);
  hear<planner_status_t>(channel::kPlannerStatus);
  hear<control_status_t>(channel::kControlStatus);
  hear<slip_t>(channel::kSlip);
  hear<wheel_state_t>(channel::kWheelState);
  hear<path_t>(channel::kPath);
  hear<hazards_t>(channel::kHazards);
  hear<traversability_t>(channel::kTraversability);
  hear<elevation_t>(channel::kElevation);
  hear<ptu_state_t>(channel::kPtuState);
  hear<slam_pose_t>(channel::kSlamPose);
  hear<correction_t>(channel::kCorrection);
  hear<image_t>(channel::kLocCamRectLeft, [this](const image_t& image) { gatherer_.take_loccam(image); });
  hear<image_t>(channel::kNavCamLeft, [this](const image_t& image) { gatherer_.take_navcam(image); });
  // Only the constant camera parameters are used, so unsubscribe from this large message once they are known.
  if (!with([](const Gatherer& g) { return g.camera().has_value(); }))
    disparity_ = hear<disparity_t>(channel::kDisparity);
}

void Ear::end() {
  for (const Hearing& hearing : handlers_) bus_.unsubscribe(hearing.subscription);
  handlers_.clear();
  disparity_ = truth_ = nullptr;
  with([](Gatherer& gatherer) { gatherer.begin(); });
}

void Ear::attend(double wall_s) {
  if (audience_.pages() > 0) {
    page_seen_s_ = wall_s;
    if (!listening()) begin();
  }
  if (!listening()) return;
  if (wall_s - page_seen_s_ > kLingerS) return end();
  if (disparity_ != nullptr && with([](const Gatherer& g) { return g.camera().has_value(); })) drop(disparity_);
  if (audience_.truth_wanted() && truth_ == nullptr) truth_ = hear<truth_t>(channel::kTruth);
  if (!audience_.truth_wanted() && truth_ != nullptr) drop(truth_);
}

}  // namespace rover::mission
