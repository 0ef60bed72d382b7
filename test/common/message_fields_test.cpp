#include "common/bus/message_fields.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <rover/heartbeat_t.hpp>
#include <rover/image_t.hpp>
#include <rover/slip_t.hpp>
#include <rover/supervisor_state_t.hpp>
#include <rover/truth_t.hpp>
#include <sstream>

#include "common/bus/channel_types.hpp"
#include "common/bus/channels.hpp"
#include "common/bus/streams.hpp"

namespace rover {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsSupersetOf;
using ::testing::Pair;

std::optional<Fields> decoded(const std::string& channel, const std::vector<std::uint8_t>& bytes) {
  return decode_fields(channel, bytes.data(), static_cast<int>(bytes.size()));
}

std::vector<std::pair<std::string, std::string>> leaves_of(const Fields& fields) {
  std::vector<std::pair<std::string, std::string>> leaves;
  visit_leaves(fields, [&](const Leaf& leaf) { leaves.emplace_back(leaf.path, text_of(leaf.field, leaf.index)); });
  return leaves;
}

header_t some_header() {
  header_t header{};
  header.utime = 1'000'000;
  header.release_utime = 1'300'000;
  header.seq = -7;
  header.publisher = "somebody";
  header.boot_id = std::int64_t{1} << 40;
  return header;
}

heartbeat_t some_heartbeat() {
  heartbeat_t message{};
  message.header = some_header();
  message.service = "stereo";
  message.pid = 70'000;
  message.status = heartbeat_t::DEGRADED;
  message.cpu_s = 0.1;
  message.rss_mb = std::numeric_limits<double>::quiet_NaN();
  message.input_count = 2;
  message.inputs.resize(2);
  message.inputs[0].channel = "LOCCAM_LEFT";
  message.inputs[1].channel = "LOCCAM_RIGHT";
  message.inputs[1].gaps = 3;
  return message;
}

TEST(MessageFields, MessagesOfMessagesComeAsWritten) {
  const auto fields = decoded(channel::kHeartbeat, encoded(some_heartbeat()));
  ASSERT_TRUE(fields);
  EXPECT_THAT(leaves_of(*fields),
              IsSupersetOf({Pair("header.utime", "1000000"), Pair("header.seq", "-7"),
                            Pair("header.publisher", "somebody"), Pair("header.boot_id", "1099511627776"),
                            Pair("service", "stereo"), Pair("pid", "70000"), Pair("status", "1"), Pair("text", ""),
                            Pair("cpu_s", "0.1"), Pair("rss_mb", "nan"), Pair("inputs[0].channel", "LOCCAM_LEFT"),
                            Pair("inputs[1].channel", "LOCCAM_RIGHT"), Pair("inputs[1].gaps", "3")}));
}

TEST(MessageFields, ArraysHaveTheirShapeAndType) {
  truth_t message{};
  message.header = some_header();
  message.wheel_slip[5] = -0.25;
  message.wheel_soil[2] = truth_t::BEDROCK;
  const auto fields = decoded(channel::kTruth, encoded(message));
  ASSERT_TRUE(fields);
  const auto field =
      std::find_if(fields->begin(), fields->end(), [](const Field& f) { return f.name == "wheel_slip"; });
  ASSERT_NE(field, fields->end());
  EXPECT_EQ(field->type, "double");
  EXPECT_THAT(field->shape, ElementsAre(6));
  EXPECT_THAT(std::get<Field::Reals>(field->values), ElementsAre(0, 0, 0, 0, 0, -0.25));
  EXPECT_THAT(leaves_of(*fields), Contains(Pair("wheel_soil[2]", "2")));
}

TEST(MessageFields, ArraysOfVariableLengthHaveTheirLengthFields) {
  image_t message{};
  message.header = some_header();
  message.exposure_s = 0.3F;
  message.size = 3;
  message.data = {1, 128, 255};
  const auto fields = decoded(channel::kLocCamLeft, encoded(message));
  ASSERT_TRUE(fields);
  EXPECT_THAT(fields->back().shape, ElementsAre(3));
  EXPECT_THAT(std::get<Field::Bytes>(fields->back().values), ElementsAre(1, 128, 255));
  EXPECT_THAT(leaves_of(*fields), Contains(Pair("exposure_s", "0.3"))) << "a float has a float's digits";
}

TEST(MessageFields, TextsOfVariableNumber) {
  supervisor_state_t message{};
  message.header = some_header();
  message.fault_count = 2;
  message.faults = {"slip", ""};
  const auto fields = decoded(channel::kState, encoded(message));
  ASSERT_TRUE(fields);
  EXPECT_THAT(std::get<Field::Texts>(fields->back().values), ElementsAre("slip", ""));
}

TEST(MessageFields, RealsReadBackAsTheSameNumber) {
  slip_t message{};
  message.header = some_header();
  message.slip_ratio = std::nextafter(0.1, 1.0);
  message.visual_mps = -std::numeric_limits<double>::infinity();
  const auto fields = decoded(channel::kSlip, encoded(message));
  ASSERT_TRUE(fields);
  EXPECT_THAT(leaves_of(*fields),
              IsSupersetOf({Pair("slip_ratio", "0.10000000000000002"), Pair("visual_mps", "-inf")}));
}

TEST(MessageFields, NothingOfWhatIsNotOneWholeMessage) {
  const std::vector<std::uint8_t> whole = encoded(some_heartbeat());
  for (size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(decoded(channel::kHeartbeat, {whole.begin(), whole.begin() + static_cast<long>(size)})) << size;
  std::vector<std::uint8_t> longer = whole;
  longer.push_back(0);
  EXPECT_FALSE(decoded(channel::kHeartbeat, longer));
  EXPECT_FALSE(decoded(channel::kSlip, whole)) << "of another type";
  EXPECT_FALSE(decoded("NO_SUCH_CHANNEL", whole));
}

TEST(MessageFields, ADamagedLengthIsNoMessage) {
  image_t message{};
  message.header = some_header();
  message.size = 3;
  message.data = {1, 2, 3};
  for (const std::uint8_t damage : {std::uint8_t{0x80}, std::uint8_t{0x7F}}) {  // negative, and far beyond the end
    std::vector<std::uint8_t> bytes = encoded(message);
    bytes[bytes.size() - 7] = damage;
    EXPECT_FALSE(decoded(channel::kLocCamLeft, bytes));
  }
}

std::uintmax_t peak_memory_kb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uintmax_t>(usage.ru_maxrss);
}

// lcm-gen's decoders allocate memory for a length before they check the number of bytes.
TEST(MessageFields, ALengthThatIsClaimedTakesNoMemory) {
  image_t image{};
  image.header = some_header();
  image.size = 1;
  image.data = {7};
  auto bytes = encoded(image);
  const ChannelType& type = *find_channel_type(channel::kLocCamLeft);
  ASSERT_TRUE(type.decodes(bytes.data(), static_cast<int>(bytes.size())));
  std::copy_n(std::initializer_list<std::uint8_t>{0x7f, 0xff, 0xff, 0xff}.begin(), 4, bytes.end() - 5);
  const auto before = peak_memory_kb();
  EXPECT_FALSE(type.decodes(bytes.data(), static_cast<int>(bytes.size())));
  EXPECT_FALSE(decoded(channel::kLocCamLeft, bytes));
  EXPECT_LT(peak_memory_kb(), before + 100'000);
}

TEST(MessageFields, WholeIsWhatTheGeneratedDecoderTakes) {
  const auto bytes = encoded(some_heartbeat());
  const ChannelType& type = *find_channel_type(channel::kHeartbeat);
  for (size_t i = 0; i <= bytes.size(); ++i) {
    heartbeat_t message;
    EXPECT_EQ(type.decodes(bytes.data(), static_cast<int>(i)),
              decode_message(bytes.data(), static_cast<int>(i), message));
    auto longer = bytes;
    longer.insert(longer.begin() + static_cast<long>(i), 0);
    const int size = static_cast<int>(longer.size());
    EXPECT_EQ(type.decodes(longer.data(), size), decode_message(longer.data(), size, message)) << i;
  }
}

TEST(MessageSchema, EveryTypedChannelHasOne) {
  for (const std::string& channel : typed_channels()) {
    const MessageSchema* schema = find_schema(find_channel_type(channel)->name);
    ASSERT_NE(schema, nullptr) << channel;
    ASSERT_FALSE(schema->fields.empty()) << channel;
    EXPECT_EQ(schema->fields.front().name, "header") << channel;
    EXPECT_EQ(schema->fields.front().type, "header_t") << channel;
  }
  EXPECT_EQ(find_schema("no_such_t"), nullptr);
}

// Tools ignore channels without a type.
TEST(MessageSchema, EveryNamedChannelHasAType) {
  std::ifstream file(ROVER_SOURCE_DIR "/services/common/bus/channels.hpp");
  int found = 0;
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("inline constexpr char k")) continue;
    const size_t from = line.find('"') + 1;
    const std::string channel = line.substr(from, line.find('"', from) - from);
    const ChannelType* type = find_channel_type(channel);
    ASSERT_NE(type, nullptr) << channel;
    EXPECT_NE(line.find(std::string("// ") + type->name), std::string::npos) << line << " carries " << type->name;
    ++found;
  }
  EXPECT_EQ(found, static_cast<int>(typed_channels().size()));
}

TEST(MessageSchema, SeveralDimensionsInTheirOrder) {
  const auto schemas = parse_schemas("struct p.a_t [hash=0x1]\n\tdouble  m [ (const) 2 ] [ (var) n ]\n\tp.b_t  b\n");
  ASSERT_EQ(schemas.size(), 1U);
  EXPECT_EQ(schemas[0].type, "a_t");
  ASSERT_EQ(schemas[0].fields.size(), 2U);
  ASSERT_EQ(schemas[0].fields[0].dimensions.size(), 2U);
  EXPECT_EQ(schemas[0].fields[0].dimensions[0].length, 2);
  EXPECT_EQ(schemas[0].fields[0].dimensions[1].length_field, "n");
  EXPECT_EQ(schemas[0].fields[1].type, "b_t");
}

TEST(VisitLeaves, CountsTheLastIndexFastest) {
  const Fields fields = {{"m", "double", {2, 2}, Field::Reals{1, 2, 3, 4}}};
  EXPECT_THAT(leaves_of(fields),
              ElementsAre(Pair("m[0][0]", "1"), Pair("m[0][1]", "2"), Pair("m[1][0]", "3"), Pair("m[1][1]", "4")));
}

}  // namespace
}  // namespace rover
