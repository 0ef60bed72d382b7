// The example driver passes every line; drivers with one defect fail exactly the line of that defect.
#include <gtest/gtest.h>

#include <cmath>

#include "broken_driver.hpp"
#include "common/bus/convert.hpp"
#include "tools/conform/image_shift.hpp"
#include "tools/conform/table.hpp"

namespace rover::conform {
namespace {

std::vector<std::string> failed(const std::vector<Line>& lines) {
  std::vector<std::string> out;
  for (const Line& line : lines)
    if (line.verdict == Verdict::kFail) out.push_back(line.check);
  return out;
}

TEST(Conform, ExampleDriverPassesEveryRequirement) {
  BrokenDriver driver;
  const std::vector<Line> lines = driver.examine();
  EXPECT_EQ(failures(lines), 0) << table(lines, false);
  for (const Line& line : lines) EXPECT_EQ(line.verdict, Verdict::kPass) << line.check << ": " << line.measured;
}

TEST(Conform, NoWheelCommandWithoutMoveOption) {
  BrokenDriver driver;
  driver.command = [](wheel_command_t) -> std::vector<wheel_command_t> {
    ADD_FAILURE() << "a command was given";
    return {};
  };
  const std::vector<Line> lines = driver.examine(false);
  EXPECT_EQ(failures(lines), 0) << table(lines, false);
}

TEST(Conform, ADriverThatDiesInTheTrialFails) {
  BrokenDriver driver;
  bool dead = false;
  driver.command = [&](const wheel_command_t& command) -> std::vector<wheel_command_t> {
    dead = true;
    return {command};
  };
  driver.wheels = [&](const wheel_state_t& m) { return dead ? std::vector<wheel_state_t>{} : std::vector{m}; };
  driver.imu = [&](const imu_t& m) { return dead ? std::vector<imu_t>{} : std::vector{m}; };
  const std::vector<std::string> expected = {"follows",           "watchdog", "status when expired", "expired commands",
                                             "commands with NaN", "steering", "sense of turn"};
  EXPECT_EQ(failed(driver.examine()), expected);
}

TEST(Conform, SilentBusFails) {
  const std::vector<Line> lines = check_time({});
  EXPECT_EQ(failed(lines), std::vector<std::string>{"ticks"});
}

struct Fault {
  const char* name;
  const char* check;  // the only line to fail
  void (*breaks)(BrokenDriver&);
};

void PrintTo(const Fault& fault, std::ostream* out) {
  *out << fault.name;
}

// Keeps the messages whose index satisfies `keeps` and renumbers them: a lower rate without loss.
template <class Message>
BrokenDriver::Hook<Message> thinned(bool (*keeps)(int)) {
  return [keeps, received = 0, seq = std::int64_t{0}](Message m) mutable -> std::vector<Message> {
    if (!keeps(received++)) return {};
    m.header.seq = ++seq;
    return {m};
  };
}

// Modifies each message.
template <class Message, class Change>
BrokenDriver::Hook<Message> changed(Change change) {
  return [change](Message m) mutable -> std::vector<Message> {
    change(m);
    return {m};
  };
}

const Fault kFaults[] = {
    {"LockstepTicks", "ticks",
     [](BrokenDriver& d) { d.tick = changed<tick_t>([](tick_t& m) { m.mode = tick_t::LOCKSTEP; }); }},
    {"TicksBesideTheGrid", "ticks",
     [](BrokenDriver& d) {
       d.tick = changed<tick_t>([](tick_t& m) { m.header.release_utime = m.header.utime += 1000; });
     }},
    {"TicksLeftOut", "ticks", [](BrokenDriver& d) { d.tick = thinned<tick_t>([](int n) { return n % 20 != 3; }); }},
    {"SlowClock", "pace", [](BrokenDriver& d) { d.arrival = [](Utime t) { return 1.1 * to_seconds(t); }; }},
    {"UnevenTicks", "jitter",
     [](BrokenDriver& d) { d.arrival = [](Utime t) { return to_seconds(t) + (t / kTickUs % 10 == 0 ? 0.06 : 0.0); }; }},
    {"SlowImu", "rate of IMU",
     [](BrokenDriver& d) {
       d.imu = [received = 0, seq = std::int64_t{0}](imu_t m) mutable -> std::vector<imu_t> {
         if (++received % 2 == 0) return {};
         m.header.seq = ++seq;
         m.dt_s *= 2.0;
         return {m};
       };
     }},
    {"SlowWheelState", "rate of WHEEL_STATE",
     [](BrokenDriver& d) { d.wheels = thinned<wheel_state_t>([](int n) { return n % 4 != 0; }); }},
    {"FastLeftCamera", "rate of LOCCAM_LEFT",
     [](BrokenDriver& d) {
       d.left = [seq = std::int64_t{0}](const image_t& m) mutable {
         std::vector<image_t> out(3, m);
         for (size_t i = 0; i < out.size(); ++i) {
           out[i].header.seq = ++seq;
           out[i].header.utime += static_cast<Utime>(i) * 5000;
         }
         return out;
       };
     }},
    {"SlowRightCamera", "rate of LOCCAM_RIGHT",
     [](BrokenDriver& d) { d.right = thinned<image_t>([](int n) { return n % 2 == 0; }); }},
    {"ForeignType", "types",
     [](BrokenDriver& d) { d.tick = changed<tick_t>([&d](tick_t& m) { d.bus().publish(channel::kImu, &m); }); }},
    {"TimeStandsStill", "utime",
     [](BrokenDriver& d) {
       d.wheels = changed<wheel_state_t>([](wheel_state_t& m) {
         if (m.header.seq % 10 == 0) m.header.utime -= kTickUs;
       });
     }},
    {"SeqSkips", "seq",
     [](BrokenDriver& d) {
       d.wheels = changed<wheel_state_t>([](wheel_state_t& m) { m.header.seq += m.header.seq / 50; });
     }},
    {"BootInBetween", "boot",
     [](BrokenDriver& d) {
       d.wheels = changed<wheel_state_t>([](wheel_state_t& m) { m.header.boot_id += m.header.seq > 100 ? 1 : 0; });
     }},
    {"NoBoot", "boot", [](BrokenDriver& d) { d.imu = changed<imu_t>([](imu_t& m) { m.header.boot_id = 0; }); }},
    {"ReleasedBeforeMeasured", "release",
     [](BrokenDriver& d) {
       d.wheels = changed<wheel_state_t>([](wheel_state_t& m) {
         if (m.header.seq % 4 == 0) m.header.release_utime -= kTickUs;
       });
     }},
    {"ReleasedMuchLater", "release",
     [](BrokenDriver& d) {
       d.wheels = changed<wheel_state_t>([](wheel_state_t& m) {
         if (m.header.seq % 4 == 0) m.header.release_utime += 1'000'000;
       });
     }},
    {"ClockAhead", "clock",
     [](BrokenDriver& d) {
       d.imu = changed<imu_t>([](imu_t& m) { m.header.release_utime = m.header.utime += 500'000; });
     }},
    {"ClockBehind", "clock",
     [](BrokenDriver& d) {
       d.imu = changed<imu_t>([](imu_t& m) { m.header.release_utime = m.header.utime -= 500'000; });
     }},
    {"WrongInterval", "IMU interval",
     [](BrokenDriver& d) { d.imu = changed<imu_t>([](imu_t& m) { m.dt_s = 0.008; }); }},
    {"ImuSaysFault", "IMU interval",
     [](BrokenDriver& d) { d.imu = changed<imu_t>([](imu_t& m) { m.status = imu_t::FAULT; }); }},
    {"GravityDown", "gravity",
     [](BrokenDriver& d) { d.imu = changed<imu_t>([](imu_t& m) { m.delta_velocity_mps[2] *= -1.0; }); }},
    {"GravityAlongX", "gravity",
     [](BrokenDriver& d) {
       d.imu = changed<imu_t>([](imu_t& m) { std::swap(m.delta_velocity_mps[0], m.delta_velocity_mps[2]); });
     }},
    {"AccelerationsInsteadOfIncrements", "gravity",
     [](BrokenDriver& d) { d.imu = changed<imu_t>([](imu_t& m) { m.delta_velocity_mps[2] /= m.dt_s; }); }},
    {"GyroTurnsAtRest", "gyros",
     [](BrokenDriver& d) { d.imu = changed<imu_t>([](imu_t& m) { m.delta_angle_rad[2] += 0.001; }); }},
    {"WheelsSayFault", "wheels at rest",
     [](BrokenDriver& d) {
       d.wheels = changed<wheel_state_t>([&d](wheel_state_t& m) {
         if (d.at_rest()) m.status = wheel_state_t::FAULT;
       });
     }},
    {"WheelsNotANumber", "wheels at rest",
     [](BrokenDriver& d) {
       d.wheels = changed<wheel_state_t>([&d](wheel_state_t& m) {
         if (d.at_rest()) m.drive_current_a[3] = kNaN;
       });
     }},
    {"RowMissing", "image size",
     [](BrokenDriver& d) {
       d.left = changed<image_t>([](image_t& m) {
         m.height -= 1;
         m.size -= m.width;
         m.data.resize(static_cast<size_t>(m.size));
       });
     }},
    {"PairsNotAtOnce", "pairs",
     [](BrokenDriver& d) { d.right = changed<image_t>([](image_t& m) { m.header.utime += 1000; }); }},
    {"Dark", "exposure",
     [](BrokenDriver& d) {
       d.left = changed<image_t>([](image_t& m) {
         for (std::uint8_t& grey : m.data) grey /= 20;
       });
     }},
    {"CablesExchanged", "left and right",
     [](BrokenDriver& d) {
       struct Held {
         image_t left;
       };
       const auto held = std::make_shared<Held>();
       d.left = [held](const image_t& m) -> std::vector<image_t> {
         held->left = m;
         return {};
       };
       d.right = [held, &d](image_t m) -> std::vector<image_t> {
         std::swap(held->left.data, m.data);
         d.bus().publish(channel::kLocCamLeft, &held->left);
         return {m};
       };
     }},
    {"ObeysDamagedCommands", "damaged commands",
     [](BrokenDriver& d) {
       d.damaged = [&d] {
         wheel_command_t forward{};
         std::fill_n(forward.drive_rate_radps, 6, 0.4);
         d.tell(forward);
       };
     }},
    {"WheelsReversed", "follows",
     [](BrokenDriver& d) {
       d.wheels = changed<wheel_state_t>([](wheel_state_t& m) {
         for (double& rate : m.drive_rate_radps) rate *= -1.0;
         for (double& angle : m.drive_angle_rad) angle *= -1.0;
       });
     }},
    {"EncodersReversed", "follows",
     [](BrokenDriver& d) {
       d.wheels = changed<wheel_state_t>([](wheel_state_t& m) {
         for (double& angle : m.drive_angle_rad) angle *= -1.0;
       });
     }},
    {"NoWatchdog", "watchdog",
     [](BrokenDriver& d) {
       const auto last = std::make_shared<wheel_command_t>();
       d.command = changed<wheel_command_t>([last](wheel_command_t& m) { *last = m; });
       d.wheels = changed<wheel_state_t>([last, &d](wheel_state_t& m) {
         const bool expired = last->header.seq > 0 && last->valid_until_utime < d.now();
         if (!expired) return;
         m.status = wheel_state_t::COMMAND_EXPIRED;
         if (last->drive_rate_radps[0] > 0.0) d.tell(*last);
       });
     }},
    {"SaysNothingOfExpiry", "status when expired",
     [](BrokenDriver& d) {
       d.wheels = changed<wheel_state_t>([](wheel_state_t& m) { m.status = wheel_state_t::OK; });
     }},
    {"ObeysExpired", "expired commands",
     [](BrokenDriver& d) {
       d.command = changed<wheel_command_t>(
           [&d](wheel_command_t& m) { m.valid_until_utime = std::max(m.valid_until_utime, d.now() + 10 * kTickUs); });
     }},
    {"ObeysNaN", "commands with NaN",
     [](BrokenDriver& d) {
       d.command = changed<wheel_command_t>([](wheel_command_t& m) {
         if (std::isnan(m.drive_rate_radps[0])) m.drive_rate_radps[0] = m.drive_rate_radps[1];
       });
     }},
    {"SteeringReversed", "steering",
     [](BrokenDriver& d) {
       d.wheels = changed<wheel_state_t>([](wheel_state_t& m) {
         for (double& angle : m.steer_angle_rad) angle *= -1.0;
       });
     }},
    {"GyroReversed", "sense of turn",
     [](BrokenDriver& d) { d.imu = changed<imu_t>([](imu_t& m) { m.delta_angle_rad[2] *= -1.0; }); }},
    {"FibreOpticGyroReversed", "sense of turn",
     [](BrokenDriver& d) { d.imu = changed<imu_t>([](imu_t& m) { m.fog_delta_yaw_rad *= -1.0; }); }},
};

class BrokenDrivers : public testing::TestWithParam<Fault> {};

TEST_P(BrokenDrivers, FailExactlyTheirLine) {
  BrokenDriver driver;
  GetParam().breaks(driver);
  const std::vector<Line> lines = driver.examine();
  EXPECT_EQ(failed(lines), std::vector<std::string>{GetParam().check}) << table(lines, false);
}

INSTANTIATE_TEST_SUITE_P(Each, BrokenDrivers, testing::ValuesIn(kFaults),
                         [](const auto& fault) { return std::string(fault.param.name); });

TEST(Conform, EveryRequirementHasAFailingDriver) {
  BrokenDriver driver;
  for (const Line& line : driver.examine()) {
    const bool covered = std::any_of(std::begin(kFaults), std::end(kFaults),
                                     [&](const Fault& fault) { return fault.check == line.check; });
    EXPECT_TRUE(covered) << line.check;
  }
}

TEST(ImageShift, FindsShiftAndIsEmptyForUncorrelatedImages) {
  GrayImage left(160, 120);
  GrayImage right(160, 120);
  GrayImage other(160, 120);
  std::uint32_t state = 1;
  const auto random = [&state] { return static_cast<std::uint8_t>((state = state * 1664525u + 1013904223u) >> 24); };
  for (std::uint8_t& grey : left.data) grey = random();
  for (std::uint8_t& grey : other.data) grey = random();
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) right.at(x, y) = left.at(std::min(x + 9, 159), y);
  EXPECT_EQ(shift_to_left_px(left, right, 20), 9.0);
  EXPECT_EQ(shift_to_left_px(right, left, 20), -9.0);
  EXPECT_FALSE(shift_to_left_px(left, other, 20).has_value());
  EXPECT_FALSE(shift_to_left_px(left, GrayImage(160, 120, 100), 20).has_value());
  EXPECT_FALSE(shift_to_left_px(GrayImage(40, 30), GrayImage(40, 30), 20).has_value());
}

}  // namespace
}  // namespace rover::conform
