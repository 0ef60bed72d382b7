// Messages encoded as their publishers send them.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/bus/streams.hpp"
#include "common/core/time.hpp"

namespace rover::spy {

template <class Message>
Message made(Utime utime, std::int64_t seq, const std::string& publisher) {
  Message message{};
  message.header.utime = message.header.release_utime = utime;
  message.header.seq = seq;
  message.header.publisher = publisher;
  message.header.boot_id = 1;
  return message;
}

}  // namespace rover::spy
