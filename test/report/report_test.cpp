// From a log on disk to the report files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <rover/command_ack_t.hpp>
#include <rover/path_t.hpp>
#include <rover/slip_t.hpp>
#include <rover/tick_t.hpp>
#include <rover/truth_t.hpp>

#include "../common/temp_folder.hpp"
#include "common/bus/channels.hpp"
#include "common/bus/config.hpp"
#include "message_log.hpp"
#include "synthetic_run.hpp"
#include "tools/report/html.hpp"
#include "tools/report/log_reader.hpp"
#include "tools/report/make_report.hpp"
#include "tools/report/map_picture.hpp"
#include "tools/report/metrics_json.hpp"
#include "tools/report/oracle_evaluation.hpp"
#include "wild.hpp"

namespace rover::report {
namespace {

namespace fs = std::filesystem;

constexpr char kConfig[] = ROVER_SOURCE_DIR "/config";

SyntheticRun short_run() {
  SyntheticRun run;
  run.planned = {{10.0, 10.0}, {22.0, 10.0}};
  run.rocks = {{16.0, 10.0, 0.2, 0.25}, {20.0, 13.0, 0.3, 0.3}};
  run.swerves_m = {6.0};
  return run;
}

TrueWorld world_of(const SyntheticRun& run) {
  return {run.rocks, run.height_m};
}

// One run, written once for all tests.
class ReportTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<testing_support::TempFolder>();
    dir_ = folder_->file("run");
    fs::create_directories(dir_);
    write_synthetic_run(short_run(), dir_);
    write_report(study());
  }
  static void TearDownTestSuite() { folder_.reset(); }
  // The synthetic world, which no scenario can regenerate.
  static Study study() {
    Study study;
    study.folder = open_run_folder(dir_, kConfig);
    study.log = choose_run(study.folder.log);
    study.run = read_log(study.log);
    study.world = world_of(short_run());
    study.evaluation = evaluate(study.run, study.folder.info, study.folder.footprint, study.world);
    return study;
  }
  static nlohmann::json metrics() { return nlohmann::json::parse(read_file(dir_ + "/metrics.json")); }
  static inline std::unique_ptr<testing_support::TempFolder> folder_;
  static inline std::string dir_;
};

TEST_F(ReportTest, MetricsMatchSyntheticRun) {
  const nlohmann::json m = metrics();
  EXPECT_EQ(m["scenario"], "synthetic");
  EXPECT_EQ(m["seed"], 3);
  EXPECT_EQ(m["outcome"], "goal_reached");
  EXPECT_EQ(m["deterministic"], true);
  EXPECT_NEAR(m["planned_length_m"], 12.0, 1e-9);
  EXPECT_NEAR(m["odometry_drift_percent"], 0.5, 0.02);
  EXPECT_NEAR(m["duration_s"], 12.0 / 0.18, 0.05);
  EXPECT_EQ(m["replans"], 1);
  EXPECT_NEAR(m["progress"], 0.9, 1e-3);
  EXPECT_NEAR(m["seconds"]["straight"], m["duration_s"], 0.1);
  EXPECT_EQ(m["reverse_m"], 0.0);
  EXPECT_EQ(m["rocks_missed"], 0);
  EXPECT_EQ(m["false_stops"], 0);
  EXPECT_EQ(m["realtime_factor"], 5.0);
  EXPECT_NEAR(m["final_error_m"], 0.0, 0.01);
  EXPECT_EQ(m["bus"]["lost"], 0);
  EXPECT_GT(m["path_ratio"], 1.01);
  EXPECT_LT(m["path_ratio"], 1.25);
}

TEST_F(ReportTest, MetricNamesAreStable) {
  const nlohmann::json m = metrics();
  for (const char* name : {"scenario",
                           "seed",
                           "commit",
                           "deterministic",
                           "outcome",
                           "planned_length_m",
                           "driven_length_m",
                           "path_ratio",
                           "oracle_m",
                           "oracle_feasible",
                           "regret",
                           "duration_s",
                           "progress",
                           "duty",
                           "seconds",
                           "reverse_m",
                           "hazard_clearance_m",
                           "hazard_stops",
                           "replans",
                           "level_switches",
                           "collisions",
                           "min_clearance_m",
                           "max_roll_deg",
                           "max_pitch_deg",
                           "cross_track_rms_m",
                           "cross_track_max_m",
                           "truth_deviation_max_m",
                           "odometry_drift_percent",
                           "slam_drift_percent",
                           "final_error_m",
                           "estimate_error_max_m",
                           "corrected_error_max_m",
                           "anees",
                           "anees_after_fix",
                           "map",
                           "global_corrections",
                           "levels",
                           "rocks_encountered",
                           "rocks_missed",
                           "false_stops",
                           "fdir",
                           "services",
                           "bus",
                           "realtime_factor",
                           "final_truth_pose"})
    EXPECT_TRUE(m.contains(name)) << name;
  for (const char* name : {"cpu_s", "cpu_s_per_m", "cpu_s_per_m_efficient", "cpu_s_per_m_full", "rss_mb",
                           "rss_first_half_mb", "restarts", "p50_ms", "p99_ms"})
    EXPECT_TRUE(m["services"]["stereo"].contains(name)) << name;
  for (const char* name : {"straight", "curve", "steering", "point_turn", "reverse", "waiting_for_plan", "hazard_stop",
                           "sweep", "blind", "fault", "other"})
    EXPECT_TRUE(m["seconds"].contains(name)) << name;
  for (const char* name : {"messages", "lost", "bytes"}) EXPECT_TRUE(m["bus"].contains(name)) << name;
}

TEST_F(ReportTest, RegretIsTheDrivenLengthOverTheShortestDrivablePath) {
  Study changed = study();
  EXPECT_TRUE(std::isnan(changed.evaluation.metrics.oracle_m)) << "not evaluated";
  changed.world->ground_m = [](double, double) { return 0.0; };
  evaluate_oracle(changed.run, changed.folder.vehicle, changed.world, changed.evaluation);
  const Metrics& m = changed.evaluation.metrics;
  EXPECT_EQ(m.oracle_feasible, true);
  EXPECT_NEAR(m.oracle_m, 12.0 - changed.world->goal_tolerance_m, 0.03);
  EXPECT_NEAR(m.regret, m.driven_length_m / m.oracle_m, 1e-9);
  EXPECT_NE(draw_map(changed.scene()).find("shortest drivable path"), std::string::npos);
  EXPECT_EQ(draw_map(study().scene()).find("shortest drivable path"), std::string::npos);
}

TEST_F(ReportTest, ClosedWorldHasNoOracle) {
  Study changed = study();
  changed.world->height_m = [](double x_m, double) { return std::abs(x_m - 16.0) < 0.1 ? 0.5 : 0.0; };
  changed.world->ground_m = [](double, double) { return 0.0; };
  evaluate_oracle(changed.run, changed.folder.vehicle, changed.world, changed.evaluation);
  const nlohmann::json m = metrics_json(changed.evaluation.metrics);
  EXPECT_EQ(m["oracle_feasible"], false);
  EXPECT_TRUE(m["oracle_m"].is_null());
  EXPECT_TRUE(m["regret"].is_null());
}

TEST_F(ReportTest, MapFidelityHasAnArrayOfRangesForEachHeight) {
  Study changed = study();
  changed.world->ground_m = [](double, double) { return 0.0; };
  const RunEvaluation evaluation = evaluate(changed.run, changed.folder.info, changed.folder.footprint, changed.world);
  const nlohmann::json map = metrics_json(evaluation.metrics)["map"]["hazards"];
  EXPECT_GT(map["maps"], 100);
  EXPECT_GT(map["observed_cells"], 1000);
  for (const char* key : {"impassable", "lower", "upper", "looks", "cells"}) {
    ASSERT_EQ(map[key].size(), kHeightClasses) << key;
    for (const auto& row : map[key]) EXPECT_EQ(row.size(), kRangeClasses) << key;
  }
  EXPECT_TRUE(metrics()["map"]["hazards"].is_null()) << "this world's ground is unknown";
  EXPECT_TRUE(metrics()["map"]["traversability"].is_null());
}

TEST_F(ReportTest, CamerasAreWhereTheRunsConfigurationPutsThem) {
  const std::string dir = folder_->file("cameras");
  fs::copy(dir_, dir);
  fs::create_directories(dir + "/config");
  fs::copy(std::string(kConfig) + "/vehicle.yaml", dir + "/config");
  std::string cameras = read_file(std::string(kConfig) + "/cameras.yaml");
  const std::string mount = "left_in_body: {position_m: [";
  cameras.replace(cameras.find(mount), mount.size() + 5, mount + "0.611");
  cameras.erase(cameras.find("navcam:"));
  write_file(dir + "/config/cameras.yaml", cameras);
  const Footprint footprint = open_run_folder(dir, kConfig).footprint;
  EXPECT_NEAR(footprint.loccam_x_m, 0.611, 1e-9);
  EXPECT_NEAR(footprint.navcam_x_m, Footprint{}.navcam_x_m, 1e-9) << "a vehicle without one";
}

TEST_F(ReportTest, PageIsSelfContained) {
  const std::string html = read_file(dir_ + "/report.html");
  // The only URLs are SVG namespaces.
  for (size_t at = html.find("http"); at != std::string::npos; at = html.find("http", at + 1))
    EXPECT_EQ(html.compare(at, 18, "http://www.w3.org/"), 0) << html.substr(at, 60);
  EXPECT_EQ(html.find("src="), std::string::npos);
  EXPECT_EQ(html.find("<script"), std::string::npos);
  EXPECT_NE(html.find("Goal reached"), std::string::npos);
  EXPECT_NE(html.find("Drive currents"), std::string::npos);
  EXPECT_NE(html.find("Where the time went"), std::string::npos);
  EXPECT_EQ(html.find("nan"), std::string::npos);
}

TEST_F(ReportTest, TheMapsLayersCanBeSwitched) {
  const std::string html = read_file(dir_ + "/report.html");
  for (const MapLayerInfo& layer : kMapLayers) {
    const std::string id = layer.id;
    EXPECT_NE(html.find("<input type=\"checkbox\" id=\"show-" + id + "\""), std::string::npos) << id;
    EXPECT_NE(html.find("#show-" + id + ":not(:checked)~.maps .layer-" + id + "{display:none}"), std::string::npos)
        << id;
  }
  for (const char* id : {"rocks", "hazards", "paths", "tracks", "events"})
    EXPECT_NE(html.find("<g class=\"layer-" + std::string(id) + "\">"), std::string::npos) << id;
}

TEST_F(ReportTest, EventsAreListed) {
  const std::string html = read_file(dir_ + "/report.html");
  EXPECT_NE(html.find("<h2>Events</h2>"), std::string::npos);
  EXPECT_NE(html.find("<td>GOAL_REACHED"), std::string::npos);
}

TEST_F(ReportTest, ThePictureDecodes) {
  const cv::Mat picture = cv::imread(dir_ + "/traverse.png");
  EXPECT_EQ(picture.cols, 1400);
  EXPECT_GT(picture.rows, 400);
  EXPECT_EQ(read_file(dir_ + "/traverse.svg").rfind("<?xml", 0), 0u);
}

TEST_F(ReportTest, RepeatedReportIsIdentical) {
  const std::string html = read_file(dir_ + "/report.html");
  const std::string figures = read_file(dir_ + "/metrics.json");
  write_report(study());
  EXPECT_EQ(read_file(dir_ + "/report.html"), html);
  EXPECT_EQ(read_file(dir_ + "/metrics.json"), figures);
}

TEST_F(ReportTest, RockMetricsAreNullWithoutWorld) {
  const std::string other = folder_->file("real");
  fs::create_directories(other);
  fs::copy_file(dir_ + "/traverse.lcm", other + "/traverse.lcm");
  make_report(other, kConfig);
  const nlohmann::json m = nlohmann::json::parse(read_file(other + "/metrics.json"));
  EXPECT_TRUE(m["rocks_missed"].is_null());
  EXPECT_TRUE(m["false_stops"].is_null());
  EXPECT_TRUE(m["seed"].is_null());
  EXPECT_TRUE(m["deterministic"].is_null());
  EXPECT_EQ(m["outcome"], "goal_reached");
}

// Log of a real vehicle: no TRUTH.
void copy_without_truth(const std::string& from, const std::string& to) {
  lcm::LogFile in(from, "r");
  lcm::LogFile out(to, "w");
  ASSERT_TRUE(in.good() && out.good());
  while (const lcm::LogEvent* event = in.readNextEvent()) {
    if (event->channel == "TRUTH") continue;
    lcm::LogEvent copy = *event;
    out.writeEvent(&copy);
  }
}

TEST_F(ReportTest, WithoutTruthReportUsesEstimate) {
  const std::string other = folder_->file("no_truth");
  fs::create_directories(other);
  copy_without_truth(dir_ + "/traverse.lcm", other + "/traverse.lcm");
  EXPECT_THAT(make_report(other, kConfig), testing::HasSubstr("no ground truth"));
  const nlohmann::json m = nlohmann::json::parse(read_file(other + "/metrics.json"));
  EXPECT_EQ(m["truth"], false);
  EXPECT_EQ(m["outcome"], "goal_reached");
  const double driven_m = metrics()["driven_length_m"];
  EXPECT_NEAR(m["driven_length_m"].get<double>(), driven_m, 0.01 * driven_m);
  EXPECT_EQ(m["replans"], metrics()["replans"]);
  for (const char* key : {"collisions", "odometry_drift_percent", "final_error_m", "truth_deviation_max_m",
                          "final_truth_pose", "motion_without_lease_s", "mean_slip"})
    EXPECT_TRUE(m[key].is_null()) << key;
  for (const char* source : {"visual_odometry", "published_pose"})
    for (const char* key : {"end_error_m", "end_error_percent", "ate_rmse_m"})
      EXPECT_TRUE(m["trajectory"][source][key].is_null()) << source << ' ' << key;
  EXPECT_THAT(read_file(other + "/report.html"), testing::HasSubstr("no ground truth"));
  EXPECT_THAT(read_file(other + "/report.html"), testing::Not(testing::HasSubstr("true track")));
  EXPECT_THAT(read_file(other + "/report.html"), testing::Not(testing::HasSubstr("Odometry drift [m]")));
  EXPECT_THAT(read_file(dir_ + "/report.html"), testing::HasSubstr("Odometry drift [m]"));
  EXPECT_EQ(metrics()["truth"], true);
}

TEST_F(ReportTest, TruncatedLogLosesOnlyItsEnd) {
  const std::string cut = folder_->file("cut.lcm");
  const auto whole = read_log(choose_run(dir_ + "/traverse.lcm"));
  for (const std::uintmax_t missing : {1u, 7u, 30u, 333u, 100'000u}) {
    fs::copy_file(dir_ + "/traverse.lcm", cut, fs::copy_options::overwrite_existing);
    fs::resize_file(cut, fs::file_size(cut) - missing);
    testing::internal::CaptureStderr();
    const LogRun log = choose_run(cut);
    print_remarks(log);
    const RunRecord run = read_log(log);
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_EQ(said.rfind(cut + ": truncated", 0), 0u) << said;
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
    EXPECT_LE(run.truth.size(), whole.truth.size());
    EXPECT_GT(run.truth.size(), whole.truth.size() - 400);
    EXPECT_EQ(run.bus.damaged_events, 1);
  }
  EXPECT_EQ(whole.bus.damaged_events, 0);
}

TEST_F(ReportTest, EvaluatesSelectedRunOfLog) {
  const testing_support::TempFolder folder;
  const std::string other = folder.file("two");
  fs::create_directories(other);
  // Each run followed by a TICK.
  std::ofstream both(other + "/traverse.lcm", std::ios::binary);
  for (const Utime end : {Utime{600'000'000}, Utime{599'980'000}}) {
    const std::string ticks = folder.file("ticks.lcm");
    { MessageLog(ticks).put(channel::kTick, tick_t{}, end, "rover_simulator"); }
    both << read_file(dir_ + "/traverse.lcm") << read_file(ticks);
  }
  both.close();
  std::string said;
  try {
    make_report(other, kConfig);
  } catch (const ConfigError& error) {
    said = folder.short_names(error.what());
  }
  EXPECT_THAT(said, testing::HasSubstr("two/traverse.lcm: contains 2 runs, message time 1: "));
  wild_row("Logs", "report of two runs in one file", "one drive of both, whose times fall", said);
  testing::internal::CaptureStderr();
  make_report(other, kConfig, 2);
  EXPECT_THAT(testing::internal::GetCapturedStderr(), testing::HasSubstr("run 2 of 2"));
  EXPECT_EQ(nlohmann::json::parse(read_file(other + "/metrics.json"))["driven_length_m"], metrics()["driven_length_m"]);
}

TEST_F(ReportTest, DamagedRecordsAreCountedAndSkipped) {
  const std::string file = folder_->file("damaged.lcm");
  {
    MessageLog log(file);
    log.put(channel::kTruth, truth_t{}, 0, "rover_simulator");
    log.put(channel::kTruth, slip_t{}, 20'000, "rover_simulator");  // foreign fingerprint
    log.put_bytes(channel::kTruth, {1, 2, 3}, 40'000);
    log.put_bytes("SOMETHING_ELSE", std::vector<std::uint8_t>(200, 0xff), 50'000);
    log.put(channel::kTruth, truth_t{}, 60'000, "rover_simulator");
  }
  const RunRecord run = read_log(choose_run(file));
  EXPECT_EQ(run.truth.size(), 2u);
  EXPECT_GE(run.bus.damaged_events, 2);
}

TEST_F(ReportTest, MessagesLeftOutOfAReducedLogStillCount) {
  const std::string file = folder_->file("reduced.lcm");
  {
    MessageLog log(file);
    for (int i = 0; i < 9; ++i) log.leave_out("SLIP", "localization");
    log.put("SLIP", slip_t{}, 180'000, "localization");
    log.put("POSE", slip_t{}, 180'000, "localization");
  }
  const BusRecord bus = read_log(choose_run(file)).bus;
  EXPECT_EQ(bus.messages, 11);
  slip_t message{};
  message.header.publisher = "localization";
  EXPECT_EQ(bus.bytes, 11 * message.getEncodedSize());
}

TEST_F(ReportTest, TimeThatTheLogLacksIsStated) {
  const std::string file = folder_->file("full_disk.lcm");
  {
    MessageLog log(file);
    for (const Utime t : {1'000'000, 1'020'000, 81'020'000, 81'040'000})
      log.put("TICK", tick_t{}, t, "rover_simulator");
  }
  EXPECT_DOUBLE_EQ(read_log(choose_run(file)).bus.missing_s, 80.0);
}

TEST_F(ReportTest, TimeThatTheLogLacksAtItsEndIsStated) {
  const std::string file = folder_->file("full_disk_at_the_end.lcm");
  {
    MessageLog log(file);
    for (const Utime t : {1'000'000, 1'020'000, 1'040'000}) log.put("TICK", tick_t{}, t, "rover_simulator");
  }
  EXPECT_DOUBLE_EQ(read_log(choose_run(file), 90.06).bus.missing_s, 90.02);
  EXPECT_DOUBLE_EQ(read_log(choose_run(file), 0.06).bus.missing_s, 0.0);
  Study cut = study();
  cut.run.bus.missing_end_s = 90.02;
  cut.evaluation = evaluate(cut.run, cut.folder.info, cut.folder.footprint, cut.world);
  EXPECT_THAT(report_html(cut.scene(), {}, {}), testing::HasSubstr("The log ends 90.0 s before the run"));
}

TEST_F(ReportTest, MessagesAreCountedFromTheFirstTickOn) {
  const std::string file = folder_->file("monotonic.lcm");
  constexpr Utime kStart = 5'000'000'000;
  {
    MessageLog log(file);
    for (Utime t = kStart; t < kStart + 4'000'000; t += 1'000'000) log.put("TICK", tick_t{}, t, "driver");
  }
  EXPECT_EQ(read_log(choose_run(file), 3.0).bus.messages, 2) << "without the last ones";
  EXPECT_EQ(read_log(choose_run(file)).bus.messages, 4);
}

TEST_F(ReportTest, RefusedPathsAreNotFollowed) {
  const std::string file = folder_->file("refused.lcm");
  {
    MessageLog log(file);
    for (const std::int64_t id : {4, 5, 6}) {
      path_t path{};
      path.path_id = id;
      log.put(channel::kGlobalPath, path, id * kTickUs, "mission_control");
      command_ack_t ack{};
      ack.command_id = id;
      ack.accepted = id == 4;
      if (id < 6) log.put(channel::kCommandAck, ack, (id + 1) * kTickUs, "path_planner");
    }
    command_ack_t of_another{};
    of_another.command_id = 4;
    log.put(channel::kCommandAck, of_another, 10 * kTickUs, "supervisor");
  }
  const std::vector<PathRecord> paths = read_log(choose_run(file)).global_paths;
  ASSERT_EQ(paths.size(), 1u) << "one was refused, one never arrived";
  EXPECT_EQ(paths[0].id, 4);
}

TEST_F(ReportTest, ThePageSaysWhyTwoPathsHaveNoRatio) {
  Study changed = study();
  PathRecord drawn = changed.run.global_paths.front();
  drawn.t_s = 20.0;
  drawn.points = {{13.0, 10.0}, {20.0, 15.0}};
  changed.run.global_paths.push_back(drawn);
  changed.world->ground_m = [](double, double) { return 0.0; };
  changed.evaluation = evaluate(changed.run, changed.folder.info, changed.folder.footprint, changed.world);
  evaluate_oracle(changed.run, changed.folder.vehicle, changed.world, changed.evaluation);
  const nlohmann::json m = metrics_json(changed.evaluation.metrics);
  for (const char* key : {"planned_length_m", "path_ratio", "progress", "oracle_m", "oracle_feasible", "regret"})
    EXPECT_TRUE(m[key].is_null()) << key;
  EXPECT_THAT(report_html(changed.scene(), {}, {}), testing::HasSubstr("The rover followed 2 paths"));
  EXPECT_THAT(read_file(dir_ + "/report.html"), testing::Not(testing::HasSubstr("The rover followed")));
}

TEST_F(ReportTest, AZoneDrawnOverTheStartHasNoOracle) {
  Study changed = study();
  changed.world->ground_m = [](double, double) { return 0.0; };
  changed.evaluation.metrics.paths.front().zones = {
      {"start", false, {{9.0, 9.0}, {11.0, 9.0}, {11.0, 11.0}, {9.0, 11.0}}}};
  evaluate_oracle(changed.run, changed.folder.vehicle, changed.world, changed.evaluation);
  EXPECT_TRUE(metrics_json(changed.evaluation.metrics)["oracle_feasible"].is_null());
}

TEST(RunFolder, EachFaultIsOneLineThatNamesTheFile) {
  const auto message = [](const std::string& dir) -> std::string {
    try {
      make_report(dir, kConfig);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(message("/nowhere"), "/nowhere: no such folder");
  const testing_support::TempFolder folder;
  const std::string dir = folder.file("faulty_run");
  fs::create_directories(dir);
  EXPECT_EQ(message(dir), dir + "/traverse.lcm: no such log");
  std::ofstream(dir + "/traverse.lcm") << "";
  EXPECT_EQ(message(dir), dir + "/traverse.lcm: is empty");
  std::ofstream(dir + "/run.json") << "{\"seed\": ";
  EXPECT_EQ(message(dir).rfind(dir + "/run.json: ", 0), 0u);
  std::ofstream(dir + "/run.json") << "{\"seed\": \"three\"}";
  EXPECT_EQ(message(dir).rfind(dir + "/run.json: ", 0), 0u);
}

TEST(MetricsJson, TheFinalPoseReadsBackDigitByDigit) {
  Metrics m;
  m.final_truth_pose = make_pose(rotation_from_rpy(0.1, 0.2, 0.3), {1.0 / 3.0, 1e-17, 123456.789012345678});
  const auto json = nlohmann::json::parse(metrics_json(m).dump());
  EXPECT_EQ(json["final_truth_pose"]["x_m"].get<double>(), 1.0 / 3.0);
  EXPECT_EQ(json["final_truth_pose"]["y_m"].get<double>(), 1e-17);
  EXPECT_EQ(json["final_truth_pose"]["z_m"].get<double>(), 123456.789012345678);
}

}  // namespace
}  // namespace rover::report
