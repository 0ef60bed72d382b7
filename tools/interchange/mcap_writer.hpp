// Writes MCAP files (https://mcap.dev/spec, version 0): chunked, indexed, uncompressed.
#pragma once

#include <cstdint>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace rover::interchange {

// Little-endian encoder of MCAP records.
class McapBytes {
 public:
  template <class Unsigned>
  void number(Unsigned value) {
    for (size_t i = 0; i < sizeof(Unsigned); ++i)
      bytes_ += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xffU);
  }
  // With a length prefix of 4 or 8 bytes.
  void text(std::string_view text);
  void long_text(std::string_view text);
  void raw(std::string_view text) { bytes_ += text; }
  const std::string& bytes() const { return bytes_; }
  void clear() { bytes_.clear(); }

 private:
  std::string bytes_;
};

class McapWriter {
 public:
  // Throws std::runtime_error if the file cannot be written.
  explicit McapWriter(const std::string& path);

  // Adds a topic of JSON messages with its schema. Returns the channel id for write().
  std::uint16_t add_channel(const std::string& topic, const std::string& schema_name, const std::string& schema);
  void write(std::uint16_t channel, std::uint32_t sequence, std::uint64_t log_time_ns, std::uint64_t publish_time_ns,
             std::string_view data);
  // Writes index, statistics and footer; required for a valid file. Throws std::runtime_error.
  void finish();

 private:
  struct ChunkIndex {
    std::uint64_t first_ns, last_ns, offset, length, index_length, size;
    std::map<std::uint16_t, std::uint64_t> index_offsets;
  };
  struct Group {
    std::uint8_t opcode;
    std::uint64_t offset, length;
  };
  void put(std::string_view bytes);
  void close_chunk();
  std::string index_record(const ChunkIndex& chunk) const;
  std::string statistics_record() const;

  std::string path_;
  std::ofstream file_;
  std::uint64_t size_ = 0;  // bytes written
  McapBytes chunk_;         // records not yet written
  std::uint64_t chunk_first_ns_ = 0;
  std::uint64_t chunk_last_ns_ = 0;
  std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> chunk_messages_;  // time, offset
  std::vector<ChunkIndex> chunks_;
  McapBytes schemas_, channels_;  // records repeated in the summary
  std::uint16_t channel_count_ = 0;
  std::map<std::uint16_t, std::uint64_t> message_counts_;
  std::uint64_t message_count_ = 0;
  std::uint64_t first_ns_ = 0;
  std::uint64_t last_ns_ = 0;
};

}  // namespace rover::interchange
