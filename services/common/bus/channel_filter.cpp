#include "common/bus/channel_filter.hpp"

#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "common/bus/channels.hpp"

namespace rover {
namespace {

// LCM's UDP protocol: after the UDP header a magic number, a sequence number, and in a message of one datagram the name
// of the channel with its zero.
constexpr std::uint32_t kMagicAt = 8;
constexpr std::uint32_t kChannelAt = 16;
constexpr std::uint32_t kMessage = 0x4c433032;   // LC02
constexpr std::uint32_t kFragment = 0x4c433033;  // LC03

constexpr sock_filter kTake = BPF_STMT(BPF_RET | BPF_K, UINT32_MAX);
constexpr sock_filter kDrop = BPF_STMT(BPF_RET | BPF_K, 0);

// Small, whatever the configuration.
constexpr std::array<std::string_view, 18> kSmall = {channel::kTick,
                                                     channel::kImu,
                                                     channel::kWheelState,
                                                     channel::kPtuState,
                                                     channel::kVo,
                                                     channel::kPose,
                                                     channel::kSlip,
                                                     channel::kPlannerStatus,
                                                     channel::kControlStatus,
                                                     channel::kMotionCommand,
                                                     channel::kSlamPose,
                                                     channel::kWheelCommand,
                                                     channel::kPtuCommand,
                                                     channel::kDrivePermit,
                                                     channel::kState,
                                                     channel::kCorrection,
                                                     channel::kGroundCommand,
                                                     channel::kCommandAck};

// Loads and comparisons of the name, four bytes at a time; where it differs, the next name follows.
void add_name(const std::string& name, std::vector<sock_filter>& program) {
  const std::string bytes(name.c_str(), name.size() + 1);
  const size_t words = bytes.size() / 4;
  const size_t singles = bytes.size() % 4;
  size_t left = 2 * (words + singles) + 1;
  const auto compare = [&](std::uint16_t size, std::uint32_t at, std::uint32_t value) {
    left -= 2;
    program.push_back(BPF_STMT(static_cast<std::uint16_t>(BPF_LD | size | BPF_ABS), kChannelAt + at));
    program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, 0, static_cast<std::uint8_t>(left)));
  };
  const auto byte = [&](size_t i) { return static_cast<std::uint32_t>(static_cast<std::uint8_t>(bytes[i])); };
  for (size_t i = 0; i < 4 * words; i += 4)
    compare(BPF_W, static_cast<std::uint32_t>(i), byte(i) << 24 | byte(i + 1) << 16 | byte(i + 2) << 8 | byte(i + 3));
  for (size_t i = 4 * words; i < bytes.size(); ++i) compare(BPF_B, static_cast<std::uint32_t>(i), byte(i));
  program.push_back(kTake);
}

bool bound_to(int fd, int port) {
  sockaddr_in address{};
  socklen_t size = sizeof(address);
  int type = 0;
  socklen_t type_size = sizeof(type);
  return getsockopt(fd, SOL_SOCKET, SO_TYPE, &type, &type_size) == 0 && type == SOCK_DGRAM &&
         getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size) == 0 && address.sin_family == AF_INET &&
         ntohs(address.sin_port) == port;
}

}  // namespace

bool fits_a_datagram(const std::string& channel) {
  return std::find(kSmall.begin(), kSmall.end(), channel) != kSmall.end();
}

std::vector<sock_filter> channel_program(const std::vector<std::string>& channels) {
  const bool fragments = !std::all_of(channels.begin(), channels.end(), fits_a_datagram);
  std::vector<sock_filter> program = {BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kMagicAt),
                                      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kFragment, 0, 1), fragments ? kTake : kDrop,
                                      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kMessage, 1, 0), kDrop};
  for (const std::string& channel : channels) add_name(channel, program);
  program.push_back(kDrop);
  return program;
}

bool keep_channels(const std::vector<std::string>& channels, int port) {
  std::vector<sock_filter> program = channel_program(channels);
  const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
  bool attached = false;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", error)) {
    const int fd = std::stoi(entry.path().filename());
    if (!bound_to(fd, port)) continue;
    attached = setsockopt(fd, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof(filter)) == 0;
    if (!attached) return false;
  }
  return attached;
}

}  // namespace rover
