// Every row of config/fdir.yaml: raised by its cause and cleared afterwards, also with duplicated and reordered
// messages, NaN and silence, and for pairs of faults cleared in either order.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>

#include "common/bus/convert.hpp"
#include "common/bus/zone_list.hpp"
#include "test/supervisor/rows_rig.hpp"

namespace rover::supervisor {
namespace {

using Change = std::function<void(RowsRig&)>;

struct RowCase {
  std::string line;  // id in fdir.yaml
  std::string row;   // expanded id for one motor or service; empty: same as line
  Change inject;
  Change recover;
  double within_s = 2.0;  // time limit to raise
  double cleared_s = 4.0;
  bool full = false;            // at the Full level
  std::string cleared_by = {};  // "fault", "safe": needs CLEAR_FAULT, CLEAR_SAFE
};

// Name in test messages.
void PrintTo(const RowCase& c, std::ostream* out) {
  *out << c.line;
}

Change set_silent(const std::string& channel) {
  return [channel](RowsRig& rig) { rig.silent.insert(channel); };
}
Change clear_silent(const std::string& channel) {
  return [channel](RowsRig& rig) { rig.silent.erase(channel); };
}
RowCase silence(const std::string& line, const std::string& channel, double within_s = 2.0) {
  return {line, "", set_silent(channel), clear_silent(channel), within_s};
}
void attitude(RowsRig& rig, double roll_deg, double pitch_deg) {
  pose_to(make_pose(rotation_from_rpy(to_rad(roll_deg), to_rad(pitch_deg), 0.0), Eigen::Vector3d::Zero()),
          rig.pose.position_odom_body_m, rig.pose.quat_odom_body_wxyz);
}
RowCase tilted(const std::string& line, double roll_deg, double pitch_deg) {
  return {line, "", [=](RowsRig& rig) { attitude(rig, roll_deg, pitch_deg); },
          [](RowsRig& rig) { attitude(rig, 0, 0); }};
}
RowCase drive_motor(const std::string& line, double current_a, double within_s, double cleared_s) {
  return {line,
          line + ".ML",
          [=](RowsRig& rig) { rig.wheels.drive_current_a[2] = current_a; },
          [](RowsRig& rig) { rig.wheels.drive_current_a[2] = 0.0; },
          within_s,
          cleared_s};
}
RowCase steer_motor(const std::string& line, double current_a, double within_s, double cleared_s) {
  return {line,
          line + ".RR",
          [=](RowsRig& rig) { rig.wheels.steer_current_a[3] = current_a; },
          [](RowsRig& rig) { rig.wheels.steer_current_a[3] = 0.0; },
          within_s,
          cleared_s};
}
RowCase slipping(const std::string& line, double ratio) {
  return {line, "", [=](RowsRig& rig) { rig.slip.slip_ratio = ratio; }, [](RowsRig& rig) { rig.slip.slip_ratio = 0.0; },
          3.0,  6.0};
}
RowCase covariance(const std::string& line, double sigma_m) {
  return {line, "", [=](RowsRig& rig) { rig.pose.covariance[0] = sigma_m * sigma_m; },
          [](RowsRig& rig) { rig.pose.covariance[0] = 0.0; }};
}
RowCase coverage(const std::string& line, float fraction) {
  return {line, "", [=](RowsRig& rig) { rig.hazards.coverage = fraction; },
          [](RowsRig& rig) { rig.hazards.coverage = 0.9f; }, 3.0};
}
RowCase silent_service(const std::string& line, const std::string& service, double within_s) {
  return {line, line + "." + service, [=](RowsRig& rig) { rig.services[service].silent = true; },
          [=](RowsRig& rig) { rig.services[service].silent = false; }, within_s};
}
RowCase restarting(const std::string& line, const std::string& service) {
  return {line,
          line + "." + service,
          [=](RowsRig& rig) {
            rig.each_tick = [&rig, service, n = 0]() mutable {
              if (++n % 50 == 0) ++rig.services[service].boot_id;
            };
          },
          [](RowsRig& rig) { rig.each_tick = [] {}; },
          10.0,
          70.0,
          false,
          "safe"};
}
RowCase permanently_silent(const std::string& line, const std::string& service) {
  return {line,
          line + "." + service,
          [=](RowsRig& rig) { rig.services[service].silent = true; },
          [=](RowsRig& rig) { rig.services[service].silent = false; },
          40.0,
          70.0,
          false,
          "safe"};
}
RowCase no_odometry(const std::string& line, double within_s) {
  return {line, "", [](RowsRig& rig) { rig.odometry_alive = false; }, [](RowsRig& rig) { rig.odometry_alive = true; },
          within_s};
}
// Lost messages per service, of 100 between two heartbeats.
RowCase losing_messages(const std::string& line, std::int64_t lost) {
  return {line,
          "",
          [=](RowsRig& rig) {
            rig.each_tick = [&rig, lost, n = 0]() mutable {
              if (n++ % 10 == 0)
                for (auto& [name, service] : rig.services) service.lost += lost;
            };
          },
          [](RowsRig& rig) { rig.each_tick = [] {}; },
          8.0,
          10.0};
}

std::vector<RowCase> sensor_cases() {
  return {
      {"clock_step", "", [](RowsRig& rig) { rig.world.now += to_utime(1.0); }, [](RowsRig&) {}},
      silence("imu_age", channel::kImu),
      {"imu_fault", "", [](RowsRig& rig) { rig.imu.status = imu_t::FAULT; },
       [](RowsRig& rig) { rig.imu.status = imu_t::OK; }},
      silence("wheel_state_age", channel::kWheelState),
      {"wheel_fault", "", [](RowsRig& rig) { rig.wheels.status = wheel_state_t::FAULT; },
       [](RowsRig& rig) { rig.wheels.status = wheel_state_t::OK; }},
      drive_motor("drive_current", -10.1, 1.0, 4.0),
      drive_motor("drive_heat_high", 4.0, 200.0, 60.0),
      drive_motor("drive_heat", 5.0, 200.0, 120.0),
      steer_motor("steer_current", 0.95, 16.0, 6.0),
      steer_motor("steer_heat", 0.8, 200.0, 120.0),
  };
}

std::vector<RowCase> pose_cases() {
  return {
      silence("pose_age", channel::kPose),
      {"pose_status", "", [](RowsRig& rig) { rig.pose.status = pose_t::LOST; },
       [](RowsRig& rig) { rig.pose.status = pose_t::OK; }},
      covariance("pose_sigma_high", 2.0),
      covariance("pose_sigma", 3.1),
      no_odometry("vo_age_high", 3.0),
      no_odometry("vo_age", 8.0),
      tilted("roll_high", 16.0, 0.0),
      tilted("roll_steep", 18.0, 0.0),
      tilted("roll", -20.5, 0.0),
      tilted("pitch_high", 0.0, 26.0),
      tilted("pitch", 0.0, -35.5),
      {"tilt_rate", "", [](RowsRig& rig) { rig.pose.rate_body_radps[1] = to_rad(31.0); },
       [](RowsRig& rig) { rig.pose.rate_body_radps[1] = 0.0; }},
      slipping("slip_high", 0.7),
      slipping("slip", 0.85),
  };
}

std::vector<RowCase> perception_cases() {
  return {
      silence("hazards_age", channel::kHazards, 3.0),
      {"hazards_blind", "", [](RowsRig& rig) { rig.hazards.state = hazards_t::BLIND; },
       [](RowsRig& rig) { rig.hazards.state = hazards_t::CLEAR; }, 3.0},
      coverage("stereo_coverage_low", 0.3f),
      coverage("stereo_coverage", 0.1f),
      {"loccam_displaced", "", [](RowsRig& rig) { rig.visual.status = vo_motion_t::DISPLACED; },
       [](RowsRig& rig) { rig.visual.status = vo_motion_t::OK; }},
  };
}

// Rows of the Full level.
std::vector<RowCase> full_cases() {
  return {
      silence("loccam_out", channel::kHazards, 3.0),
      silence("terrain_distance", channel::kTraversability, 10.0),
      {"sweep_timeout", "", [](RowsRig& rig) { rig.terrain.cells = {traversability_t::UNKNOWN}; },
       [](RowsRig& rig) { rig.terrain.cells = {traversability_t::FREE}; }, 70.0, 2.0, false, "fault"},
      {"slam_lost", "", [](RowsRig& rig) { rig.slam.status = slam_pose_t::LOST; },
       [](RowsRig& rig) { rig.slam.status = slam_pose_t::OK; }, 8.0},
      silent_service("full_heartbeat", "slam", 2.0),
      {"full_service_fault", "full_service_fault.pan_tilt",
       [](RowsRig& rig) { rig.services["pan_tilt"].status = heartbeat_t::FAULT; },
       [](RowsRig& rig) { rig.services["pan_tilt"].status = heartbeat_t::OK; }},
      restarting("full_starts", "traversability"),
      permanently_silent("full_restart_failed", "point_cloud"),
  };
}

std::vector<RowCase> path_cases() {
  return {
      silence("planner_age", channel::kPlannerStatus),
      silence("control_age", channel::kControlStatus),
      silence("command_age", channel::kMotionCommand),
      {"corridor_predicted", "",
       [](RowsRig& rig) {
         rig.control.cross_track_m = 0.4;
         rig.control.predicted_corridor_error_m = 0.8;
       },
       [](RowsRig& rig) { rig.control.cross_track_m = rig.control.predicted_corridor_error_m = 0.0; }},
      {"out_of_corridor", "", [](RowsRig& rig) { rig.control.state = control_status_t::OUT_OF_CORRIDOR; },
       [](RowsRig& rig) { rig.control.state = control_status_t::FOLLOWING; }},
      {"path_mismatch", "", [](RowsRig& rig) { rig.control.path_id = 9; },
       [](RowsRig& rig) { rig.control.path_id = 3; }, 3.0},
      {"no_path", "",
       [](RowsRig& rig) {
         rig.planner.state = planner_status_t::NO_PATH;
         rig.planner.blocked_in_m = 0.1;
       },
       [](RowsRig& rig) {
         rig.planner.state = planner_status_t::FOLLOWING;
         rig.planner.blocked_in_m = kInfinity;
       },
       25.0, 2.0, false, "fault"},
      {"blocked", "", [](RowsRig& rig) { rig.planner.blocked_in_m = 0.1; },
       [](RowsRig& rig) { rig.planner.blocked_in_m = kInfinity; }, 70.0, 2.0, false, "fault"},
      {"keep_out", "",
       [](RowsRig& rig) {
         zones_to({{"dune", false, {{-1, -1}, {9, -1}, {9, 9}}}}, rig.path);
       },
       [](RowsRig& rig) { zones_to({}, rig.path); }},
      {"idle_drive", "",
       [](RowsRig& rig) {
         rig.wheels_follow = false;
         std::fill_n(rig.wheels.drive_rate_radps, 6, 0.0);
       },
       [](RowsRig& rig) { rig.wheels_follow = true; }, 35.0},
  };
}

std::vector<RowCase> service_cases() {
  return {
      silent_service("heartbeat_late", "stereo", 2.0),
      silent_service("heartbeat", "path_planner", 2.0),
      {"service_fault", "service_fault.localization",
       [](RowsRig& rig) { rig.services["localization"].status = heartbeat_t::FAULT; },
       [](RowsRig& rig) { rig.services["localization"].status = heartbeat_t::OK; }},
      silent_service("full_idle_heartbeat", "slam", 2.0),
      {"full_missing", "full_missing.slam",
       [](RowsRig& rig) {
         rig.run(15.0);  // the services of the Full level are stopped
         rig.services["slam"].silent = true;
         EXPECT_TRUE(rig.command(ground_command_t::FORCE_LEVEL, "", ground_command_t::FULL));
       },
       [](RowsRig& rig) { rig.services["slam"].silent = false; }, 8.0},
      restarting("starts", "locomotion"),
      permanently_silent("restart_failed", "stereo"),
      silent_service("optional_heartbeat", "recorder", 8.0),
      {"log_disk", "", [](RowsRig& rig) { rig.services["recorder"].status = heartbeat_t::DEGRADED; },
       [](RowsRig& rig) { rig.services["recorder"].status = heartbeat_t::OK; }},
      losing_messages("message_loss_high", 5),
      losing_messages("message_loss", 80),
      {"unpermitted_motion", "",
       [](RowsRig& rig) {
         rig.silent.insert(channel::kMotionCommand);  // stops the rover, but the wheels keep turning
         rig.wheels_follow = false;
         std::fill_n(rig.wheels.drive_rate_radps, 6, 1.6);
       },
       [](RowsRig& rig) {
         rig.silent.clear();
         rig.wheels_follow = true;
       },
       6.0, 4.0, false, "safe"},
      {"fault_stops", "",
       [](RowsRig& rig) {
         rig.each_tick = [&rig, n = 0]() mutable {
           rig.wheels.status = ++n % 200 < 100 ? wheel_state_t::FAULT : wheel_state_t::OK;
         };
       },
       [](RowsRig& rig) {
         rig.each_tick = [] {};
         rig.wheels.status = wheel_state_t::OK;
       },
       30.0, 4.0, false, "safe"},
  };
}

std::set<std::string> armed_at(const std::string& when) {
  std::set<std::string> out;
  for (const YAML::Node& row : YAML::LoadFile(ROVER_SOURCE_DIR "/config/fdir.yaml")["rows"])
    if (row["armed"] && row["armed"].as<std::string>() == when) out.insert(row["id"].as<std::string>());
  return out;
}

std::vector<RowCase> all_cases() {
  std::vector<RowCase> out;
  for (const auto& group :
       {sensor_cases(), pose_cases(), perception_cases(), path_cases(), service_cases(), full_cases()})
    out.insert(out.end(), group.begin(), group.end());
  const std::set<std::string> full = armed_at("full");
  for (RowCase& c : out) {
    if (c.row.empty()) c.row = c.line;
    c.full = full.contains(c.line);
  }
  return out;
}

// Clears latched faults by ground command.
void clear_by_ground(RowsRig& rig, const RowCase& c) {
  if (!c.cleared_by.empty()) rig.command(ground_command_t::CLEAR_FAULT, c.row);
}

void resume_drive(RowsRig& rig, const RowCase& c) {
  if (c.cleared_by != "safe") return;
  rig.run(3.0);
  EXPECT_TRUE(rig.command(ground_command_t::CLEAR_SAFE));
  EXPECT_TRUE(rig.command(ground_command_t::GO));
}

std::vector<std::string> raised_rows(const std::vector<RowChange>& changes) {
  std::vector<std::string> out;
  for (const RowChange& change : changes)
    if (change.raised) out.push_back(change.id);
  return out;
}

// Injects the cause of a row, clears it and resumes the drive. Returns the rows raised meanwhile.
std::vector<std::string> run_case(const RowCase& c, Bus bus) {
  RowsRig rig(bus);
  EXPECT_TRUE(rig.start_driving(c.full)) << "not under way";
  c.inject(rig);
  EXPECT_TRUE(rig.raised_within(c.row, c.within_s)) << "not raised";
  const std::vector<std::string> raised = raised_rows(rig.changes());
  c.recover(rig);
  clear_by_ground(rig, c);
  EXPECT_TRUE(rig.cleared_within(c.row, c.cleared_s)) << "not cleared";
  resume_drive(rig, c);
  EXPECT_TRUE(rig.permit_within(5.0)) << "does not drive on";
  return raised;
}

class FdirRows : public testing::TestWithParam<RowCase> {};

TEST_P(FdirRows, IsRaisedAndCleared) {
  EXPECT_FALSE(run_case(GetParam(), Bus::kPlain).empty());
}

TEST_P(FdirRows, DuplicatedMessagesChangeNothing) {
  EXPECT_EQ(run_case(GetParam(), Bus::kDuplicates), run_case(GetParam(), Bus::kPlain));
}

TEST_P(FdirRows, ReorderedMessagesRaiseNothingElse) {
  EXPECT_EQ(run_case(GetParam(), Bus::kOutOfOrder), run_case(GetParam(), Bus::kPlain));
}

INSTANTIATE_TEST_SUITE_P(Fdir, FdirRows, testing::ValuesIn(all_cases()),
                         [](const auto& named) { return named.param.line; });

TEST(FdirTable, HasATestCaseForEachRow) {
  std::set<std::string> lines, cases;
  for (const YAML::Node& row : YAML::LoadFile(ROVER_SOURCE_DIR "/config/fdir.yaml")["rows"])
    lines.insert(row["id"].as<std::string>());
  for (const RowCase& c : all_cases()) cases.insert(c.line);
  EXPECT_EQ(lines, cases);
}

TEST(FdirTable, HealthyInputsRaiseNothing) {
  for (const Bus bus : {Bus::kPlain, Bus::kDuplicates, Bus::kOutOfOrder}) {
    RowsRig rig(bus);
    ASSERT_TRUE(rig.start_driving(false));
    rig.run(60.0);
    EXPECT_TRUE(rig.changes().empty());
    EXPECT_TRUE(rig.permitted());
  }
}

// NaN in each monitored field.
TEST(FdirTable, NanIsAFault) {
  const std::vector<std::pair<std::string, Change>> cases = {
      {"imu_fault", [](RowsRig& rig) { rig.imu.delta_angle_rad[1] = kNaN; }},
      {"imu_fault", [](RowsRig& rig) { rig.imu.fog_delta_yaw_rad = kNaN; }},
      {"drive_current.FL", [](RowsRig& rig) { rig.wheels.drive_current_a[0] = kNaN; }},
      {"wheel_fault", [](RowsRig& rig) { rig.wheels.drive_current_a[5] = kNaN; }},
      {"wheel_fault", [](RowsRig& rig) { rig.wheels.steer_current_a[0] = kNaN; }},
      {"wheel_fault",
       [](RowsRig& rig) {
         rig.wheels_follow = false;
         rig.wheels.drive_rate_radps[3] = kNaN;
       }},
      {"pose_status", [](RowsRig& rig) { rig.pose.position_odom_body_m[0] = kNaN; }},
      {"pose_status", [](RowsRig& rig) { rig.pose.quat_map_odom_wxyz[2] = kNaN; }},
      {"pose_sigma", [](RowsRig& rig) { rig.pose.covariance[0] = kNaN; }},
      {"pose_sigma", [](RowsRig& rig) { rig.pose.covariance[7] = kNaN; }},
      {"tilt_rate", [](RowsRig& rig) { rig.pose.rate_body_radps[0] = kNaN; }},
      {"slip", [](RowsRig& rig) { rig.slip.slip_ratio = kNaN; }},
      {"hazards_blind", [](RowsRig& rig) { rig.hazards.coverage = static_cast<float>(kNaN); }},
      {"corridor_predicted", [](RowsRig& rig) { rig.control.predicted_corridor_error_m = kNaN; }},
  };
  for (const auto& [row, inject] : cases) {
    RowsRig rig;
    ASSERT_TRUE(rig.start_driving(false));
    inject(rig);
    EXPECT_TRUE(rig.raised_within(row, 5.0)) << row;
    EXPECT_FALSE(rig.permitted()) << row;
  }
}

// NaN in blocked_in_m stops like 0 m, without a fault row.
TEST(FdirTable, NanBlockDistanceStops) {
  RowsRig rig;
  ASSERT_TRUE(rig.start_driving(false));
  rig.planner.blocked_in_m = kNaN;
  rig.run(0.1);
  EXPECT_FALSE(rig.permitted());
}

// A stream that falls silent during a fault keeps the fault active.
TEST(FdirTable, SilenceDoesNotClearAFault) {
  const std::vector<std::pair<std::string, std::string>> streams = {{"imu_fault", channel::kImu},
                                                                    {"wheel_fault", channel::kWheelState},
                                                                    {"roll", channel::kPose},
                                                                    {"hazards_blind", channel::kHazards},
                                                                    {"path_mismatch", channel::kControlStatus}};
  const std::vector<RowCase> cases = all_cases();
  for (const auto& [line, channel] : streams) {
    const RowCase& c = *std::find_if(cases.begin(), cases.end(), [&](const RowCase& r) { return r.line == line; });
    RowsRig rig;
    ASSERT_TRUE(rig.start_driving(false));
    ASSERT_TRUE(rig.command(ground_command_t::FORCE_LEVEL, "", ground_command_t::EFFICIENT));
    c.inject(rig);
    ASSERT_TRUE(rig.raised_within(c.row, c.within_s));
    rig.silent.insert(channel);
    c.recover(rig);
    rig.run(5.0);
    EXPECT_TRUE(rig.is_active(c.row)) << line;
  }
}

// All pairs of independent causes, cleared in either order.
TEST(FdirTable, TwoFaultsAreIndependent) {
  const std::set<std::string> lines = {"imu_fault",       "wheel_fault",   "roll",
                                       "pose_sigma",      "drive_current", "hazards_age",
                                       "out_of_corridor", "service_fault", "path_mismatch"};
  std::vector<RowCase> cases = all_cases();
  std::erase_if(cases, [&](const RowCase& c) { return !lines.contains(c.line); });
  ASSERT_EQ(cases.size(), lines.size());
  for (const RowCase& first : cases)
    for (const RowCase& second : cases) {
      if (first.line == second.line) continue;
      SCOPED_TRACE(first.line + " then " + second.line);
      RowsRig rig;
      ASSERT_TRUE(rig.start_driving(false));
      ASSERT_TRUE(rig.command(ground_command_t::FORCE_LEVEL, "", ground_command_t::EFFICIENT));
      first.inject(rig);
      ASSERT_TRUE(rig.raised_within(first.row, first.within_s));
      EXPECT_TRUE(rig.changes().front().first);
      second.inject(rig);
      ASSERT_TRUE(rig.raised_within(second.row, 5.0));
      EXPECT_FALSE(rig.changes().back().first);
      first.recover(rig);
      ASSERT_TRUE(rig.cleared_within(first.row, first.cleared_s));
      EXPECT_TRUE(rig.is_active(second.row));
      EXPECT_FALSE(rig.permitted());
      second.recover(rig);
      ASSERT_TRUE(rig.cleared_within(second.row, second.cleared_s));
      EXPECT_TRUE(rig.permit_within(5.0));
    }
}

}  // namespace
}  // namespace rover::supervisor
