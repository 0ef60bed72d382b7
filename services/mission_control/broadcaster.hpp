// Makes the page's view five times a second while a page is open: one text, which all pages get.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "mission_control/audience.hpp"
#include "mission_control/ear.hpp"
#include "mission_control/station.hpp"

namespace rover::mission {

class Broadcaster {
 public:
  // One view as server-sent events; that of the true world added, for those who asked for it.
  struct Frame {
    std::int64_t number = 0;
    std::string view;
    std::string view_and_truth;  // the view alone where nobody asked for the truth, or there is none
  };

  // `made`: a frame is there, in the broadcaster's thread.
  Broadcaster(Audience& audience, Ear& ear, Station& station, std::function<void()> made);
  ~Broadcaster();
  Broadcaster(const Broadcaster&) = delete;
  Broadcaster& operator=(const Broadcaster&) = delete;

  // Null where none was made yet.
  std::shared_ptr<const Frame> newest();
  // No more frames.
  void stop();

 private:
  void run();
  Frame make(std::int64_t number);
  BookView book_view();

  Audience& audience_;
  Ear& ear_;
  Station& station_;
  std::function<void()> made_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<const Frame> newest_;
  std::atomic<bool> running_ = true;
  std::thread thread_;
};

}  // namespace rover::mission
