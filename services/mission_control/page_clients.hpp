// Counts the open pages and those that show ground truth. Without a page nothing is subscribed or rendered.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace rover::mission {

class PageClients {
 public:
  // Returns false when max_pages are already connected.
  bool connect(bool truth, int max_pages) {
    const std::lock_guard lock(mutex_);
    if (pages_ >= max_pages) return false;
    ++pages_;
    if (truth) ++truth_;
    changed_.notify_all();
    return true;
  }
  void disconnect(bool truth) {
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
  bool wait_for_page(std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, timeout, [this] { return pages_ > 0 || closed_; });
    return pages_ > 0 && !closed_;
  }
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  int pages_ = 0;
  int truth_ = 0;
  bool closed_ = false;
};

}  // namespace rover::mission
