// The message type of each channel.
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

// Null for channels that are not in channels.hpp.
const ChannelType* find_channel_type(const std::string& channel);
// All channels with a type, sorted by name.
std::vector<std::string> typed_channels();
using FindChannelType = decltype(&find_channel_type);

}  // namespace rover
