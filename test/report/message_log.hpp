// Writes messages into an LCM log as the recorder does.
#pragma once

#include <lcm/eventlog.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/bus/streams.hpp"
#include "common/core/time.hpp"

namespace rover::report {

class MessageLog {
 public:
  explicit MessageLog(const std::string& path) : log_(lcm_eventlog_create(path.c_str(), "w")) {}
  ~MessageLog() { lcm_eventlog_destroy(log_); }
  MessageLog(const MessageLog&) = delete;
  MessageLog& operator=(const MessageLog&) = delete;

  // Fills the header.
  template <class Message>
  void put(const std::string& channel, Message message, Utime utime, const std::string& publisher, Utime latency = 0,
           std::int64_t boot_id = 1) {
    message.header.utime = utime;
    message.header.release_utime = utime + latency;
    message.header.publisher = publisher;
    message.header.boot_id = boot_id;
    message.header.seq = ++seq_[channel + '/' + publisher + '/' + std::to_string(boot_id)];
    std::vector<std::uint8_t> bytes = encoded(message);
    put_bytes(channel, bytes, utime + latency);
  }

  // Skips the sequence number of a message that is not recorded.
  void leave_out(const std::string& channel, const std::string& publisher) { ++seq_[channel + '/' + publisher + "/1"]; }

  void put_bytes(const std::string& channel, std::vector<std::uint8_t> bytes, Utime time) {
    lcm_eventlog_event_t event{};
    event.timestamp = time;
    event.channellen = static_cast<std::int32_t>(channel.size());
    event.datalen = static_cast<std::int32_t>(bytes.size());
    event.channel = const_cast<char*>(channel.data());
    event.data = bytes.data();
    lcm_eventlog_write_event(log_, &event);
  }

 private:
  lcm_eventlog_t* log_;
  std::map<std::string, std::int64_t> seq_;
};

}  // namespace rover::report
