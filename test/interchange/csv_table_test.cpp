#include "tools/interchange/csv_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <rover/heartbeat_t.hpp>
#include <rover/path_t.hpp>
#include <sstream>

#include "common/bus/channels.hpp"
#include "common/bus/streams.hpp"
#include "common/core/frames.hpp"

namespace rover::interchange {
namespace {

template <class Message>
Fields fields_of(const char* channel, const Message& message) {
  std::vector<std::uint8_t> bytes = encoded(message);
  return decode_fields(channel, bytes.data(), static_cast<int>(bytes.size())).value();
}

// The cell of a column in a row without quotes.
std::string cell(const std::vector<std::string>& columns, const std::string& row, const std::string& column) {
  const auto index = std::find(columns.begin(), columns.end(), column) - columns.begin();
  std::istringstream in(row.substr(0, row.find("\r\n")));
  std::string text;
  for (int i = 0; i <= index; ++i) std::getline(in, text, ',');
  return text;
}

TEST(CsvTable, HasAColumnForEachNumberOfAFixedArray) {
  const auto columns = csv_columns("pose_t");
  EXPECT_EQ(columns.front(), "header.utime");
  EXPECT_NE(std::find(columns.begin(), columns.end(), "position_odom_body_m[2]"), columns.end());
  EXPECT_EQ(std::count_if(columns.begin(), columns.end(),
                          [](const std::string& column) { return column.rfind("covariance[", 0) == 0; }),
            36);
}

TEST(CsvTable, ArraysThatVaryAreOneColumn) {
  path_t path{};
  path.header.utime = 123456;
  path.point_count = 3;
  path.x_m = {1.5, kNaN, -0.1};
  path.y_m = {0.0, 1.0, 2.0};
  path.level = {0, 1, 0};
  path.direction = {0, 1, 0};
  const auto columns = csv_columns("path_t");
  std::ostringstream row;
  write_csv_row(row, columns, fields_of(channel::kPath, path));
  EXPECT_EQ(cell(columns, row.str(), "header.utime"), "123456");
  EXPECT_EQ(cell(columns, row.str(), "x_m"), "1.5 nan -0.1");
  EXPECT_EQ(cell(columns, row.str(), "level"), "0 1 0");
}

TEST(CsvTable, ArraysOfMessagesAreOneColumnForEachOfTheirFields) {
  heartbeat_t heartbeat{};
  heartbeat.service = "stereo";
  heartbeat.text = "a \"word\", and more";
  heartbeat.input_count = 2;
  heartbeat.inputs.resize(2);
  heartbeat.inputs[0].channel = "IMU";
  heartbeat.inputs[0].gaps = 4;
  heartbeat.inputs[1].channel = "VO";
  heartbeat.inputs[1].gaps = 5;
  const auto columns = csv_columns("heartbeat_t");
  std::ostringstream row;
  write_csv_row(row, columns, fields_of(channel::kHeartbeat, heartbeat));
  EXPECT_NE(row.str().find(",\"a \"\"word\"\", and more\","), std::string::npos) << row.str();
  EXPECT_NE(row.str().find("IMU VO"), std::string::npos);
  EXPECT_NE(row.str().find("4 5"), std::string::npos);
  heartbeat.input_count = 0;
  heartbeat.inputs.clear();
  heartbeat.text = "";
  std::ostringstream none;
  write_csv_row(none, columns, fields_of(channel::kHeartbeat, heartbeat));
  const std::string text = none.str();
  EXPECT_EQ(static_cast<size_t>(std::count(text.begin(), text.end(), ',')), columns.size() - 1);
}

TEST(CsvTable, PicturesHaveNoColumn) {
  const auto disparity = csv_columns("disparity_t");
  EXPECT_EQ(std::find(disparity.begin(), disparity.end(), "disparity_px16"), disparity.end());
  EXPECT_NE(std::find(disparity.begin(), disparity.end(), "width"), disparity.end());
  for (const std::string& column : csv_columns("image_t")) EXPECT_EQ(column.rfind("data", 0), std::string::npos);
}

}  // namespace
}  // namespace rover::interchange
