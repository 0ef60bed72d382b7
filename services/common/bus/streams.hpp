// Sequence numbers on both sides of a stream (channel, publisher, boot).
#pragma once

#include <cstdint>
#include <exception>
#include <map>
#include <rover/header_t.hpp>
#include <rover/stream_seq_t.hpp>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "common/core/time.hpp"

namespace rover {

// The publishing side: fills headers and lists the streams that published since the last call.
class StreamCounter {
 public:
  StreamCounter(std::string publisher, std::int64_t boot_id);
  header_t next(const std::string& channel, Utime utime, Utime release);
  std::vector<stream_seq_t> take_updated();
  const std::string& publisher() const { return publisher_; }
  std::int64_t boot_id() const { return boot_id_; }

 private:
  std::string publisher_;
  std::int64_t boot_id_;
  std::map<std::string, std::int64_t> last_seq_;
  std::set<std::string> updated_;
};

// The receiving side: how far each stream has arrived without a gap, from its first received message.
class ArrivalLedger {
 public:
  using Key = std::tuple<std::string, std::string, std::int64_t>;  // channel, publisher, boot

  // False for a duplicate.
  bool arrived(const std::string& channel, const header_t& header);
  bool known(const stream_seq_t& stream) const;
  // Whether all messages up to stream.seq have arrived.
  bool complete(const stream_seq_t& stream) const;
  // Stops waiting for messages up to stream.seq.
  void give_up(const stream_seq_t& stream);

 private:
  struct Arrival {
    std::int64_t first = 0;
    std::int64_t contiguous = 0;
    std::set<std::int64_t> ahead;
  };
  std::map<Key, Arrival> arrivals_;
};

// In front of every message.
inline constexpr int kFingerprintBytes = 8;

// Reads the header of any message without knowing its type. False if the bytes are too short, or if a time or number
// exceeds 2^53 (285 years in microseconds), which only damaged bytes do.
bool peek_header(const void* data, int size, header_t& header);
template <class Message>
std::vector<std::uint8_t> encoded(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}
// False if the message is truncated, of another type or has trailing bytes.
template <class Message>
bool decode_message(const void* data, int size, Message& message) {
  try {
    return message.decode(data, 0, size) == size;
  } catch (const std::exception&) {  // a length in it is negative, or larger than the memory
    return false;
  }
}
// Fingerprint of a message; 0 if there are too few bytes.
std::int64_t peek_fingerprint(const void* data, int size);

}  // namespace rover
