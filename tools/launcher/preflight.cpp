#include "tools/launcher/preflight.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>

#include "common/bus/bus_url.hpp"
#include "common/bus/config.hpp"

namespace rover {
namespace {

bool can_send_multicast(const BusAddress& address) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return false;
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(address.port));
  inet_pton(AF_INET, address.group.c_str(), &to.sin_addr);
  const bool routed = connect(fd, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
  close(fd);
  return routed;
}

bool is_taken(const std::string& address, int port) {
  sockaddr_in name{};
  name.sin_family = AF_INET;
  name.sin_port = htons(static_cast<std::uint16_t>(port));
  if (inet_pton(AF_INET, address.c_str(), &name.sin_addr) != 1) return false;
  const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return false;
  const int yes = 1;  // like the page's server: ignores connections in TIME_WAIT
  setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  const bool taken = bind(fd, reinterpret_cast<const sockaddr*>(&name), sizeof name) != 0 && errno == EADDRINUSE;
  close(fd);
  return taken;
}

}  // namespace

std::vector<std::string> bus_problems(const std::string& bus_url) {
  if (const std::string problem = bus_url_problem(bus_url); !problem.empty()) return {"bus: " + problem};
  std::vector<std::string> problems;
  const std::optional<BusAddress> address = parse_udpm(bus_url);
  long allowed = 0;
  std::ifstream("/proc/sys/net/core/rmem_max") >> allowed;
  if (allowed > 0 && allowed < address->receive_buffer)
    problems.push_back(
        "bus: the kernel allows receive buffers of " + std::to_string(allowed) + " bytes, " +
        std::to_string(address->receive_buffer) +
        " are required. Fix it with: sudo sysctl -w net.core.rmem_max=" + std::to_string(address->receive_buffer));
  if (!can_send_multicast(*address))
    problems.push_back("bus: no route for multicast to " + address->group +
                       ". Fix it with: sudo ip link set lo multicast on && sudo ip route add 224.0.0.0/4 dev lo");
  return problems;
}

void require_programs(const std::vector<std::string>& services, const std::string& bin_dir) {
  for (const std::string& service : services)
    if (!std::filesystem::exists(bin_dir + "/" + service))
      throw ConfigError(service + " is not built; build it with ./rover build");
}

void require_usable_bus(const std::string& bus_url, const BusLock& lock) {
  std::string lines;
  for (const std::string& problem : bus_problems(bus_url)) lines += (lines.empty() ? "" : "\n") + problem;
  if (!lines.empty()) throw ConfigError(lines);
  if (!lock.held())
    throw ConfigError("bus: another rover runs on " + bus_url + ". Stop it, or choose another bus: --bus udpm://...");
}

std::string page_line(const std::string& config_dir) try {
  const Config config = Config::load(config_dir + "/mission_control.yaml");
  bool served = true;
  std::string address = "127.0.0.1";
  int port = 8080;
  config.read("page", served);
  config.read("address", address);
  config.read("port", port, {1, 65535});
  if (!served) return "";
  const std::string at = "http://" + address + ":" + std::to_string(port);
  if (!is_taken(address, port)) return "page: " + at;
  return "page: " + at + " is in use; this run has no page. Choose another port: --set  mission_control.port=" +
         std::to_string(port + 1);
} catch (const ConfigError&) {
  return "";  // the service reports the error and the run ends
}

}  // namespace rover
