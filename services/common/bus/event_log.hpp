// Reads LCM event logs: whole, cut, damaged, and those that the recorder has split into parts.
#pragma once

#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/core/time.hpp"

namespace rover {

struct LogEvent {
  std::string channel;
  const std::uint8_t* data = nullptr;  // until the next event is read
  int size = 0;
  Utime time = 0;          // of the record; damaged ones are kept within +-2^53
  std::int64_t begin = 0;  // of its record in the file [bytes]
  std::int64_t end = 0;
};

struct LogLength {
  std::int64_t records = 0;     // whole ones
  std::int64_t left_bytes = 0;  // that belong to none of them
  int damages = 0;              // places where such bytes lie
};

// One file, record by record. What is between two whole records, and behind the last one, is passed over.
class EventLogReader {
 public:
  // Throws ConfigError where there is no such file.
  explicit EventLogReader(const std::string& path);
  // False at the end of the file.
  bool next(LogEvent& event);
  // Before the first record is read: whether the file is empty or begins with a record, whole or cut.
  bool begins_as_log() const;
  // Goes on at this byte.
  void seek(std::int64_t offset);
  const LogLength& length() const { return length_; }
  std::int64_t size() const { return size_; }  // of the file [bytes]

 private:
  static constexpr size_t kHeadBytes = 28;
  bool read_record(LogEvent& event);
  void read_head(std::int64_t offset);
  bool record_begins_at(std::int64_t offset) const;
  bool find_next_head();

  std::unique_ptr<FILE, int (*)(FILE*)> file_;
  std::int64_t size_ = 0;
  std::int64_t at_ = 0;  // of the head
  std::vector<std::uint8_t> head_;
  std::vector<std::uint8_t> body_;
  bool in_damage_ = false;
  LogLength length_;
};

// The file, and "NAME-002.lcm", "NAME-003.lcm" ... beside "NAME.lcm" as far as they go.
std::vector<std::string> log_parts(const std::string& path);
std::string log_part(const std::string& path, int number);  // from 1

// The file that is meant by a log or by the folder of a run. Throws ConfigError with one line where there is none.
std::string log_file(const std::string& log_or_run);

// Calls `take` for each whole record of all parts. Throws ConfigError where there is no log.
LogLength for_each_event(const std::string& path, const std::function<void(const LogEvent&)>& take);

}  // namespace rover
