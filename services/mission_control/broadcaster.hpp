// Serialises the page's view once every 200 ms while a page is open; all pages get the same text.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "mission_control/page_clients.hpp"
#include "mission_control/shared_state.hpp"
#include "mission_control/telemetry_subscriber.hpp"

namespace rover::mission {

class Broadcaster {
 public:
  // One view as server-sent events, with and without ground truth.
  struct Frame {
    std::int64_t number = 0;
    std::string view;
    std::string view_and_truth;  // equals view if no page asked for truth or none was received
  };

  // `on_frame` is called in the broadcaster's thread after each new frame.
  Broadcaster(PageClients& clients, TelemetrySubscriber& subscriber, SharedState& shared,
              std::function<void()> on_frame);
  ~Broadcaster();
  Broadcaster(const Broadcaster&) = delete;
  Broadcaster& operator=(const Broadcaster&) = delete;

  // Null before the first frame.
  std::shared_ptr<const Frame> newest();
  // Stops producing frames.
  void stop();

 private:
  void run();
  Frame make(std::int64_t number);
  BookView book_view();

  PageClients& clients_;
  TelemetrySubscriber& subscriber_;
  SharedState& shared_;
  std::function<void()> on_frame_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<const Frame> newest_;
  std::atomic<bool> running_ = true;
  std::thread thread_;
};

}  // namespace rover::mission
