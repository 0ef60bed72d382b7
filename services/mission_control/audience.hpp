// Counts the open pages and those that show ground truth. Without a page nothing is subscribed or rendered.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace rover::mission {

class Audience {
 public:
  // Returns false when most_pages are already connected.
  bool enter(bool truth, int most) {
    const std::lock_guard lock(mutex_);
    if (pages_ >= most) return false;
    ++pages_;
    if (truth) ++truth_;
    changed_.notify_all();
    return true;
  }
  void leave(bool truth) {
    const std::lock_guard lock(mutex_);
    --pages_;
    if (truth) --truth_;
  }
  int pages() const {
    const std::lock_guard lock(mutex_);
    return pages_;
  }
  bool truth_wanted() const {
    const std::lock_guard lock(mutex_);
    return truth_ > 0;
  }
  // Blocks until a page is open; false after the timeout or after close().
  bool wait_for_page(std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, patience, [this] { return pages_ > 0 || over_; });
    return pages_ > 0 && !over_;
  }
  void end() {
    const std::lock_guard lock(mutex_);
    over_ = true;
    changed_.notify_all();
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  int pages_ = 0;
  int truth_ = 0;
  bool over_ = false;
};

}  // namespace rover::mission
