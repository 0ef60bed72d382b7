// The LCM URL of the bus.
#pragma once

#include <optional>
#include <string>

namespace rover {

struct BusAddress {
  std::string group;
  int port = 0;
  long receive_buffer = 0;  // [bytes], 0: the system's default
};

// Empty unless the URL has the form udpm://GROUP:PORT?ttl=N&recv_buf_size=N with an IPv4 multicast group.
std::optional<BusAddress> parse_udpm(const std::string& url);
// Error text; empty if the bus is usable. LCM's other providers are refused: file:// would overwrite a log.
std::string bus_url_problem(const std::string& url);

// Bus of the lockstep reports (DONE): the port 10000 above. They are almost half of all messages, only the clock master
// needs them, and each datagram on the bus wakes every process. Other providers than udpm:// carry the reports
// themselves. Throws ConfigError if that port does not exist.
std::string reports_url(const std::string& bus_url);

}  // namespace rover
