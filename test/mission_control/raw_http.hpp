// Requests as bytes, so that they can be wrong; and a page server whose node is the test.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "mission_control/page_server.hpp"
#include "test/common/temp_folder.hpp"

namespace rover::mission::test {

// Everything that comes back until the other side closes; empty: nothing did. Where nothing comes within
// `whole_within_ms` the other side is told that there is no more to the request; it does not answer then. Negative:
// never.
std::string talk(int port, const std::string& bytes, int whole_within_ms = -1);
int connect_to(int port);
// Of an answer; 0: it is none.
int status_of(const std::string& answer);
std::string body_of(const std::string& answer);

std::string get(int port, const std::string& path);
// As the page itself sends it.
std::string post(int port, const std::string& path, const std::string& body);

int free_port();

// A page served on a port of its own; the thread that stands in for the node accepts all and keeps what it was given.
class TestServer {
 public:
  explicit TestServer(std::function<void(PageConfig&, PageContext&)> change = {});
  ~TestServer();

  int port() const { return port_; }
  Station& station() { return station_; }
  std::vector<Command> taken();
  std::vector<std::string> injected();

 private:
  int port_;
  testing_support::TempFolder folder_;
  lcm::LCM bus_{"memq://"};
  Station station_;
  std::mutex mutex_;
  std::vector<Command> taken_;
  std::vector<std::string> injected_;
  std::unique_ptr<PageServer> server_;
  std::atomic<bool> running_ = true;
  std::thread node_;
};

}  // namespace rover::mission::test
