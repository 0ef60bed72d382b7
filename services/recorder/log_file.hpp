// Standard LCM event log, split into parts of bounded size. An incomplete last record, left by a kill or a full disk,
// is removed.
#pragma once

#include <lcm/eventlog.h>

#include <cstdint>
#include <string>

#include "recorder/event_buffer.hpp"

namespace rover::recorder {

class LogFile {
 public:
  // Appends after the last complete record of an existing file. `part_bytes`: maximum size of a part (event_log.hpp),
  // 0: unlimited. Throws ConfigError if the file cannot be written.
  explicit LogFile(const std::string& path, std::int64_t part_bytes = 0);
  ~LogFile();
  LogFile(const LogFile&) = delete;
  LogFile& operator=(const LogFile&) = delete;

  // Returns false if the write failed.
  bool write(const Event& event);
  // Hands the data to the operating system, so that a kill loses nothing earlier. False if the disk is full.
  bool flush();
  // Truncates to the last complete record after a failed write, and then returns false.
  bool close();

 private:
  void open_part(int number);
  bool next_part();

  std::string path_;
  std::int64_t part_bytes_;
  int part_ = 1;
  lcm_eventlog_t* log_ = nullptr;
  std::int64_t bytes_ = 0;          // written to this part
  std::int64_t flushed_bytes_ = 0;  // successfully flushed
  bool failed_ = false;
  Utime newest_ = 0;
};

// Free disk space for this user at the path [bytes]; 0 if unknown.
std::uintmax_t free_disk_bytes(const std::string& path);

}  // namespace rover::recorder
