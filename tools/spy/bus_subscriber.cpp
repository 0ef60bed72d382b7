#include "tools/spy/bus_subscriber.hpp"

#include <poll.h>

#include <cerrno>

#include "common/bus/bus_url.hpp"
#include "common/bus/config.hpp"
#include "common/bus/interrupt.hpp"
#include "common/bus/wall_clock.hpp"

namespace rover::spy {

BusSubscriber::BusSubscriber(const std::string& bus_url, Traffic& traffic)
    : url_(bus_url), bus_(bus_url), reports_(reports_url(bus_url)), traffic_(traffic) {
  if (!bus_.good() || !reports_.good()) throw ConfigError("bus: cannot join " + bus_url);
  subscribe(bus_);
  if (reports_url(bus_url) != bus_url) subscribe(reports_);
}

void BusSubscriber::subscribe(lcm::LCM& lcm) {
  auto* subscription = lcm.subscribeFunction(
      ".*",
      +[](const lcm::ReceiveBuffer* buffer, const std::string& channel, BusSubscriber* self) {
        if (channel != "LCM_SELF_TEST")
          self->traffic_.add_message(channel, buffer->data, static_cast<int>(buffer->data_size), wall_s());
      },
      this);
  // Unlimited queue: messages that LCM drops would be counted as gaps of the bus.
  subscription->setQueueCapacity(0);
}

void BusSubscriber::listen(int timeout_ms) {
  pollfd sockets[] = {{bus_.getFileno(), POLLIN, 0}, {reports_.getFileno(), POLLIN, 0}};
  if (poll(sockets, 2, timeout_ms) < 0 && errno != EINTR) throw ConfigError("bus: " + url_ + " has failed");
  for (lcm::LCM* lcm : {&bus_, &reports_}) {
    int handled = 1;
    while (handled > 0) handled = lcm->handleTimeout(0);
    if (handled < 0 && keep_running()) throw ConfigError("bus: " + url_ + " has failed");
  }
}

}  // namespace rover::spy
