#include "common/bus/tap.hpp"

#include <algorithm>
#include <limits>

#include "common/bus/faults.hpp"
#include "common/bus/field_faults.hpp"
#include "common/bus/streams.hpp"

namespace rover {
namespace {

constexpr Utime kReorderDelay = 3 * kTickUs;
constexpr Utime kLongestDelayUs = 60'000'000;  // as in faults.cpp: so old a message may still come

// FNV-1a: the standard library's hash may differ from one to the next.
std::uint64_t hash_of(const std::string& text) {
  std::uint64_t hash = 14695981039346656037u;
  for (const char c : text) hash = (hash ^ static_cast<std::uint8_t>(c)) * 1099511628211u;
  return hash;
}

// The content of `old` under the header of `fresh`: what a frozen sensor sends. Headers may differ in length.
Tap::Bytes with_header_of(const Tap::Bytes& fresh, const Tap::Bytes& old) {
  header_t fresh_header{};
  header_t old_header{};
  if (!peek_header(fresh.data(), static_cast<int>(fresh.size()), fresh_header)) return fresh;
  if (!peek_header(old.data(), static_cast<int>(old.size()), old_header)) return fresh;
  const auto fresh_end = kFingerprintBytes + fresh_header._getEncodedSizeNoHash();
  const auto old_end = kFingerprintBytes + old_header._getEncodedSizeNoHash();
  Tap::Bytes mixed(fresh.begin(), fresh.begin() + fresh_end);
  mixed.insert(mixed.end(), old.begin() + old_end, old.end());
  return mixed;
}

}  // namespace

Tap::Tap(const std::string& node_name) : random_(hash_of(node_name)) {}

bool Tap::inject(const injection_t& injection) {
  const FaultKind* kind = find_fault(injection.fault);
  if (kind == nullptr || !amount_problem(*kind, injection.amount).empty()) return false;
  const bool known = std::any_of(active_.begin(), active_.end(), [&](const Active& active) {
    return active.injection.injection_id == injection.injection_id &&
           active.injection.header.publisher == injection.header.publisher;
  });
  Active active{injection, split_field(injection.target).channel, "", {}};
  switch (kind->on) {
    case FaultTarget::kSlow:
      active.publisher = std::move(active.channel);
      active.channel.clear();
      break;
    case FaultTarget::kChannel:
    case FaultTarget::kField:
    case FaultTarget::kBus:
      break;
    default:
      return false;
  }
  // Those that ended long ago strike nothing more; one that is announced again then is over all the same.
  std::erase_if(
      active_, [&](const Active& old) { return old.injection.until_utime < injection.header.utime - kLongestDelayUs; });
  if (!known || injection.injection_id == 0) active_.push_back(std::move(active));
  return true;
}

bool Tap::chance(double share) {
  return std::uniform_real_distribution<double>(0.0, 1.0)(random_) < share;
}

std::vector<Tap::Passed> Tap::pass(const std::string& channel, const header_t& header, Bytes bytes) {
  if (mutes(channel)) return {};
  Fate fate{std::move(bytes)};
  for (Active& active : active_) {
    const bool meant = active.channel.empty() ? active.publisher == header.publisher
                                              : active.channel == channel || active.channel == "*";
    const bool in_time = header.utime >= active.injection.from_utime && header.utime <= active.injection.until_utime;
    if (meant && in_time && fate.copies > 0) strike(active, fate);
  }
  return std::vector<Passed>(static_cast<size_t>(fate.copies), {fate.bytes, fate.delay});
}

void Tap::strike(Active& active, Fate& fate) {
  const std::string& fault = active.injection.fault;
  const double amount = active.injection.amount;
  if (fault == "delay" || fault == "slow") {
    fate.delay += to_utime(amount);
  } else if (fault == "drop" || fault == "loss") {
    if (chance(amount)) fate.copies = 0;
  } else if (fault == "duplicate") {
    if (chance(amount)) fate.copies = 2;
  } else if (fault == "reorder") {
    if (chance(amount)) fate.delay += kReorderDelay;
  } else {
    strike_content(active, fate);
  }
}

void Tap::strike_content(Active& active, Fate& fate) {
  const injection_t& what = active.injection;
  if (what.fault == "freeze") {
    if (active.frozen.empty()) active.frozen = fate.bytes;
    fate.bytes = with_header_of(fate.bytes, active.frozen);
  } else if (what.fault == "offset") {
    const auto add = [&](double value) { return value + what.amount; };
    fate.bytes = change_fields(split_field(what.target), add, std::move(fate.bytes));
  } else if (what.fault == "nan") {
    const auto spoil = [](double) { return std::numeric_limits<double>::quiet_NaN(); };
    if (chance(what.amount)) fate.bytes = change_fields(split_field(what.target), spoil, std::move(fate.bytes));
  } else if (what.fault == "corrupt" && !fate.bytes.empty() && chance(what.amount)) {
    const size_t at = random_() % fate.bytes.size();
    fate.bytes[at] ^= static_cast<std::uint8_t>(1u << (random_() % 8));
  }
}

}  // namespace rover
