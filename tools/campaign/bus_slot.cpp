#include "tools/campaign/bus_slot.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "common/bus/config.hpp"

namespace rover::campaign {
namespace {

constexpr int kFirstPort = 18'000;
constexpr int kSlots = 512;

}  // namespace

BusSlot::BusSlot() {
  for (slot_ = 1; slot_ <= kSlots; ++slot_) {
    const std::string file = "/tmp/rover-campaign-slot-" + std::to_string(slot_) + ".lock";
    file_ = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file_ < 0) continue;  // another user's
    if (flock(file_, LOCK_EX | LOCK_NB) == 0) return;
    close(file_);
  }
  throw ConfigError("all " + std::to_string(kSlots) + " buses for drives of campaigns are taken");
}

BusSlot::~BusSlot() {
  close(file_);
}

std::string BusSlot::url() const {
  return "udpm://239.255.76.67:" + std::to_string(kFirstPort + slot_) + "?ttl=0&recv_buf_size=4194304";
}

}  // namespace rover::campaign
