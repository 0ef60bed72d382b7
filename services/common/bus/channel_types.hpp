// The type that each channel carries, for those who take messages without knowing them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rover {

struct ChannelType {
  const char* name;  // "pose_t"
  std::int64_t fingerprint;
  // Whether the bytes are one whole message of the type.
  bool (*decodes)(const void* data, int size);
};

// Null where the channel is not one of channels.hpp.
const ChannelType* find_channel_type(const std::string& channel);
// Those that have a type, by name.
std::vector<std::string> typed_channels();
using FindChannelType = decltype(&find_channel_type);

}  // namespace rover
