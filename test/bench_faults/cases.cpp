#include "test/bench_faults/cases.hpp"

#include <algorithm>
#include <cmath>

namespace rover::bench_faults {
namespace {

using enum Phase;
using Who = const std::string&;

const std::vector<Phase> kEver = {kStraight, kPointTurn, kHazardStop, kRepair, kStandstill};
const std::vector<Phase> kUnderWay = {kStraight, kPointTurn, kHazardStop, kRepair};
// There planning is continuous: no path is a repair.
const std::vector<Phase> kUnderWayAtFull = {kStraight, kPointTurn, kHazardStop};
const std::vector<Phase> kRolling = {kStraight, kPointTurn, kRepair};
// Sideways is off the path.
const std::vector<Phase> kAlongPath = {kStraight, kHazardStop, kRepair};
const std::vector<std::string> kDrives = {"FL", "FR", "ML", "MR", "RL", "RR"};
const std::vector<std::string> kSteers = {"FL", "FR", "RL", "RR"};
const std::vector<std::string> kServices = {"stereo",       "visual_odometry",    "localization", "hazard_detector",
                                            "path_planner", "trajectory_control", "locomotion"};
const std::vector<std::string> kOptional = {"recorder", "mission_control", "global_localization"};
const std::vector<std::string> kFull = {"point_cloud", "pan_tilt", "slam", "traversability"};
constexpr double kQuickRestartS = 0.2;  // restart delay of s6

size_t index_of(const std::vector<std::string>& names, Who who) {
  return static_cast<size_t>(std::find(names.begin(), names.end(), who) - names.begin());
}

// ---- fault injection on one channel or field

Cause tap(const std::string& fault, const std::string& target, double amount, double for_s) {
  return {fault + " " + target, for_s, [=](Hands& h, Who, int) { h.tap(fault, target, amount, for_s); }, nullptr,
          nullptr};
}
Cause drop(const std::string& channel, double for_s) {
  return tap("drop", channel, 1.0, for_s);
}
Cause nan(const std::string& field, double for_s) {
  return tap("nan", field, 1.0, for_s);
}

// On the streams of every tick, which are most messages. Fewer of IMU and wheels, because ten consecutive losses are a
// separate fault.
Cause losing(double sensors, double decisions, double for_s) {
  return {"messages lost", for_s,
          [=](Hands& h, Who, int) {
            for (const char* channel : {"IMU", "WHEEL_STATE"}) h.tap("drop", channel, sensors, for_s);
            for (const char* channel : {"POSE", "PLANNER_STATUS", "CONTROL_STATUS", "MOTION_COMMAND", "DRIVE_PERMIT"})
              h.tap("drop", channel, decisions, for_s);
          },
          nullptr, nullptr};
}

// Cross track error, with a larger predicted one.
Cause straying() {
  return {"cross track error of the controller", 0.3,
          [](Hands& h, Who, int) {
            h.tap("offset", "CONTROL_STATUS.cross_track_m", 0.5, 0.3);
            h.tap("offset", "CONTROL_STATUS.predicted_corridor_error_m", 1.0, 0.3);
          },
          nullptr, nullptr};
}

// ---- causes in the vehicle, its sensors and the ground

Cause broken(const std::string& text, double longest_s, std::function<void(Broken&, Who, int turn)> change) {
  return {text, longest_s, [change](Hands& h, Who who, int turn) { change(h.rover.broken, who, turn); },
          [](Hands& h, Who) { h.rover.broken = {}; }, nullptr};
}
Cause drive_current(double current_a, double longest_s) {
  return broken("high friction of a wheel", longest_s,
                [=](Broken& b, Who who, int) { b.drive_a[index_of(kDrives, who)] = current_a; });
}
Cause steer_current(double current_a, double longest_s) {
  return broken("stuck steering", longest_s,
                [=](Broken& b, Who who, int) { b.steer_a[index_of(kSteers, who)] = current_a; });
}
// Thermal overload without exceeding the current limit for a second.
Cause steer_pulses() {
  Cause cause = steer_current(3.0, 6.0);
  cause.text = "repeated steering overload";
  cause.go_on = [](Hands& h, Who who, double age_s) {
    h.rover.broken.steer_a[index_of(kSteers, who)] = std::fmod(age_s, 0.9) < 0.8 ? 3.0 : 0.3;
  };
  return cause;
}
Cause roll(double deg) {
  return broken("lateral tilt of the ground", 6.0,
                [=](Broken& b, Who, int turn) { b.roll_rad = to_rad(turn % 2 == 0 ? deg : -deg); });
}
Cause pitch(double deg) {
  return broken("longitudinal tilt of the ground", 6.0,
                [=](Broken& b, Who, int turn) { b.pitch_rad = to_rad(turn % 2 == 0 ? deg : -deg); });
}
Cause jolt() {
  Cause cause = roll(12.0);
  cause.text = "a jolt";
  cause.begin = [](Hands& h, Who, int turn) {
    h.rover.broken.roll_rad = to_rad(turn % 2 == 0 ? 12.0 : -12.0);
    h.rover.broken.tilt_radps = to_rad(50.0);
  };
  return cause;
}
Cause slip(double ratio) {
  return broken("loose ground", 9.0, [=](Broken& b, Who, int) { b.slip_ratio = ratio; });
}
Cause shove() {
  return broken("lateral slide", 1.2, [](Broken& b, Who, int turn) { b.shove_mps = turn % 2 == 0 ? 1.2 : -1.2; });
}
// The driver accepts commands but does not move the wheels.
Cause unresponsive_driver() {
  return broken("driver does not move the wheels", 33.0, [](Broken& b, Who, int) { b.stands = true; });
}
// The wheels continue to turn after a stop command.
Cause runaway() {
  return {"driver does not stop", 6.0,
          [](Hands& h, Who, int) {
            h.rover.broken.runaway_mps = 0.06;
            h.ground.wish(Wish::kStand);
            h.ground.command(ground_command_t::STOP);
          },
          [](Hands& h, Who) { h.rover.broken = {}; }, nullptr};
}

// ---- causes in the cameras

Cause pictures(const std::string& text, std::function<double(int)> share) {
  return {text, 3.0,
          [share](Hands& h, Who, int) {
            h.blindness.share = share;
            h.blindness.pictures = 0;
          },
          [](Hands& h, Who) { h.blindness.share = nullptr; }, nullptr};
}
Cause knock() {
  return {"cameras moved", 1.0, [](Hands& h, Who, int) { h.blindness.displaced = true; },
          [](Hands& h, Who) { h.blindness.displaced = false; }, nullptr};
}

Cause visual_lost(double longest_s) {
  return {"no features", longest_s, [](Hands& h, Who, int) { h.blindness.visual_lost = true; },
          [](Hands& h, Who) { h.blindness.visual_lost = false; }, nullptr};
}

Cause slam_lost(double longest_s) {
  return {"SLAM lost", longest_s, [](Hands& h, Who, int) { h.blindness.slam_lost = true; },
          [](Hands& h, Who) { h.blindness.slam_lost = false; }, nullptr};
}

// ---- causes in services

Cause hang(double longest_s) {
  return {"hang", longest_s, [](Hands& h, Who who, int) { h.stack.hang(who, true); },
          [](Hands& h, Who who) { h.stack.hang(who, false); }, nullptr};
}
// From then on the path requires the Full level.
Cause hang_until_needed() {
  return {"hang, persistent after kills, before a segment of the Full level", 12.0,
          [](Hands& h, Who who, int) {
            h.stack.hang(who, true);
            h.stack.set_stuck(who, true);
          },
          [](Hands& h, Who who) {
            h.stack.set_stuck(who, false);
            h.stack.hang(who, false);
          },
          [](Hands& h, Who, double age_s) {
            if (std::abs(age_s - 2.0) < 0.5 * to_seconds(kTickUs)) h.ground.command(ground_command_t::FORCE_LEVEL);
          }};
}
Cause reports(std::int8_t status, bool for_good) {
  return {for_good ? "reports a fault, persistent after kills" : "reports a fault", for_good ? 20.0 : 2.0,
          [=](Hands& h, Who who, int) {
            h.stack.set_status(who, status);
            h.stack.set_stuck(who, for_good);
          },
          [](Hands& h, Who who) {
            h.stack.set_stuck(who, false);
            h.stack.set_status(who, heartbeat_t::OK);
          },
          nullptr};
}
// Exits right after its first heartbeat.
Cause restart_loop() {
  return {"restart loop", 6.0, [](Hands&, Who, int) {}, nullptr,
          [](Hands& h, Who who, double age_s) {
            const bool beat_sent = h.now % 400'000 == 40'000;  // heartbeats come every 0.2 s
            if (beat_sent && age_s < 4.0 && h.stack.runs(who)) h.stack.kill(who, kQuickRestartS);
          }};
}

// ---- causes that need the operator

// A path that the controller does not receive.
Cause lost_path() {
  return {"the new path is lost", 2.5,
          [](Hands& h, Who, int) {
            h.tap("drop", "PATH", 1.0, 2.5);
            h.ground.give_path();
          },
          nullptr, nullptr};
}
// The path is clear, so that the planner finds one, but is reported as blocked.
Cause looks_blocked() {
  Cause cause = nan("PLANNER_STATUS.blocked_in_m", 63.0);
  cause.begin = [](Hands& h, Who, int) {
    h.ground.clear_path();
    h.tap("nan", "PLANNER_STATUS.blocked_in_m", 1.0, 63.0);
  };
  return cause;
}
Cause zone_under_the_front() {
  return {"a zone under the front", 4.0, [](Hands& h, Who, int) { h.ground.give_path(true); },
          [](Hands& h, Who) { h.ground.give_path(); }, nullptr};
}
Cause enclosed() {
  return {"enclosed by rocks", 240.0, [](Hands& h, Who, int) { h.ground.enclose(); },
          [](Hands& h, Who) {
            h.ground.forget_path();
            h.ground.command(ground_command_t::STOP);
          },
          nullptr};
}
// Six stops in immediate succession.
Cause many_stops() {
  return {"successive faults", 16.0, [](Hands&, Who, int) {}, nullptr,
          [](Hands& h, Who, double age_s) {
            if (std::fmod(age_s + 1e-3, 1.8) < 0.02) h.tap("nan", "POSE.velocity_body_mps", 1.0, 0.1);
          }};
}
Cause clock_step() {
  return {"the clock jumps", 0.5, [](Hands& h, Who, int) { h.clock_step = 800'000; }, nullptr, nullptr};
}

std::vector<Case> of_sensors_and_motors() {
  return {
      {"clock_step", {}, kEver, {clock_step()}},
      {"imu_age", {}, kEver, {drop("IMU", 0.5), tap("delay", "IMU", 0.5, 0.5)}},
      {"imu_fault",
       {},
       kEver,
       {broken("IMU reports a fault", 0.5, [](Broken& b, Who, int) { b.imu_fault = true; }),
        nan("IMU.delta_angle_rad", 0.2), nan("IMU.fog_delta_yaw_rad", 0.2)}},
      {"wheel_state_age", {}, kEver, {drop("WHEEL_STATE", 0.5), tap("delay", "WHEEL_STATE", 0.5, 0.5)}},
      {"wheel_fault",
       {},
       kEver,
       {broken("driver reports a fault", 0.5, [](Broken& b, Who, int) { b.wheel_fault = true; }),
        nan("WHEEL_STATE.drive_current_a", 0.2), nan("WHEEL_STATE.steer_current_a", 0.2)}},
      {"drive_current", kDrives, kUnderWay, {drive_current(11.0, 1.0)}},
      {"drive_heat_high", kDrives, kUnderWay, {drive_current(9.9, 10.0)}},
      {"drive_heat", kDrives, kUnderWay, {drive_current(9.9, 12.0)}},
      {"steer_current", kSteers, kUnderWay, {steer_current(0.95, 15.0)}},
      {"steer_heat", kSteers, kUnderWay, {steer_pulses()}},
  };
}

std::vector<Case> of_pose() {
  return {
      {"pose_age", {}, kEver, {drop("POSE", 0.6), tap("delay", "POSE", 0.6, 0.6)}},
      {"pose_status", {}, kEver, {nan("POSE.position_odom_body_m", 0.2), nan("POSE.velocity_body_mps", 0.2)}},
      {"pose_sigma_high", {}, kEver, {tap("offset", "POSE.covariance", 4.0, 0.4)}},
      {"pose_sigma", {}, kUnderWay, {tap("offset", "POSE.covariance", 16.0, 0.4), nan("POSE.covariance", 0.4)}},
      {"vo_age_high", {}, kEver, {drop("VO", 2.6), visual_lost(3.0)}},
      {"vo_age", {}, kUnderWay, {drop("VO", 6.8), visual_lost(7.0)}},
      {"roll_high", {}, kUnderWay, {roll(16.0)}},
      {"roll_steep", {}, kUnderWay, {roll(18.5)}},
      {"roll", {}, kEver, {roll(24.0)}},
      {"pitch_high", {}, kUnderWay, {pitch(30.0)}},
      {"pitch", {}, kEver, {pitch(40.0)}},
      {"tilt_rate", {}, kEver, {jolt()}},
      {"slip_high", {}, kRolling, {slip(0.72)}},
      {"slip", {}, kRolling, {slip(0.97)}},
  };
}

std::vector<Case> of_seeing_and_following() {
  return {
      {"hazards_age", {}, kEver, {drop("HAZARDS", 1.8), drop("DISPARITY", 1.8)}},
      {"hazards_blind", {}, kEver, {pictures("few valid pixels", [](int) { return 0.3; })}},
      {"stereo_coverage_low",
       {},
       kUnderWay,
       {pictures("two images with few valid pixels", [](int n) { return n < 2 ? 0.3 : 1.0; })}},
      {"loccam_displaced", {}, kEver, {knock()}},
      {"stereo_coverage", {}, kEver, {pictures("flickering images", [](int n) { return n == 2 ? 1.0 : 0.1; })}},
      {"planner_age", {}, kEver, {drop("PLANNER_STATUS", 0.6), tap("delay", "PLANNER_STATUS", 0.6, 0.6)}},
      {"control_age", {}, kEver, {drop("CONTROL_STATUS", 0.6), tap("delay", "CONTROL_STATUS", 0.6, 0.6)}},
      {"command_age", {}, kEver, {drop("MOTION_COMMAND", 0.6), tap("delay", "MOTION_COMMAND", 0.6, 0.6)}},
      {"corridor_predicted", {}, kUnderWay, {nan("CONTROL_STATUS.predicted_corridor_error_m", 0.3), straying()}},
      {"out_of_corridor", {}, kAlongPath, {shove()}},
      {"path_mismatch", {}, kUnderWay, {lost_path()}},
      {"no_path", {}, kUnderWay, {enclosed()}},
      {"blocked", {}, kUnderWay, {looks_blocked()}},
      {"keep_out", {}, kUnderWay, {zone_under_the_front()}},
      {"idle_drive", {}, kRolling, {unresponsive_driver()}},
  };
}

// In the order of the table; at the Full level except for the rows of idle services.
std::vector<Case> of_the_full_level() {
  return {
      {"loccam_out", {}, kUnderWay, {drop("HAZARDS", 1.8), drop("DISPARITY", 1.8)}, true},
      {"terrain_distance", {}, kRolling, {drop("TRAVERSABILITY", 25.0)}, true},
      {"sweep_timeout", {}, kRolling, {drop("TRAVERSABILITY", 100.0)}, true},
      {"slam_lost", {}, kUnderWay, {slam_lost(8.0)}, true},
      {"full_heartbeat", kFull, kUnderWayAtFull, {hang(2.0)}, true},
      {"full_idle_heartbeat", kFull, kEver, {hang(2.0)}},
      {"full_missing", kFull, kUnderWay, {hang_until_needed()}},
      {"full_service_fault", kFull, kUnderWayAtFull, {reports(heartbeat_t::FAULT, false)}, true},
      {"full_starts", kFull, kUnderWayAtFull, {restart_loop()}, true},
      {"full_restart_failed", kFull, kUnderWayAtFull, {reports(heartbeat_t::FAULT, true)}, true},
  };
}

std::vector<Case> of_services() {
  return {
      {"heartbeat_late", kServices, kEver, {hang(1.0)}},
      {"heartbeat", kServices, kEver, {hang(2.0)}},
      {"service_fault", kServices, kEver, {reports(heartbeat_t::FAULT, false)}},
      {"starts", kServices, kEver, {restart_loop()}},
      {"restart_failed", kServices, kEver, {reports(heartbeat_t::FAULT, true)}},
      {"optional_heartbeat", kOptional, kEver, {hang(6.0)}},
      {"log_disk",
       {},
       kEver,
       {{"disk full", 1.0, [](Hands& h, Who, int) { h.stack.set_status("recorder", heartbeat_t::DEGRADED); },
         [](Hands& h, Who) { h.stack.set_status("recorder", heartbeat_t::OK); }, nullptr}}},
      {"message_loss_high", {}, kEver, {losing(0.1, 0.1, 2.0)}},
      {"message_loss", {}, kUnderWay, {losing(0.35, 0.5, 4.5)}},
      {"unpermitted_motion", {}, kEver, {runaway()}},
      {"fault_stops", {}, kUnderWay, {many_stops()}},
  };
}

}  // namespace

std::vector<Case> all_cases() {
  std::vector<Case> all = of_sensors_and_motors();
  for (auto* part : {&of_pose, &of_seeing_and_following, &of_the_full_level, &of_services}) {
    std::vector<Case> more = part();
    std::move(more.begin(), more.end(), std::back_inserter(all));
  }
  return all;
}

}  // namespace rover::bench_faults
