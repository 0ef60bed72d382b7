// Reads LCM event logs, also truncated, damaged, or split into parts by the recorder.
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
  const std::uint8_t* data = nullptr;  // valid until the next event is read
  int size = 0;
  Utime time = 0;          // of the record, clamped to +-2^53
  std::int64_t begin = 0;  // of its record in the file [bytes]
  std::int64_t end = 0;
};

struct LogLength {
  std::int64_t records = 0;        // intact records
  std::int64_t skipped_bytes = 0;  // outside of intact records
  int damaged_places = 0;          // number of skipped ranges
};

// Reads one file record by record and skips bytes that belong to no intact record.
class EventLogReader {
 public:
  // Throws ConfigError if there is no such file.
  explicit EventLogReader(const std::string& path);
  // False at the end of the file.
  bool next(LogEvent& event);
  // Before the first read: whether the file is empty or begins with a record, intact or truncated.
  bool begins_as_log() const;
  // Continues at this byte.
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
  std::int64_t at_ = 0;  // of the record header
  std::vector<std::uint8_t> head_;
  std::vector<std::uint8_t> body_;
  bool in_damage_ = false;
  LogLength length_;
};

// The file and its existing further parts: "NAME.lcm", "NAME-002.lcm", "NAME-003.lcm" ...
std::vector<std::string> log_parts(const std::string& path);
std::string log_part(const std::string& path, int number);  // from 1

// The log file of a log or of the folder of a run. Throws ConfigError with one line if there is none.
std::string log_file(const std::string& log_or_run);

// Calls `take` for each intact record of all parts. Throws ConfigError if there is no log.
LogLength for_each_event(const std::string& path, const std::function<void(const LogEvent&)>& take);

}  // namespace rover
