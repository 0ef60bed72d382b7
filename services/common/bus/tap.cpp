#include "common/bus/tap.hpp"

#include <algorithm>
#include <array>

#include "common/bus/streams.hpp"

namespace rover {
namespace {

constexpr std::array kChannelFaults = {"drop", "delay", "duplicate", "reorder", "corrupt", "freeze"};
constexpr Utime kReorderDelay = 3 * kTickUs;

// The content of `old` under the header of `fresh`: what a frozen sensor sends. Headers may differ in length.
Tap::Bytes with_header_of(const Tap::Bytes& fresh, const Tap::Bytes& old) {
  header_t fresh_header{};
  header_t old_header{};
  if (!peek_header(fresh.data(), static_cast<int>(fresh.size()), fresh_header)) return fresh;
  if (!peek_header(old.data(), static_cast<int>(old.size()), old_header)) return fresh;
  const auto fresh_end = 8 + fresh_header._getEncodedSizeNoHash();
  const auto old_end = 8 + old_header._getEncodedSizeNoHash();
  Tap::Bytes mixed(fresh.begin(), fresh.begin() + fresh_end);
  mixed.insert(mixed.end(), old.begin() + old_end, old.end());
  return mixed;
}

}  // namespace

bool Tap::inject(const injection_t& injection) {
  if (std::find(kChannelFaults.begin(), kChannelFaults.end(), injection.fault) == kChannelFaults.end()) return false;
  active_.emplace(injection.target, Active{injection, {}});
  return true;
}

bool Tap::chance(double share) {
  return std::uniform_real_distribution<double>(0.0, 1.0)(random_) < share;
}

std::vector<Tap::Passed> Tap::pass(const std::string& channel, Utime utime, const void* data, int size) {
  if (muted_.contains(channel)) return {};
  const auto* begin = static_cast<const std::uint8_t*>(data);
  Passed message{Bytes(begin, begin + size), 0};
  int copies = 1;
  const auto [first, last] = active_.equal_range(channel);
  for (auto it = first; it != last; ++it) {
    Active& active = it->second;
    const injection_t& what = active.injection;
    if (utime < what.from_utime || utime > what.until_utime) continue;
    if (what.fault == "drop" && chance(what.amount)) return {};
    if (what.fault == "delay") message.delay += to_utime(what.amount);
    if (what.fault == "duplicate") copies = 2;
    if (what.fault == "reorder" && chance(what.amount)) message.delay += kReorderDelay;
    if (what.fault == "corrupt" && chance(what.amount) && !message.bytes.empty())
      message.bytes[random_() % message.bytes.size()] ^= static_cast<std::uint8_t>(1u << (random_() % 8));
    if (what.fault == "freeze") {
      if (active.frozen.empty()) active.frozen = message.bytes;
      message.bytes = with_header_of(message.bytes, active.frozen);
    }
  }
  return std::vector<Passed>(static_cast<size_t>(copies), message);
}

}  // namespace rover
