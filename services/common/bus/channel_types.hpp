// The type that each channel carries, for those who take messages without knowing them.
#pragma once

#include <cstdint>
#include <string>

namespace rover {

struct ChannelType {
  std::int64_t fingerprint;
  // Whether the bytes are one whole message of the type.
  bool (*decodes)(const void* data, int size);
};

// Null where the channel is not one of channels.hpp.
const ChannelType* find_channel_type(const std::string& channel);
using FindChannelType = decltype(&find_channel_type);

}  // namespace rover
