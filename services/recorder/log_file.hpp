// A standard LCM event log on disk that survives a kill (a cut last record is removed) and a full disk.
#pragma once

#include <lcm/eventlog.h>

#include <cstdint>
#include <functional>
#include <string>

#include "recorder/event_buffer.hpp"

namespace rover::recorder {

class LogFile {
 public:
  // Goes on after the last whole record where the file exists. Throws ConfigError where it cannot be written.
  explicit LogFile(const std::string& path);
  ~LogFile();
  LogFile(const LogFile&) = delete;
  LogFile& operator=(const LogFile&) = delete;

  // False where the disk did not take it.
  bool write(const Event& event);
  // To the operating system, so that a killed process loses nothing from before. False where the disk is full.
  bool flush();

 private:
  std::string path_;
  lcm_eventlog_t* log_ = nullptr;
  Utime newest_ = 0;
};

// Space left to this user where the path is, in bytes; 0 where that is not known.
std::uintmax_t free_disk_bytes(const std::string& path);

}  // namespace rover::recorder
