// Messages as their publishers send them.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/core/time.hpp"

namespace rover::spy {

template <class Message>
std::vector<std::uint8_t> encoded(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

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
