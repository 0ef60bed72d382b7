// Tests the judge with synthetic logs, each with one error, and the same without it.
#include "test/bench_faults/judge/judge.hpp"

#include <gtest/gtest.h>

#include <rover/tick_t.hpp>
#include <sstream>

#include "common/bus/channels.hpp"
#include "common/bus/streams.hpp"
#include "common/core/frames.hpp"
#include "test/bench_faults/judge/table.hpp"
#include "test/bench_faults/log.hpp"

namespace rover::bench_faults {
namespace {

Row row(const std::string& line, const std::string& quantity, double limit, const std::string& motor = "") {
  Row out;
  out.line = line;
  out.id = motor.empty() ? line : line + "." + motor;
  out.quantity = quantity;
  out.limit = limit;
  out.stops = true;
  return out;
}

Settings settings() {
  Settings out;
  out.rows = {row("imu_age", "imu_age_s", 0.2), row("imu_fault", "imu_fault", 0.0),
              row("drive_current", "drive_current_a", 10.0, "FL"), row("roll", "roll_deg", 20.0)};
  out.rows[2].n = 3;
  out.rows[2].m = 5;
  out.wheel_radius_m = 0.125;
  out.drive_nominal_a = 3.0;
  out.steer_nominal_a = 0.5;
  out.motor_time_s = 60.0;
  out.restart_window_s = 60.0;
  return out;
}

// A rover that drives at 0.1 m/s with a permit, and the messages of a supervisor.
class JudgeTest : public testing::Test {
 protected:
  JudgeTest() { say_state(supervisor_state_t::DRIVING); }

  template <class Message>
  void put(const char* channel, Message message, Utime release) {
    message.header.utime = now_;
    message.header.release_utime = release;
    message.header.publisher = "test";
    message.header.boot_id = 1;
    message.header.seq = ++seq_;
    std::vector<std::uint8_t> bytes = encoded(message);
    judge_.take(channel, bytes.data(), static_cast<int>(bytes.size()));
  }
  void say_state(std::int8_t state) {
    supervisor_state_t message{};
    message.state = state;
    put(channel::kState, message, now_ + kTickUs);
  }
  void say_fault(const std::string& id, bool active = true) {
    fault_t message{};
    message.id = id;
    message.active = active ? 1 : 0;
    put(channel::kFault, message, now_ + kTickUs);
  }
  void begin(const std::string& id) {
    injection_t message{};
    message.target = id;
    put(kInjectionBegins, message, now_);
  }
  void inject(const std::string& fault, const std::string& target, double for_s) {
    injection_t message{};
    message.fault = fault;
    message.target = target;
    message.amount = fault == "delay" ? 0.1 : 1.0;
    message.from_utime = now_ + kTickUs;
    message.until_utime = now_ + to_utime(for_s);
    put(channel::kInject, message, now_);
  }
  void tick() {
    now_ += kTickUs;
    if (!permitted_) speed_mps_ = std::max(0.0, speed_mps_ - 0.004);
    if (imu_) put(channel::kImu, imu_message_, now_);
    wheels_.drive_rate_radps[0] = speed_mps_ / 0.125;
    put(channel::kWheelState, wheels_, now_);
    truth_t truth{};
    truth.velocity_map_mps[0] = speed_mps_;
    truth.quat_map_body_wxyz[0] = 1.0;
    put(channel::kTruth, truth, now_);
    put(channel::kTick, tick_t{}, now_);
    drive_permit_t permit{};
    permit.granted = permitted_ ? 1 : 0;
    put(channel::kDrivePermit, permit, now_ + kTickUs);
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) tick();
  }
  // The IMU stops; the supervisor raises the fault after some ticks and withdraws the permit after some more.
  void silent_imu(int said_after, int withdrawn_after, const std::string& said = "imu_age") {
    run(10);
    begin("imu_age");
    imu_ = false;
    run(said_after);
    if (!said.empty()) say_fault(said);
    run(withdrawn_after);
    permitted_ = false;
    run(100);
    finish();
  }
  const Verdict& finish() {
    judge_.finish();
    EXPECT_EQ(judge_.verdicts().size(), 1u);
    return judge_.verdicts().front();
  }

  Judge judge_{settings()};
  Utime now_ = 0;
  std::int64_t seq_ = 0;
  bool imu_ = true;
  bool permitted_ = true;
  double speed_mps_ = 0.1;
  imu_t imu_message_{};
  wheel_state_t wheels_{};
};

TEST_F(JudgeTest, PassesAFaultThatIsFoundInTime) {
  silent_imu(11, 0);  // 0.2 s have passed at the eleventh tick
  const Verdict& v = judge_.verdicts().front();
  EXPECT_TRUE(v.detected);
  EXPECT_TRUE(v.named);
  ASSERT_TRUE(v.withdrawn_s && v.still_s);
  EXPECT_NEAR(*v.withdrawn_s, 0.06, 1e-9);
  EXPECT_NEAR(*v.still_s, 0.42, 0.03);
  EXPECT_NEAR(v.speed_mps, 0.1, 0.01);
  EXPECT_TRUE(judge_.false_alarms().empty());
}

TEST_F(JudgeTest, FindsTheFaultThatNobodyRaised) {
  silent_imu(11, 0, "");
  const Verdict& v = judge_.verdicts().front();
  EXPECT_NE(v.visible, kNever);
  EXPECT_FALSE(v.detected);
  EXPECT_FALSE(v.named);
}

TEST_F(JudgeTest, FindsTheFaultThatIsRaisedTooLate) {
  silent_imu(70, 0);
  EXPECT_FALSE(judge_.verdicts().front().detected);
}

TEST_F(JudgeTest, FindsTheWrongRow) {
  run(10);
  begin("imu_age");
  imu_ = false;
  run(11);
  say_fault("drive_current.FL");
  say_fault("imu_age");
  run(10);
  const Verdict& v = finish();
  EXPECT_TRUE(v.detected);
  EXPECT_FALSE(v.named);
  EXPECT_EQ(v.first_raised, "drive_current.FL");
  ASSERT_EQ(judge_.false_alarms().size(), 1u);
  EXPECT_EQ(judge_.false_alarms().front().row, "drive_current.FL");
}

TEST_F(JudgeTest, MeasuresTheLatePermit) {
  silent_imu(11, 25);
  EXPECT_NEAR(*judge_.verdicts().front().withdrawn_s, 0.56, 1e-9);
}

TEST_F(JudgeTest, SeesTheRoverThatRollsOn) {
  run(10);
  begin("imu_age");
  imu_ = false;
  run(11);
  say_fault("imu_age");
  permitted_ = false;
  speed_mps_ = 1.0;  // takes 5 s to stop
  run(400);
  EXPECT_GT(finish().still_s.value_or(0.0), 4.0);
}

TEST_F(JudgeTest, AFaultOutOfTheBlueIsFalse) {
  run(10);
  say_fault("imu_fault");
  run(10);
  ASSERT_EQ(judge_.false_alarms().size(), 1u);
  say_fault("imu_fault");  // active ones are repeated
  run(10);
  EXPECT_EQ(judge_.false_alarms().size(), 1u);
}

TEST_F(JudgeTest, CountsNOfM) {
  run(10);
  begin("drive_current.FL");
  for (const double current_a : {11.0, 0.0, kNaN, 0.0}) {
    wheels_.drive_current_a[0] = current_a;
    tick();
  }
  wheels_.drive_current_a[0] = -11.0;  // the third of five
  const Utime visible = now_ + kTickUs;
  run(10);
  EXPECT_EQ(finish().visible, visible);
}

TEST_F(JudgeTest, SeesWhatIsLostOrLateOnTheWay) {
  run(10);
  begin("imu_age");
  inject("drop", "IMU", 0.3);
  const Utime last = now_;
  run(30);
  EXPECT_EQ(finish().visible, last + 200'000);
}

TEST_F(JudgeTest, ADelayThatTheLimitAllowsIsNoFault) {
  run(10);
  begin("imu_age");
  inject("delay", "IMU", 0.3);
  run(40);
  EXPECT_EQ(finish().visible, kNever);
}

TEST_F(JudgeTest, SeesWhatBecomesNanOnTheWay) {
  run(10);
  begin("imu_fault");
  inject("nan", "IMU.delta_angle_rad", 0.1);
  const Utime first = now_ + kTickUs;
  run(10);
  EXPECT_EQ(finish().visible, first);
}

TEST_F(JudgeTest, TheTableSaysWhatIsNotMet) {
  silent_imu(11, 25);
  std::ostringstream table;
  EXPECT_FALSE(write_table({"command", "commit", "machine"}, settings(), judge_, table));
  EXPECT_NE(table.str().find("| at least 1000 injections that cause a fault | 1 of 1 | **no** |"), std::string::npos);
  EXPECT_NE(table.str().find("| detected 100 % | 1 of 1 | yes |"), std::string::npos);
  EXPECT_NE(table.str().find("p99 at most 50 ms | 560 ms"), std::string::npos);
}

TEST_F(JudgeTest, AnInjectionThatMakesNoFaultCountsForNothing) {
  run(10);
  begin("imu_age");
  inject("delay", "IMU", 0.3);
  run(40);
  finish();
  std::ostringstream table;
  write_table({"command", "commit", "machine"}, settings(), judge_, table);
  EXPECT_NE(table.str().find("| at least 1000 injections that cause a fault | 0 of 1 |"), std::string::npos);
  EXPECT_NE(table.str().find("| every row at least 20 times | minimum 0 | **no** |"), std::string::npos);
}

}  // namespace
}  // namespace rover::bench_faults
