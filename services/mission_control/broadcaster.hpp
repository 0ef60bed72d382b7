// Makes the page's view five times a second while a page is open: one text, which all pages get.
#pragma once

#include <atomic>
#include <condition_variable>
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
  // One view as server-sent events; that of the true world apart, for those who asked for it.
  struct Frame {
    std::int64_t number = 0;
    std::string view;
    std::string truth;  // empty: nobody asked, or there is none
  };

  Broadcaster(Audience& audience, Ear& ear, Station& station);
  ~Broadcaster();
  Broadcaster(const Broadcaster&) = delete;
  Broadcaster& operator=(const Broadcaster&) = delete;

  // The first frame after that number; null where none comes within a second or all is over.
  std::shared_ptr<const Frame> after(std::int64_t number);
  // Wakes and ends all who wait.
  void stop();
  bool stopped() const { return !running_; }

 private:
  void run();
  Frame make(std::int64_t number);
  BookView book_view();

  Audience& audience_;
  Ear& ear_;
  Station& station_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<const Frame> newest_;
  std::atomic<bool> running_ = true;
  std::thread thread_;
};

}  // namespace rover::mission
