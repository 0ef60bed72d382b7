// Standard LCM event logs on disk, split into parts of bounded size, that survive a kill and a full disk: a cut last
// record is removed.
#pragma once

#include <lcm/eventlog.h>

#include <cstdint>
#include <string>

#include "recorder/event_buffer.hpp"

namespace rover::recorder {

class LogFile {
 public:
  // Goes on after the last whole record where the file exists. `part_bytes` not 0: a part that would grow beyond it is
  // followed by the next (event_log.hpp). Throws ConfigError where it cannot be written.
  explicit LogFile(const std::string& path, std::int64_t part_bytes = 0);
  ~LogFile();
  LogFile(const LogFile&) = delete;
  LogFile& operator=(const LogFile&) = delete;

  // False where the disk did not take it.
  bool write(const Event& event);
  // To the operating system, so that a killed process loses nothing from before. False where the disk is full.
  bool flush();
  // What the disk did not take is cut off, so that the log ends with a whole record. False where that was so.
  bool close();

 private:
  void open_part(int number);
  bool next_part();

  std::string path_;
  std::int64_t part_bytes_;
  int part_ = 1;
  lcm_eventlog_t* log_ = nullptr;
  std::int64_t bytes_ = 0;          // of this part, written
  std::int64_t flushed_bytes_ = 0;  // and known to have been taken
  bool failed_ = false;
  Utime newest_ = 0;
};

// Space left to this user where the path is, in bytes; 0 where that is not known.
std::uintmax_t free_disk_bytes(const std::string& path);

}  // namespace rover::recorder
