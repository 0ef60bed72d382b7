// The bus is one LCM URL; what is derived from it.
#pragma once

#include <optional>
#include <string>

namespace rover {

struct BusAddress {
  std::string group;
  int port = 0;
  long receive_buffer = 0;  // [bytes], 0: the system's default
};

// Empty where the URL is not of the form udpm://GROUP:PORT?ttl=N&recv_buf_size=N, the group a multicast address of
// IPv4.
std::optional<BusAddress> parse_udpm(const std::string& url);
// What is wrong with a bus that processes are to share; empty where nothing is. LCM's other providers are none: file://
// would write over a log.
std::string bus_url_problem(const std::string& url);

// Where the reports of lockstep (DONE) go: the port 10000 above the bus's. Each datagram on the bus wakes every process
// that listens there, and the reports, almost half of all messages, concern the giver of ticks alone. Buses that are
// not udpm:// carry the reports themselves. Throws ConfigError where the port has no such neighbour.
std::string reports_url(const std::string& bus_url);

}  // namespace rover
