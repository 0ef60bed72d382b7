#include "tools/interchange/mcap_writer.hpp"

#include <zlib.h>

#include <algorithm>
#include <stdexcept>

namespace rover::interchange {
namespace {

constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};
constexpr size_t kChunkBytes = 1 << 20;

enum Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F
};

std::string record(Opcode opcode, const McapBytes& content) {
  McapBytes bytes;
  bytes.number<std::uint8_t>(opcode);
  bytes.long_text(content.bytes());
  return bytes.bytes();
}

std::uint32_t checksum(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

}  // namespace

void McapBytes::text(std::string_view text) {
  number(static_cast<std::uint32_t>(text.size()));
  bytes_ += text;
}

void McapBytes::long_text(std::string_view text) {
  number(static_cast<std::uint64_t>(text.size()));
  bytes_ += text;
}

McapWriter::McapWriter(const std::string& path) : path_(path), file_(path, std::ios::binary) {
  put(kMagic);
  McapBytes header;
  header.text("");
  header.text("rover export");
  put(record(kHeader, header));
}

void McapWriter::put(std::string_view bytes) {
  file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file_) throw std::runtime_error(path_ + ": cannot be written; is the disk full?");
  size_ += bytes.size();
}

std::uint16_t McapWriter::add_channel(const std::string& topic, const std::string& schema_name,
                                      const std::string& schema) {
  const std::uint16_t id = ++channel_count_;
  McapBytes schema_content;
  schema_content.number(id);
  schema_content.text(schema_name);
  schema_content.text("jsonschema");
  schema_content.text(schema);
  McapBytes channel_content;
  channel_content.number(id);
  channel_content.number(id);
  channel_content.text(topic);
  channel_content.text("json");
  channel_content.text("");  // no metadata
  const std::string schema_record = record(kSchema, schema_content);
  const std::string channel_record = record(kChannel, channel_content);
  chunk_.raw(schema_record);
  chunk_.raw(channel_record);
  schemas_.raw(schema_record);
  channels_.raw(channel_record);
  return id;
}

void McapWriter::write(std::uint16_t channel, std::uint32_t sequence, std::uint64_t log_time_ns,
                       std::uint64_t publish_time_ns, std::string_view data) {
  if (chunk_messages_.empty()) chunk_first_ns_ = chunk_last_ns_ = log_time_ns;
  chunk_first_ns_ = std::min(chunk_first_ns_, log_time_ns);
  chunk_last_ns_ = std::max(chunk_last_ns_, log_time_ns);
  chunk_messages_[channel].emplace_back(log_time_ns, chunk_.bytes().size());
  McapBytes content;
  content.number(channel);
  content.number(sequence);
  content.number(log_time_ns);
  content.number(publish_time_ns);
  content.raw(data);
  chunk_.raw(record(kMessage, content));
  first_ns_ = message_count_ == 0 ? log_time_ns : std::min(first_ns_, log_time_ns);
  last_ns_ = std::max(last_ns_, log_time_ns);
  ++message_count_;
  ++message_counts_[channel];
  if (chunk_.bytes().size() >= kChunkBytes) close_chunk();
}

void McapWriter::close_chunk() {
  if (chunk_.bytes().empty()) return;
  ChunkIndex index{chunk_first_ns_, chunk_last_ns_, size_, 0, 0, chunk_.bytes().size(), {}};
  McapBytes content;
  content.number(chunk_first_ns_);
  content.number(chunk_last_ns_);
  content.number(static_cast<std::uint64_t>(chunk_.bytes().size()));
  content.number(checksum(chunk_.bytes()));
  content.text("");  // not compressed
  content.long_text(chunk_.bytes());
  put(record(kChunk, content));
  index.length = size_ - index.offset;
  for (const auto& [channel, messages] : chunk_messages_) {
    index.index_offsets[channel] = size_;
    McapBytes times;
    for (const auto& [time_ns, offset] : messages) {
      times.number(time_ns);
      times.number(offset);
    }
    McapBytes message_index;
    message_index.number(channel);
    message_index.text(times.bytes());
    put(record(kMessageIndex, message_index));
  }
  index.index_length = size_ - index.offset - index.length;
  chunks_.push_back(std::move(index));
  chunk_.clear();
  chunk_messages_.clear();
  chunk_first_ns_ = chunk_last_ns_ = 0;
}

std::string McapWriter::index_record(const ChunkIndex& chunk) const {
  McapBytes offsets;
  for (const auto& [channel, offset] : chunk.index_offsets) {
    offsets.number(channel);
    offsets.number(offset);
  }
  McapBytes content;
  content.number(chunk.first_ns);
  content.number(chunk.last_ns);
  content.number(chunk.offset);
  content.number(chunk.length);
  content.text(offsets.bytes());
  content.number(chunk.index_length);
  content.text("");
  content.number(chunk.size);  // compressed
  content.number(chunk.size);
  return record(kChunkIndex, content);
}

std::string McapWriter::statistics_record() const {
  McapBytes counts;
  for (const auto& [channel, count] : message_counts_) {
    counts.number(channel);
    counts.number(count);
  }
  McapBytes content;
  content.number(message_count_);
  content.number(channel_count_);                              // schemas
  content.number(static_cast<std::uint32_t>(channel_count_));  // channels
  content.number(std::uint32_t{0});                            // attachments
  content.number(std::uint32_t{0});                            // metadata
  content.number(static_cast<std::uint32_t>(chunks_.size()));
  content.number(first_ns_);
  content.number(last_ns_);
  content.text(counts.bytes());
  return record(kStatistics, content);
}

void McapWriter::finish() {
  close_chunk();
  McapBytes data_end;
  data_end.number(std::uint32_t{0});  // no checksum of the data section: each chunk has its own
  put(record(kDataEnd, data_end));

  const std::uint64_t summary_start = size_;
  std::string summary;
  std::vector<Group> groups;
  const auto add = [&](Opcode opcode, const std::string& records) {
    if (!records.empty()) groups.push_back({opcode, summary_start + summary.size(), records.size()});
    summary += records;
  };
  add(kSchema, schemas_.bytes());
  add(kChannel, channels_.bytes());
  std::string indices;
  for (const ChunkIndex& chunk : chunks_) indices += index_record(chunk);
  add(kChunkIndex, indices);
  add(kStatistics, statistics_record());
  const std::uint64_t offsets_start = summary_start + summary.size();
  for (const Group& group : groups) {
    McapBytes content;
    content.number(group.opcode);
    content.number(group.offset);
    content.number(group.length);
    summary += record(kSummaryOffset, content);
  }
  // The checksum covers the summary and the footer up to itself.
  McapBytes footer;
  footer.number<std::uint8_t>(kFooter);
  footer.number(std::uint64_t{8 + 8 + 4});
  footer.number(summary_start);
  footer.number(offsets_start);
  footer.number(checksum(summary + footer.bytes()));
  put(summary);
  put(footer.bytes());
  put(kMagic);
  file_.close();
  if (!file_) throw std::runtime_error(path_ + ": cannot be written; is the disk full?");
}

}  // namespace rover::interchange
