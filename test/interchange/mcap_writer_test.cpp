// Structure of the file, record by record. test/integration/export_test.sh uses the reference reader.
#include "tools/interchange/mcap_writer.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <map>

#include "../common/temp_folder.hpp"

namespace rover::interchange {
namespace {

template <class Number>
Number number_at(const std::string& bytes, size_t at) {
  Number value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

class McapWriterTest : public testing::Test {
 protected:
  void SetUp() override {
    McapWriter writer(path_);
    const auto pose = writer.add_channel("/POSE", "rover.pose_t", "{}");
    const auto slip = writer.add_channel("/SLIP", "rover.slip_t", "{}");
    // More than one chunk.
    const std::string filler(3000, 'x');
    for (std::uint32_t i = 0; i < 1000; ++i)
      writer.write(i % 2 == 0 ? pose : slip, i, 1'000'000 * i + 7, 1'000'000 * i, "{\"a\":\"" + filler + "\"}");
    writer.finish();
    std::ifstream in(path_, std::ios::binary);
    file_.assign(std::istreambuf_iterator<char>(in), {});
  }

  testing_support::TempFolder folder_;
  std::string path_ = folder_.file("out.mcap");
  std::string file_;
};

constexpr size_t kMagicBytes = 8;

TEST_F(McapWriterTest, RecordsFillFileAndChunksMatchIndex) {
  ASSERT_EQ(file_.substr(0, kMagicBytes), std::string("\x89MCAP0\r\n", 8));
  ASSERT_EQ(file_.substr(file_.size() - kMagicBytes), std::string("\x89MCAP0\r\n", 8));
  std::map<int, int> counts;
  std::vector<size_t> chunks, indexed;
  size_t at = kMagicBytes;
  size_t footer = 0;
  while (at < file_.size() - kMagicBytes) {
    const int opcode = static_cast<unsigned char>(file_[at]);
    const auto length = number_at<std::uint64_t>(file_, at + 1);
    ++counts[opcode];
    if (opcode == 0x06) chunks.push_back(at);
    if (opcode == 0x08) indexed.push_back(number_at<std::uint64_t>(file_, at + 9 + 16));
    if (opcode == 0x02) footer = at;
    at += 9 + length;
  }
  EXPECT_EQ(at, file_.size() - kMagicBytes);
  EXPECT_GE(chunks.size(), 2U);
  EXPECT_EQ(chunks, indexed);
  EXPECT_EQ(counts[0x03], 2) << "schemas of the summary";
  EXPECT_EQ(counts[0x04], 2);
  EXPECT_EQ(counts[0x0B], 1);
  EXPECT_EQ(counts[0x0F], 1);
  const auto summary = number_at<std::uint64_t>(file_, footer + 9);
  const std::string covered = file_.substr(summary, footer + 9 + 16 - summary);
  EXPECT_EQ(number_at<std::uint32_t>(file_, footer + 9 + 16),
            crc32(0, reinterpret_cast<const Bytef*>(covered.data()), static_cast<uInt>(covered.size())));
}

TEST_F(McapWriterTest, ChunkHasChecksumAndTimeRange) {
  size_t at = kMagicBytes;
  while (file_[at] != 0x06) at += 9 + number_at<std::uint64_t>(file_, at + 1);
  const size_t content = at + 9;
  EXPECT_EQ(number_at<std::uint64_t>(file_, content), 7U);
  const auto size = number_at<std::uint64_t>(file_, content + 16);
  const auto records = content + 16 + 8 + 4 + 4 + 8;
  EXPECT_EQ(number_at<std::uint32_t>(file_, content + 24),
            crc32(0, reinterpret_cast<const Bytef*>(file_.data() + records), static_cast<uInt>(size)));
}

TEST(McapWriter, SaysSoWhereItCannotWrite) {
  EXPECT_THROW(McapWriter("/nowhere/out.mcap"), std::runtime_error);
}

}  // namespace
}  // namespace rover::interchange
