#include "recorder/log_file.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>

#include "common/bus/config.hpp"

namespace rover::recorder {
namespace {

struct Whole {
  std::int64_t events = 0;
  std::int64_t bytes = 0;
  Utime newest = 0;
};

// The part of a log that holds whole records: lcm-logger's readers stop at a cut one and would hide all that follows.
Whole whole_part(const std::string& path) {
  Whole whole;
  const auto close = [](lcm_eventlog_t* log) { lcm_eventlog_destroy(log); };
  const std::unique_ptr<lcm_eventlog_t, decltype(close)> log(lcm_eventlog_create(path.c_str(), "r"), close);
  if (!log) return whole;
  while (lcm_eventlog_event_t* event = lcm_eventlog_read_next_event(log.get())) {
    ++whole.events;
    whole.bytes = ftello(log->f);
    whole.newest = event->timestamp;
    lcm_eventlog_free_event(event);
  }
  return whole;
}

}  // namespace

LogFile::LogFile(const std::string& path) : path_(path) {
  Whole whole;
  if (std::filesystem::is_regular_file(path)) {
    whole = whole_part(path);
    std::filesystem::resize_file(path, static_cast<std::uintmax_t>(whole.bytes));
  }
  log_ = lcm_eventlog_create(path.c_str(), "a");
  if (log_ == nullptr) throw ConfigError(path + ": cannot be written");
  log_->eventcount = whole.events;
  newest_ = whole.newest;
}

LogFile::~LogFile() {
  lcm_eventlog_destroy(log_);
}

bool LogFile::write(const Event& event) {
  // Time stamps never fall, as the search by time in a log wants; only a late answer would make them.
  newest_ = std::max(newest_, event.release);
  lcm_eventlog_event_t record{};
  record.timestamp = newest_;
  record.channellen = static_cast<std::int32_t>(event.channel.size());
  record.datalen = static_cast<std::int32_t>(event.bytes.size());
  record.channel = const_cast<char*>(event.channel.data());
  record.data = const_cast<std::uint8_t*>(event.bytes.data());
  return lcm_eventlog_write_event(log_, &record) == 0;
}

bool LogFile::flush() {
  return fflush(log_->f) == 0;
}

std::uintmax_t free_disk_bytes(const std::string& path) {
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(path, error);
  return error ? 0 : space.available;
}

}  // namespace rover::recorder
