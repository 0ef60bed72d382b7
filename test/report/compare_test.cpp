#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "../common/temp_folder.hpp"
#include "common/bus/config.hpp"
#include "synthetic_run.hpp"
#include "tools/report/compare_html.hpp"
#include "tools/report/compare_runs.hpp"
#include "tools/report/html_parts.hpp"
#include "tools/report/map_picture.hpp"
#include "tools/report/run_folder.hpp"
#include "tools/report/slope_map.hpp"

namespace rover::report {
namespace {

namespace fs = std::filesystem;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

Metrics metrics_of(double duration_s, int replans) {
  Metrics m;
  m.outcome = "goal_reached";
  m.info.scenario = "flat";
  m.duration_s = duration_s;
  m.replans = replans;
  m.planned_length_m = 12.0;
  m.services["stereo"].p99_ms = 4.0;
  return m;
}

TEST(CompareHtml, TheBetterFigureIsMarked) {
  const ComparedRun a{"run_a", metrics_of(100.0, 3), {}};
  const ComparedRun b{"run_b", metrics_of(90.0, 3), {}};
  const std::string html = compare_html(a, b, {});
  EXPECT_THAT(html, HasSubstr("<td>Duration of the drive</td><td class=\"n\">100 s</td><td class=\"n better\">90 s</td>"
                              "<td class=\"n\">-10</td>"));
  EXPECT_THAT(html, HasSubstr("<td>Repairs</td><td class=\"n\">3</td><td class=\"n\">3</td><td class=\"n\">=</td>"));
  EXPECT_THAT(html, HasSubstr("<td>Rocks missed</td><td class=\"n\">n/a</td><td class=\"n\">n/a</td>"));
  EXPECT_THAT(html, HasSubstr("<td>Planned path</td><td class=\"n\">12.0 m</td><td class=\"n\">12.0 m</td>"));
}

TEST(CompareHtml, NamesOfAPictureStayUnique) {
  Pictures pictures;
  pictures.map = "<svg><clipPath id=\"map-frame\"/><g clip-path=\"url(#map-frame)\"/></svg>";
  const std::string html = compare_html({"a", metrics_of(1, 1), pictures}, {"b", metrics_of(1, 1), pictures}, {});
  EXPECT_THAT(html, HasSubstr("<clipPath id=\"a-map-frame\"/><g clip-path=\"url(#a-map-frame)\"/>"));
  EXPECT_THAT(html, HasSubstr("<clipPath id=\"b-map-frame\"/><g clip-path=\"url(#b-map-frame)\"/>"));
}

TEST(CompareHtml, ConfigurationTextIsEscaped) {
  const std::string html =
      compare_html({"<a>", metrics_of(1, 1), {}}, {"b", metrics_of(1, 1), {}}, {{"f: key", "<script>", ""}});
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;"));
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, Not(HasSubstr("<a>")));
}

TEST(ConfigDifference, OnlyWhatDiffersByFileAndKey) {
  const auto differences = config_differences(
      {{"planner.yaml", "margin_m: 0.2\nlimits: {speed: 1, turn: 2}\nxs: [1, 2]\n"}, {"gone.yaml", "a: 1\n"}},
      {{"planner.yaml", "# a comment\nmargin_m: 0.3\nlimits: {speed: 1, turn: 3}\nxs: [1, 2]\n"}});
  ASSERT_EQ(differences.size(), 3U);
  EXPECT_EQ(differences[0].key, "gone: a");
  EXPECT_EQ(differences[0].b, "");
  EXPECT_EQ(differences[1].key, "planner: limits.turn");
  EXPECT_EQ(differences[2].key, "planner: margin_m");
  EXPECT_EQ(differences[2].a, "0.2");
  EXPECT_EQ(differences[2].b, "0.3");
}

TEST(SlopeMap, SteepGroundHasTheLastClass) {
  HeightRaster raster{20, 20, 1.0, {}};
  for (int row = 0; row < 20; ++row)
    for (int column = 0; column < 20; ++column)
      raster.z_m.push_back(column < 10 ? 0.0F : 0.6F * static_cast<float>(column - 9));
  const auto colour = [&](const Box& box) {
    const cv::Mat picture = cv::imdecode(slope_jpeg(raster, box, 16, 16), cv::IMREAD_COLOR);
    return picture.at<cv::Vec3b>(8, 8);
  };
  const cv::Vec3b flat = colour({2.0, 5.0, 6.0, 9.0});
  const cv::Vec3b steep = colour({13.0, 5.0, 17.0, 9.0});
  EXPECT_NEAR(flat[2], 0xe8, 4);
  EXPECT_NEAR(flat[0], 0xdc, 4);
  EXPECT_NEAR(steep[2], 0xd2, 4);
  EXPECT_NEAR(steep[0], 0x2f, 4);
}

class CompareRuns : public testing::Test {
 protected:
  std::string write_run(const std::string& name, double speed_mps) {
    SyntheticRun run;
    run.planned = {{10.0, 10.0}, {16.0, 10.0}};
    run.speed_mps = speed_mps;
    const std::string dir = folder_.file(name);
    fs::create_directories(dir);
    write_synthetic_run(run, dir);
    return dir;
  }
  static constexpr char kConfig[] = ROVER_SOURCE_DIR "/config";
  testing_support::TempFolder folder_;
};

TEST_F(CompareRuns, OnePageOfBoth) {
  const std::string a = write_run("slow", 0.1);
  const std::string b = write_run("fast", 0.18);
  const std::string file = folder_.file("both.html");
  compare_runs({a}, {b + "/"}, kConfig, file);
  const std::string html = read_file(file);
  EXPECT_THAT(html, HasSubstr("<title>Compared: slow, fast</title>"));
  EXPECT_THAT(html, ContainsRegex("Duration of the drive</td><td class=\"n\">60 s</td><td class=\"n better\">33 s"));
  for (const MapLayerInfo& layer : kMapLayers)
    EXPECT_THAT(html, HasSubstr("id=\"show-" + std::string(layer.id) + "\"")) << "one switch for both maps";
  EXPECT_FALSE(fs::exists(a + "/report.html")) << "the runs' own reports stay as they are";
  compare_runs({a}, {b}, kConfig, file);  // repeated
  EXPECT_EQ(read_file(file), html);
}

TEST_F(CompareRuns, OverwritesOnlyComparisonPages) {
  const std::string a = write_run("a", 0.1);
  std::ofstream(folder_.file("notes.html")) << "mine";
  EXPECT_THROW(compare_runs({a}, {a}, kConfig, folder_.file("notes.html")), ConfigError);
  EXPECT_EQ(read_file(folder_.file("notes.html")), "mine");
}

}  // namespace
}  // namespace rover::report
