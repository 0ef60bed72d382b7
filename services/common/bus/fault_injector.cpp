#include "common/bus/fault_injector.hpp"

#include <algorithm>
#include <limits>

#include "common/bus/faults.hpp"
#include "common/bus/field_faults.hpp"
#include "common/bus/streams.hpp"
#include "common/core/text_hash.hpp"

namespace rover {
namespace {

constexpr Utime kReorderDelay = 3 * kTickUs;
constexpr Utime kMaxDelayUs = 60'000'000;  // as in faults.cpp: the largest age of a message

// A frozen sensor repeats the content under fresh headers. Headers may differ in length.
FaultInjector::Bytes with_header_of(const FaultInjector::Bytes& fresh, const FaultInjector::Bytes& old) {
  header_t fresh_header{};
  header_t old_header{};
  if (!peek_header(fresh.data(), static_cast<int>(fresh.size()), fresh_header)) return fresh;
  if (!peek_header(old.data(), static_cast<int>(old.size()), old_header)) return fresh;
  const auto fresh_end = kFingerprintBytes + fresh_header._getEncodedSizeNoHash();
  const auto old_end = kFingerprintBytes + old_header._getEncodedSizeNoHash();
  FaultInjector::Bytes mixed(fresh.begin(), fresh.begin() + fresh_end);
  mixed.insert(mixed.end(), old.begin() + old_end, old.end());
  return mixed;
}

}  // namespace

FaultInjector::FaultInjector(const std::string& node_name) : random_(text_hash(node_name)) {}

bool FaultInjector::inject(const injection_t& injection) {
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
  // Faults that ended long ago affect no message any more.
  std::erase_if(active_,
                [&](const Active& old) { return old.injection.until_utime < injection.header.utime - kMaxDelayUs; });
  if (!known || injection.injection_id == 0) active_.push_back(std::move(active));
  return true;
}

bool FaultInjector::chance(double probability) {
  return std::uniform_real_distribution<double>(0.0, 1.0)(random_) < probability;
}

std::vector<FaultInjector::Output> FaultInjector::apply(const std::string& channel, const header_t& header,
                                                        Bytes bytes) {
  if (mutes(channel)) return {};
  Outcome outcome{std::move(bytes)};
  for (Active& active : active_) {
    const bool meant = active.channel.empty() ? active.publisher == header.publisher
                                              : active.channel == channel || active.channel == "*";
    const bool in_time = header.utime >= active.injection.from_utime && header.utime <= active.injection.until_utime;
    if (meant && in_time && outcome.copies > 0) apply_one(active, outcome);
  }
  return std::vector<Output>(static_cast<size_t>(outcome.copies), {outcome.bytes, outcome.delay});
}

void FaultInjector::apply_one(Active& active, Outcome& outcome) {
  const std::string& fault = active.injection.fault;
  const double amount = active.injection.amount;
  if (fault == "delay" || fault == "slow") {
    outcome.delay += to_utime(amount);
  } else if (fault == "drop" || fault == "loss") {
    if (chance(amount)) outcome.copies = 0;
  } else if (fault == "duplicate") {
    if (chance(amount)) outcome.copies = 2;
  } else if (fault == "reorder") {
    if (chance(amount)) outcome.delay += kReorderDelay;
  } else {
    change_content(active, outcome);
  }
}

void FaultInjector::change_content(Active& active, Outcome& outcome) {
  const injection_t& what = active.injection;
  if (what.fault == "freeze") {
    if (active.frozen.empty()) active.frozen = outcome.bytes;
    outcome.bytes = with_header_of(outcome.bytes, active.frozen);
  } else if (what.fault == "offset") {
    const auto add = [&](double value) { return value + what.amount; };
    outcome.bytes = change_fields(split_field(what.target), add, std::move(outcome.bytes));
  } else if (what.fault == "nan") {
    const auto spoil = [](double) { return std::numeric_limits<double>::quiet_NaN(); };
    if (chance(what.amount)) outcome.bytes = change_fields(split_field(what.target), spoil, std::move(outcome.bytes));
  } else if (what.fault == "corrupt" && !outcome.bytes.empty() && chance(what.amount)) {
    const size_t at = random_() % outcome.bytes.size();
    outcome.bytes[at] ^= static_cast<std::uint8_t>(1u << (random_() % 8));
  }
}

}  // namespace rover
