#include "mission_control/broadcaster.hpp"

#include <chrono>
#include <cmath>

namespace rover::mission {
namespace {

using namespace std::chrono_literals;

constexpr auto kPeriod = 200ms;

std::string as_event(const char* name, const std::string& data) {
  return std::string("event: ") + name + "\ndata: " + data + "\n\n";
}

double length_of(const GlobalPath& path) {
  double length = 0.0;
  for (size_t i = 1; i < path.x_m.size(); ++i)
    length += std::hypot(path.x_m[i] - path.x_m[i - 1], path.y_m[i] - path.y_m[i - 1]);
  return length;
}

}  // namespace

Broadcaster::Broadcaster(PageClients& clients, TelemetrySubscriber& subscriber, SharedState& shared,
                         std::function<void()> on_frame)
    : clients_(clients), subscriber_(subscriber), shared_(shared), on_frame_(std::move(on_frame)), thread_([this] {
        run();
      }) {}

Broadcaster::~Broadcaster() {
  stop();
  thread_.join();
}

void Broadcaster::stop() {
  const std::lock_guard lock(mutex_);
  running_ = false;
  changed_.notify_all();
}

void Broadcaster::run() {
  std::int64_t number = 0;
  while (running_) {
    if (!clients_.wait_for_page(1s)) continue;
    auto frame = std::make_shared<const Frame>(make(++number));
    {
      const std::lock_guard lock(mutex_);
      newest_ = std::move(frame);
    }
    on_frame_();
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kPeriod, [this] { return !running_; });
  }
}

BookView Broadcaster::book_view() {
  BookView out;
  out.pages = clients_.pages();
  shared_.book.with([&](const Logbook& book) {
    out.newest_event = book.newest_event();
    out.path_id = book.path_id();
    out.path_length_m = length_of(book.path());
    if (book.forced() != Level::kAuto) out.forced_level = book.forced() == Level::kFull ? "FULL" : "EFFICIENT";
  });
  return out;
}

Broadcaster::Frame Broadcaster::make(std::int64_t number) {
  Frame frame;
  frame.number = number;
  const auto [view, truth] =
      subscriber_.with([](TelemetryStore& store) { return std::pair(store.view(wall_seconds()), store.truth()); });
  frame.view = as_event("view", to_json(view, book_view()));
  frame.view_and_truth = frame.view;
  if (clients_.truth_wanted() && truth.utime != kNever) frame.view_and_truth += as_event("truth", to_json(truth));
  return frame;
}

std::shared_ptr<const Broadcaster::Frame> Broadcaster::newest() {
  const std::lock_guard lock(mutex_);
  return newest_;
}

}  // namespace rover::mission
