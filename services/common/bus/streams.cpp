#include "common/bus/streams.hpp"

namespace rover {
namespace {

// Differences of values in range do not overflow, and doubles represent them exactly.
bool in_range(std::int64_t value) {
  constexpr std::int64_t kMax = std::int64_t{1} << 53;
  return value >= -kMax && value <= kMax;
}

// Waiting messages of a stream beyond a hole. In real time nobody gives up on a lost one.
constexpr size_t kMaxAhead = 1024;

}  // namespace

StreamCounter::StreamCounter(std::string publisher, std::int64_t boot_id)
    : publisher_(std::move(publisher)), boot_id_(boot_id) {}

header_t StreamCounter::next(const std::string& channel, Utime utime, Utime release) {
  header_t header{};
  header.utime = utime;
  header.release_utime = release;
  header.seq = ++last_seq_[channel];
  header.publisher = publisher_;
  header.boot_id = boot_id_;
  updated_.insert(channel);
  return header;
}

std::vector<stream_seq_t> StreamCounter::take_updated() {
  std::vector<stream_seq_t> streams;
  for (const std::string& channel : updated_) {
    stream_seq_t stream{};
    stream.channel = channel;
    stream.publisher = publisher_;
    stream.boot_id = boot_id_;
    stream.seq = last_seq_[channel];
    streams.push_back(stream);
  }
  updated_.clear();
  return streams;
}

bool ArrivalLedger::arrived(const std::string& channel, const header_t& header) {
  const auto [it, first] = arrivals_.try_emplace(Key{channel, header.publisher, header.boot_id});
  Arrival& arrival = it->second;
  if (first) {
    arrival.first = arrival.contiguous = header.seq;
    return true;
  }
  if (header.seq < arrival.first) {  // overtaken by the first received message
    arrival.first = header.seq;
    return true;
  }
  if (header.seq <= arrival.contiguous || !arrival.ahead.insert(header.seq).second) return false;
  if (arrival.ahead.size() > kMaxAhead) arrival.contiguous = *arrival.ahead.begin() - 1;
  while (arrival.ahead.erase(arrival.contiguous + 1) > 0) ++arrival.contiguous;
  return true;
}

bool ArrivalLedger::known(const stream_seq_t& stream) const {
  return arrivals_.contains(Key{stream.channel, stream.publisher, stream.boot_id});
}

bool ArrivalLedger::complete(const stream_seq_t& stream) const {
  const auto it = arrivals_.find(Key{stream.channel, stream.publisher, stream.boot_id});
  return it != arrivals_.end() && it->second.contiguous >= stream.seq;
}

void ArrivalLedger::give_up(const stream_seq_t& stream) {
  const auto it = arrivals_.find(Key{stream.channel, stream.publisher, stream.boot_id});
  if (it == arrivals_.end()) return;
  Arrival& arrival = it->second;
  arrival.contiguous = std::max(arrival.contiguous, stream.seq);
  while (!arrival.ahead.empty() && *arrival.ahead.begin() <= arrival.contiguous)
    arrival.ahead.erase(arrival.ahead.begin());
  while (arrival.ahead.erase(arrival.contiguous + 1) > 0) ++arrival.contiguous;
}

bool peek_header(const void* data, int size, header_t& header) {
  if (size <= kFingerprintBytes) return false;
  try {
    return header._decodeNoHash(data, kFingerprintBytes, size - kFingerprintBytes) > 0 && in_range(header.utime) &&
           in_range(header.release_utime) && in_range(header.seq) && in_range(header.boot_id);
  } catch (const std::exception&) {  // lcm-gen's decoders trust the lengths they read
    return false;
  }
}

std::int64_t peek_fingerprint(const void* data, int size) {
  std::int64_t fingerprint = 0;
  return __int64_t_decode_array(data, 0, size, &fingerprint, 1) > 0 ? fingerprint : 0;
}

}  // namespace rover
