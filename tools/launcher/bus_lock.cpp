#include "tools/launcher/bus_lock.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <optional>

#include "common/bus/bus_url.hpp"
#include "common/bus/config.hpp"

namespace rover {
namespace {

constexpr int kFirstPort = 18'000;
constexpr int kSlots = 512;

// The socket that holds the name, -1 if another one does. Abstract: it has no file, so it belongs to the network and
// not to a user or a /tmp, and ends with its process.
int hold(const std::string& name) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const size_t length = name.copy(address.sun_path + 1, sizeof address.sun_path - 1);
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + length);
  const int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0 || bind(fd, reinterpret_cast<const sockaddr*>(&address), size) == 0) return fd;
  close(fd);
  return -1;
}

}  // namespace

BusLock::BusLock(const std::string& bus_url) {
  const std::optional<BusAddress> address = parse_udpm(bus_url);
  socket_ = hold("rover-bus-" + (address ? address->group + "-" + std::to_string(address->port) : "local"));
}

BusLock::~BusLock() {
  if (held()) close(socket_);
}

BusSlot::BusSlot() {
  for (slot_ = 1; slot_ <= kSlots; ++slot_) {
    socket_ = hold("rover-slot-" + std::to_string(slot_));
    if (socket_ < 0) continue;
    if (BusLock(url()).held()) return;  // else somebody chose this bus with --bus
    close(socket_);
  }
  throw ConfigError("all " + std::to_string(kSlots) + " buses for drives of campaigns and benches are taken");
}

BusSlot::~BusSlot() {
  close(socket_);
}

std::string BusSlot::url() const {
  return "udpm://239.255.76.67:" + std::to_string(kFirstPort + slot_) + "?ttl=0&recv_buf_size=4194304";
}

}  // namespace rover
