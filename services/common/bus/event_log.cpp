// A record: the word 0xEDA1DA01, number and time stamp in 8 bytes each, lengths of channel and message in 4 each,
// channel, message; all big-endian.
#include "common/bus/event_log.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "common/bus/channel_types.hpp"
#include "common/bus/config.hpp"

namespace rover {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::uint8_t, 4> kSync = {0xED, 0xA1, 0xDA, 0x01};
constexpr int kMaxChannelLength = 999;              // limit of LCM's reader
constexpr std::int64_t kMaxMessageBytes = 1 << 28;  // limit of LCM's publisher
constexpr Utime kLatest = Utime{1} << 53;

std::int64_t big_endian(const std::uint8_t* bytes, int count) {
  std::uint64_t value = 0;
  for (int i = 0; i < count; ++i) value = (value << 8U) | bytes[i];
  return count == 4 ? static_cast<std::int32_t>(value) : static_cast<std::int64_t>(value);
}

bool begins_with_sync(const std::vector<std::uint8_t>& bytes) {
  const size_t count = std::min(bytes.size(), kSync.size());
  return std::equal(bytes.begin(), bytes.begin() + static_cast<long>(count), kSync.begin());
}

void require_file(const std::string& path) {
  std::error_code error;
  if (!fs::exists(path, error)) throw ConfigError(path + ": no such log");
  if (!fs::is_regular_file(path, error)) throw ConfigError(path + ": is not a regular file");
}

}  // namespace

EventLogReader::EventLogReader(const std::string& path) : file_(nullptr, &fclose) {
  require_file(path);
  file_.reset(fopen(path.c_str(), "rb"));
  if (!file_) throw ConfigError(path + ": cannot be read");
  size_ = static_cast<std::int64_t>(fs::file_size(path));
  seek(0);
}

void EventLogReader::seek(std::int64_t offset) {
  fseeko(file_.get(), offset, SEEK_SET);
  read_head(offset);
}

void EventLogReader::read_head(std::int64_t offset) {
  at_ = offset;
  head_.resize(kHeadBytes);
  head_.resize(fread(head_.data(), 1, kHeadBytes, file_.get()));
}

bool EventLogReader::begins_as_log() const {
  return begins_with_sync(head_);
}

bool EventLogReader::next(LogEvent& event) {
  while (at_ < size_) {
    if (read_record(event)) {
      in_damage_ = false;
      ++length_.records;
      return true;
    }
    length_.damaged_places += in_damage_ ? 0 : 1;
    in_damage_ = true;
    if (!find_next_head()) break;
  }
  return false;
}

// The lengths are correct if the next record begins at the end, or if the message decodes.
bool EventLogReader::read_record(LogEvent& event) {
  if (head_.size() < kHeadBytes || !begins_with_sync(head_)) return false;
  const std::int64_t channel_size = big_endian(&head_[20], 4);
  const std::int64_t data_size = big_endian(&head_[24], 4);
  if (channel_size < 1 || channel_size > kMaxChannelLength || data_size < 0 || data_size > kMaxMessageBytes)
    return false;
  const std::int64_t end = at_ + static_cast<std::int64_t>(kHeadBytes) + channel_size + data_size;
  if (end > size_) return false;
  const bool followed = record_begins_at(end);
  body_.resize(static_cast<size_t>(channel_size));
  if (fread(body_.data(), 1, body_.size(), file_.get()) != body_.size()) return false;
  event.channel.assign(body_.begin(), body_.end());
  const ChannelType* type = followed ? nullptr : find_channel_type(event.channel);
  if (!followed && type == nullptr) return false;
  body_.resize(static_cast<size_t>(data_size));
  if (fread(body_.data(), 1, body_.size(), file_.get()) != body_.size()) return false;
  event.data = body_.data();
  event.size = static_cast<int>(data_size);
  if (!followed && !type->decodes(event.data, event.size)) return false;
  event.time = std::clamp(big_endian(&head_[12], 8), -kLatest, kLatest);
  event.begin = at_;
  event.end = end;
  read_head(end);
  return true;
}

// A truncated file may end within the sync word.
bool EventLogReader::record_begins_at(std::int64_t offset) const {
  std::vector<std::uint8_t> word(kSync.size());
  word.resize(static_cast<size_t>(std::max<ssize_t>(0, pread(fileno(file_.get()), word.data(), word.size(), offset))));
  return begins_with_sync(word);
}

bool EventLogReader::find_next_head() {
  constexpr size_t kChunk = 4096;
  std::vector<std::uint8_t> chunk(kChunk);
  for (std::int64_t from = at_ + 1; from < size_; from += kChunk - (kSync.size() - 1)) {
    fseeko(file_.get(), from, SEEK_SET);
    const size_t got = fread(chunk.data(), 1, kChunk, file_.get());
    const auto end = chunk.begin() + static_cast<long>(got);
    const auto found = std::search(chunk.begin(), end, kSync.begin(), kSync.end());
    if (found == end) continue;
    const std::int64_t next = from + (found - chunk.begin());
    length_.skipped_bytes += next - at_;
    seek(next);
    return true;
  }
  length_.skipped_bytes += size_ - at_;
  at_ = size_;
  return false;
}

std::string log_file(const std::string& log_or_run) {
  std::error_code error;  // if a parent folder cannot be entered, the file counts as absent
  const bool is_folder = fs::is_directory(log_or_run, error);
  const std::string file = is_folder ? (fs::path(log_or_run) / "traverse.lcm").string() : log_or_run;
  require_file(file);
  return file;
}

std::string log_part(const std::string& path, int number) {
  if (number == 1) return path;
  const std::string digits = std::to_string(number);
  const fs::path first(path);
  const std::string name = first.stem().string() + "-" + std::string(3 - std::min<size_t>(3, digits.size()), '0') +
                           digits + first.extension().string();
  return (first.parent_path() / name).string();
}

std::vector<std::string> log_parts(const std::string& path) {
  std::vector<std::string> parts = {path};
  for (int number = 2; fs::is_regular_file(log_part(path, number)); ++number) parts.push_back(log_part(path, number));
  return parts;
}

LogLength for_each_event(const std::string& path, const std::function<void(const LogEvent&)>& take) {
  LogLength sum;
  for (const std::string& part : log_parts(path)) {
    EventLogReader reader(part);
    for (LogEvent event; reader.next(event);) take(event);
    sum.records += reader.length().records;
    sum.skipped_bytes += reader.length().skipped_bytes;
    sum.damaged_places += reader.length().damaged_places;
  }
  return sum;
}

}  // namespace rover
