#include "recorder/log_file.hpp"

#include <algorithm>
#include <filesystem>

#include "common/bus/config.hpp"
#include "common/bus/event_log.hpp"

namespace rover::recorder {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kHeaderBytes = 28;  // record header before channel and data

struct IntactPart {
  std::int64_t events = 0;
  std::int64_t bytes = 0;
  Utime newest = 0;
};

// Statistics up to the last complete record.
IntactPart scan_part(const std::string& path) {
  IntactPart intact;
  EventLogReader reader(path);
  if (!reader.begins_as_log()) throw ConfigError(path + ": is not a log and is not overwritten; move it away");
  for (LogEvent event; reader.next(event);) intact = {intact.events + 1, event.end, event.time};
  return intact;
}

void truncate_to(const std::string& path, std::int64_t bytes) {
  std::error_code error;  // on failure readers skip the incomplete record
  if (fs::is_regular_file(path, error)) fs::resize_file(path, static_cast<std::uintmax_t>(bytes), error);
}

}  // namespace

LogFile::LogFile(const std::string& path, std::int64_t part_bytes) : path_(path), part_bytes_(part_bytes) {
  open_part(static_cast<int>(log_parts(path).size()));
}

LogFile::~LogFile() {
  close();
}

void LogFile::open_part(int number) {
  part_ = number;
  const std::string path = log_part(path_, number);
  IntactPart intact;
  if (fs::is_regular_file(path)) {
    intact = scan_part(path);
    truncate_to(path, intact.bytes);
  }
  log_ = lcm_eventlog_create(path.c_str(), "a");
  if (log_ == nullptr) throw ConfigError(path + ": cannot be written");
  log_->eventcount = intact.events;
  bytes_ = flushed_bytes_ = intact.bytes;
  newest_ = std::max(newest_, intact.newest);
}

bool LogFile::next_part() {
  if (!close()) return false;
  try {
    open_part(part_ + 1);
  } catch (const ConfigError&) {  // disk full
    failed_ = true;
  }
  return !failed_;
}

bool LogFile::write(const Event& event) {
  const auto size = kHeaderBytes + static_cast<std::int64_t>(event.channel.size() + event.bytes.size());
  if (part_bytes_ > 0 && bytes_ > 0 && bytes_ + size > part_bytes_ && !next_part()) return false;
  if (failed_ || log_ == nullptr) return false;
  // Keep time stamps monotonic for the search by time; a late message would break it.
  newest_ = std::max(newest_, event.release);
  lcm_eventlog_event_t record{};
  record.timestamp = newest_;
  record.channellen = static_cast<std::int32_t>(event.channel.size());
  record.datalen = static_cast<std::int32_t>(event.bytes.size());
  record.channel = const_cast<char*>(event.channel.data());
  record.data = const_cast<std::uint8_t*>(event.bytes.data());
  failed_ = lcm_eventlog_write_event(log_, &record) != 0;
  bytes_ += size;
  return !failed_;
}

bool LogFile::flush() {
  if (log_ == nullptr) return false;
  failed_ = failed_ || fflush(log_->f) != 0;
  if (!failed_) flushed_bytes_ = bytes_;
  return !failed_;
}

bool LogFile::close() {
  if (log_ == nullptr) return !failed_;
  flush();
  lcm_eventlog_destroy(log_);
  log_ = nullptr;
  if (failed_) truncate_to(log_part(path_, part_), flushed_bytes_);
  return !failed_;
}

std::uintmax_t free_disk_bytes(const std::string& path) {
  std::error_code error;
  const fs::space_info space = fs::space(path, error);
  return error ? 0 : space.available;
}

}  // namespace rover::recorder
