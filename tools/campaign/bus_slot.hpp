// A bus for one drive, different from those of all other drives of campaigns on this machine.
#pragma once

#include <string>

namespace rover::campaign {

class BusSlot {
 public:
  // Throws ConfigError if all are taken.
  BusSlot();
  ~BusSlot();
  BusSlot(const BusSlot&) = delete;
  BusSlot& operator=(const BusSlot&) = delete;
  std::string url() const;

 private:
  int file_ = -1;
  int slot_ = 0;
};

}  // namespace rover::campaign
