// A page server whose node is the test.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "mission_control/page_server.hpp"
#include "test/common/temp_folder.hpp"
#include "test/mission_control/raw_http.hpp"

namespace rover::mission::test {

// A page served on a port of its own; the thread that replaces the node accepts all and keeps what it was given.
class TestServer {
 public:
  explicit TestServer(std::function<void(PageConfig&, PageContext&)> change = {});
  ~TestServer();

  int port() const { return port_; }
  SharedState& shared() { return shared_; }
  std::vector<Command> taken();
  std::vector<std::string> injected();

 private:
  int port_;
  testing_support::TempFolder folder_;
  lcm::LCM bus_{"memq://"};
  SharedState shared_;
  std::mutex mutex_;
  std::vector<Command> taken_;
  std::vector<std::string> injected_;
  std::unique_ptr<PageServer> server_;
  std::atomic<bool> running_ = true;
  std::thread node_;
};

}  // namespace rover::mission::test
