// The node on an in-process bus: the plan, the operator's commands, the logbook, a restart.
#include "mission_control/node.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <future>
#include <set>
#include <thread>

#include "common/bus/convert.hpp"
#include "test/common/temp_folder.hpp"
#include "test/trajectory_control/bus_world.hpp"

namespace rover {
namespace {

using mission::Command;
using mission::CommandKind;
using mission::CommandReply;

MissionPlan plan() {
  MissionPlan plan;
  plan.start.pose = {20.0, 20.0, 0.0};
  plan.path.x_m = {20.0, 25.0};
  plan.path.y_m = {20.0, 20.0};
  plan.path.level = {0, 0};
  return plan;
}

class MissionControlTest : public testing::Test {
 protected:
  explicit MissionControlTest(std::string run_dir = "") : run_dir_(std::move(run_dir)) {
    commands_ = world_.listen<ground_command_t>(channel::kGroundCommand);
    paths_ = world_.listen<path_t>(channel::kGlobalPath);
    start(1);
  }

  void start(std::int64_t boot_id) {
    service_.reset();
    node_.reset();
    shared_ = std::make_shared<mission::SharedState>();
    node_ = std::make_unique<Node>(NodeOptions{.name = "mission_control", .boot_id = boot_id, .run_dir = run_dir_},
                                   world_.bus);
    service_ = std::make_unique<MissionControlNode>(*node_, plan(), shared_);
  }

  void tick(int times = 1) {
    for (int i = 0; i < times; ++i) world_.tick(*node_);
  }

  void acknowledge(std::int64_t id, bool accepted, const std::string& reason = "") {
    command_ack_t ack{};
    ack.command_id = id;
    ack.accepted = accepted ? 1 : 0;
    ack.reason = reason;
    world_.send(channel::kCommandAck, ack, "supervisor");
    tick(2);
  }

  void say_state(std::int8_t state, const std::string& cause = "go",
                 std::int8_t level = supervisor_state_t::EFFICIENT) {
    supervisor_state_t message{};
    message.state = state;
    message.level = level;
    message.cause = cause;
    world_.send(channel::kState, message, "supervisor");
    tick(2);
  }

  void finish_start_pose_and_path() {
    tick(2);
    acknowledge(commands_->back().command_id, true);
    acknowledge(paths_->back().path_id, true);
  }

  long sent(std::int8_t kind) const {
    return std::count_if(commands_->begin(), commands_->end(), [kind](const auto& c) { return c.kind == kind; });
  }

  void finish_plan() {
    finish_start_pose_and_path();
    say_state(supervisor_state_t::STANDBY);
    acknowledge(commands_->back().command_id, true);
  }

  // What an operator's command leads to; `answer`: of the rover, none: it is silent.
  CommandReply operate(const Command& command, std::optional<bool> answer, const std::string& reason = "") {
    CommandReply result;
    const size_t before = commands_->size() + paths_->size();
    std::thread page(
        [&] { result = shared_->commands.submit(command, std::chrono::milliseconds(answer ? 20'000 : 300)); });
    for (int i = 0; i < 2000 && commands_->size() + paths_->size() == before; ++i) {
      tick();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_EQ(commands_->size() + paths_->size(), before + 1);
    const bool path = command.kind == CommandKind::kPath || command.kind == CommandKind::kZones;
    const std::int64_t id = path ? paths_->back().path_id : commands_->back().command_id;
    if (answer) acknowledge(id, *answer, reason);
    page.join();
    return result;
  }

  // Of mission_control itself: nothing is sent whose arrival could be awaited.
  std::string refusal(const Command& command) {
    auto page = std::async(std::launch::async,
                           [&] { return shared_->commands.submit(command, std::chrono::milliseconds(20'000)); });
    while (page.wait_for(std::chrono::milliseconds(1)) != std::future_status::ready) tick();
    const CommandReply reply = page.get();
    EXPECT_EQ(reply.outcome, CommandReply::Outcome::kRefused);
    return reply.reason;
  }

  bool noted(const std::string& text) {
    return shared_->book.with([&](const mission::Logbook& book) {
      return std::any_of(book.events().begin(), book.events().end(),
                         [&](const auto& event) { return event.text.find(text) != std::string::npos; });
    });
  }

  std::string run_dir_;
  test::BusWorld world_;
  std::shared_ptr<mission::SharedState> shared_;
  std::unique_ptr<Node> node_;
  std::unique_ptr<MissionControlNode> service_;
  std::shared_ptr<std::vector<ground_command_t>> commands_;
  std::shared_ptr<std::vector<path_t>> paths_;
};

TEST_F(MissionControlTest, PlanIsIssuedOnceAndEndsWithGo) {
  finish_plan();
  tick(200);
  ASSERT_EQ(commands_->size(), 2U);
  EXPECT_EQ(commands_->front().kind, +ground_command_t::SET_START_POSE);
  EXPECT_EQ(commands_->back().kind, +ground_command_t::GO);
  ASSERT_EQ(paths_->size(), 1U);
  EXPECT_EQ(paths_->front().x_m, plan().path.x_m);
  EXPECT_EQ(shared_->book.with([](const auto& book) { return book.path_id(); }), paths_->front().path_id);
}

TEST_F(MissionControlTest, CommandsHaveUniqueIdsAndReturnTheirReplies) {
  finish_plan();
  const std::vector<std::pair<CommandKind, int>> kinds = {
      {CommandKind::kGo, +ground_command_t::GO},
      {CommandKind::kStop, +ground_command_t::STOP},
      {CommandKind::kPause, +ground_command_t::PAUSE},
      {CommandKind::kResume, +ground_command_t::RESUME},
      {CommandKind::kEmergencyStop, +ground_command_t::EMERGENCY_STOP},
      {CommandKind::kClearSafe, +ground_command_t::CLEAR_SAFE}};
  std::set<std::int64_t> ids;
  for (const auto& [kind, expected] : kinds) {
    Command command;
    command.kind = kind;
    const CommandReply answer = operate(command, true);
    EXPECT_EQ(answer.outcome, CommandReply::Outcome::kAccepted);
    EXPECT_EQ(commands_->back().kind, expected);
    EXPECT_EQ(answer.command_id, commands_->back().command_id);
    EXPECT_TRUE(ids.insert(answer.command_id).second);
  }
}

TEST_F(MissionControlTest, RefusalReportsReason) {
  finish_plan();
  Command command;
  command.kind = CommandKind::kClearFault;
  command.target = "no_path";
  const CommandReply answer = operate(command, false, "no such fault is active");
  EXPECT_EQ(answer.outcome, CommandReply::Outcome::kRefused);
  EXPECT_EQ(answer.reason, "no such fault is active");
  EXPECT_EQ(commands_->back().target, "no_path");
  EXPECT_TRUE(noted("clear fault no_path refused: no such fault is active"));
}

TEST_F(MissionControlTest, MissingReplyIsReported) {
  finish_plan();
  Command command;
  command.kind = CommandKind::kGo;
  EXPECT_EQ(operate(command, std::nullopt).outcome, CommandReply::Outcome::kNoReply);
}

TEST_F(MissionControlTest, ForcedLevelIsStored) {
  finish_plan();
  Command command;
  command.kind = CommandKind::kForceLevel;
  command.level = mission::Level::kFull;
  operate(command, false, "the services of the Full level are not running");
  EXPECT_EQ(shared_->book.with([](const auto& book) { return book.forced(); }), mission::Level::kAuto);
  operate(command, true);
  EXPECT_EQ(commands_->back().level, +ground_command_t::FULL);
  EXPECT_EQ(shared_->book.with([](const auto& book) { return book.forced(); }), mission::Level::kFull);
}

TEST_F(MissionControlTest, DrawnPathIsActiveOnceAccepted) {
  finish_plan();
  const std::int64_t planned = paths_->back().path_id;
  Command command;
  command.kind = CommandKind::kPath;
  command.points = {{1.0, 2.0}, {3.0, 4.0}};
  const auto in_force = [&] { return shared_->book.with([](const auto& book) { return book.path_id(); }); };
  operate(command, false, "path is shorter than 0.1 m");
  EXPECT_EQ(in_force(), planned);
  operate(command, true);
  EXPECT_EQ(in_force(), paths_->back().path_id);
  EXPECT_EQ(paths_->back().frame, +path_t::MAP);
  EXPECT_EQ(paths_->back().x_m, (std::vector<double>{1.0, 3.0}));
}

Command zones(const std::vector<Zone>& list) {
  Command command;
  command.kind = CommandKind::kZones;
  command.zones = list;
  return command;
}

TEST_F(MissionControlTest, ZonesComeWithThePathUnderWayAndWithLaterOnes) {
  finish_plan();
  const Zone dune{"dune", false, {{22.0, 21.0}, {24.0, 21.0}, {24.0, 23.0}}};
  operate(zones({dune}), true);
  EXPECT_EQ(paths_->back().x_m, (std::vector<double>{20.0, 25.0}));
  ASSERT_EQ(paths_->back().zone_count, 1);
  EXPECT_EQ(paths_->back().zones[0].name, "dune");
  EXPECT_EQ(paths_->back().zones[0].x_m, (std::vector<double>{22.0, 24.0, 24.0}));
  Command path;
  path.kind = CommandKind::kPath;
  path.points = {{20.0, 20.0}, {30.0, 30.0}};
  operate(path, true);
  EXPECT_EQ(paths_->back().zone_count, 1);
  operate(zones({}), false, "no");
  operate(zones({}), true);
  EXPECT_EQ(paths_->back().zone_count, 0);
  EXPECT_EQ(paths_->back().x_m, (std::vector<double>{20.0, 30.0}));
}

TEST_F(MissionControlTest, ZonesNeedAPathAndAreNotLostBeforeTheirAcknowledgement) {
  tick(2);
  const size_t before = paths_->size();
  EXPECT_EQ(refusal(zones({})), "the rover has no path yet");
  EXPECT_EQ(paths_->size(), before);
  finish_plan();
  operate(zones({{"dune", false, {{22.0, 21.0}, {24.0, 21.0}, {24.0, 23.0}}}}), std::nullopt);
  Command path;
  path.kind = CommandKind::kPath;
  path.points = {{20.0, 20.0}, {30.0, 30.0}};
  operate(path, true);
  EXPECT_EQ(paths_->back().zone_count, 1) << "its acknowledgement was lost";
}

// The ground behind the rover may be forbidden after it has passed.
TEST_F(MissionControlTest, AZoneOverTheStartLeavesTheRestOfThePath) {
  finish_plan();
  pose_t pose{};
  pose_to(from_planar({23.0, 20.1, 0.0}), pose.position_odom_body_m, pose.quat_odom_body_wxyz);
  pose_to(from_planar({0.0, 0.0, 0.0}), pose.position_map_odom_m, pose.quat_map_odom_wxyz);
  world_.send(channel::kPose, pose, "localization");
  tick(2);
  operate(zones({{"start", false, {{19.0, 19.0}, {21.0, 19.0}, {21.0, 21.0}, {19.0, 21.0}}}}), true);
  EXPECT_EQ(paths_->back().x_m, (std::vector<double>{23.0, 25.0}));
  EXPECT_EQ(paths_->back().y_m, (std::vector<double>{20.1, 20.0}));
}

TEST_F(MissionControlTest, ALostRoverIsSearchedForAboutItsEstimatedPosition) {
  Command command;
  command.kind = CommandKind::kLocate;
  command.within_m = 300.0;
  finish_plan();
  EXPECT_EQ(refusal(command), "the rover has no position yet");
  pose_t pose{};
  pose_to(from_planar({3.0, 4.0, 0.5}), pose.position_odom_body_m, pose.quat_odom_body_wxyz);
  pose_to(from_planar({100.0, 50.0, 0.0}), pose.position_map_odom_m, pose.quat_map_odom_wxyz);
  pose.covariance[35] = 0.01;
  world_.send(channel::kPose, pose, "localization");
  EXPECT_EQ(refusal(command), "only the Full level maps the ground");
  say_state(supervisor_state_t::DRIVING, "go", supervisor_state_t::FULL);
  EXPECT_EQ(refusal(command), "the rover drives; pause it first");
  say_state(supervisor_state_t::PAUSED, "pause", supervisor_state_t::FULL);
  EXPECT_EQ(operate(command, true).outcome, CommandReply::Outcome::kAccepted);
  const ground_command_t& sent = commands_->back();
  EXPECT_EQ(sent.kind, +ground_command_t::SET_START_POSE);
  EXPECT_DOUBLE_EQ(sent.position_map_m[0], 103.0);
  EXPECT_DOUBLE_EQ(sent.position_map_m[1], 54.0);
  EXPECT_NEAR(sent.yaw_rad, 0.5, 1e-12);
  EXPECT_DOUBLE_EQ(sent.sigma_m, 100.0);
  EXPECT_DOUBLE_EQ(sent.sigma_yaw_rad, 0.1);
  EXPECT_EQ(sent.clear_radius_m, 0.0);
}

// The plan's GO must not follow a stop.
TEST_F(MissionControlTest, StopCancelsPlan) {
  finish_start_pose_and_path();
  Command command;
  command.kind = CommandKind::kStop;
  operate(command, true);
  say_state(supervisor_state_t::STANDBY);
  tick(200);
  EXPECT_EQ(commands_->back().kind, +ground_command_t::STOP);
}

TEST_F(MissionControlTest, GoWithoutAcknowledgementIsDoneWhenTheRoverDrives) {
  finish_start_pose_and_path();
  say_state(supervisor_state_t::STANDBY);
  EXPECT_EQ(sent(ground_command_t::GO), 1);
  say_state(supervisor_state_t::DRIVING);
  say_state(supervisor_state_t::STANDBY);
  tick(200);
  EXPECT_EQ(sent(ground_command_t::GO), 1);
}

TEST_F(MissionControlTest, SafeAndTeleopCancelPlan) {
  std::int64_t boot_id = 1;
  for (const std::int8_t state : {supervisor_state_t::SAFE, supervisor_state_t::TELEOP}) {
    start(++boot_id);
    finish_start_pose_and_path();
    say_state(state);
    say_state(supervisor_state_t::STANDBY);
    tick(200);
    EXPECT_EQ(sent(ground_command_t::GO), 0) << int{state};
    start(++boot_id);
    tick(2);
    acknowledge(commands_->back().command_id, true);
    const size_t paths = paths_->size();
    say_state(state);
    tick(200);
    EXPECT_EQ(paths_->size(), paths) << int{state};
  }
}

// STATE of SAFE may be lost.
TEST_F(MissionControlTest, ClearSafeCancelsPlan) {
  finish_start_pose_and_path();
  Command command;
  command.kind = CommandKind::kClearSafe;
  operate(command, true);
  say_state(supervisor_state_t::STANDBY);
  tick(200);
  EXPECT_EQ(sent(ground_command_t::GO), 0);
}

TEST_F(MissionControlTest, StopsAreRepeatedWithTheirIdUntilTheFirstAcknowledgement) {
  finish_plan();
  for (const CommandKind kind : {CommandKind::kStop, CommandKind::kPause, CommandKind::kEmergencyStop}) {
    Command command;
    command.kind = kind;
    operate(command, std::nullopt);
    const ground_command_t first = commands_->back();
    tick(25);
    EXPECT_EQ(sent(first.kind), 3) << "after 0, 0.2 and 0.4 s";
    EXPECT_EQ(commands_->back().command_id, first.command_id);
    acknowledge(first.command_id, true);
    acknowledge(first.command_id, false, "not possible in STANDBY");
    tick(200);
    EXPECT_EQ(sent(first.kind), 3);
    EXPECT_TRUE(noted(mission::description(command) + " accepted"));
    EXPECT_FALSE(noted(mission::description(command) + " refused"));
  }
}

TEST_F(MissionControlTest, OnlyStopsAreRepeatedAndForThreeSecondsAtMost) {
  finish_plan();
  Command command;
  operate(command, std::nullopt);
  tick(1000);
  EXPECT_EQ(sent(ground_command_t::STOP), 15);
  command.kind = CommandKind::kResume;
  operate(command, std::nullopt);
  tick(200);
  EXPECT_EQ(sent(ground_command_t::RESUME), 1);
}

TEST_F(MissionControlTest, OnlyTheNewestUnacknowledgedPathsAreKept) {
  tick(2);
  acknowledge(commands_->back().command_id, true);
  tick(500);
  ASSERT_GT(paths_->size(), 9U);
  const auto in_force = [&] { return shared_->book.with([](const auto& book) { return book.path_id(); }); };
  acknowledge(paths_->front().path_id, true);
  EXPECT_EQ(in_force(), -1);
  const std::int64_t late = paths_->at(paths_->size() - 2).path_id;
  acknowledge(late, true);
  EXPECT_EQ(in_force(), late);
}

TEST_F(MissionControlTest, LogbookRecordsEvents) {
  finish_plan();
  say_state(supervisor_state_t::DRIVING, "go");
  say_state(supervisor_state_t::HAZARD_STOP, "path_blocked");
  EXPECT_TRUE(noted("HAZARD_STOP: path_blocked"));
  fault_t fault{};
  fault.id = "slip";
  fault.active = 1;
  fault.response = fault_t::STOP;
  world_.send(channel::kFault, fault, "supervisor");
  tick(2);
  EXPECT_TRUE(noted("slip raised"));
  heartbeat_t heartbeat{};
  heartbeat.service = "stereo";
  world_.send(channel::kHeartbeat, heartbeat, "stereo");
  tick(100);
  EXPECT_TRUE(noted("stereo: heartbeat timeout"));
}

// The folder outlives the service that writes into it.
class RestartedMissionControlTest : testing_support::TempFolder, public MissionControlTest {
 protected:
  RestartedMissionControlTest() : MissionControlTest(TempFolder::path()) {}
};

// A repeated start pose would reset the rover's position.
TEST_F(RestartedMissionControlTest, RestartRepeatsNoCommandAndRestoresLogbook) {
  finish_plan();
  tick(100);
  const size_t commands = commands_->size();
  const std::int64_t path = paths_->back().path_id;
  start(2);
  tick(200);
  EXPECT_EQ(commands_->size(), commands);
  EXPECT_EQ(paths_->size(), 1U);
  EXPECT_EQ(shared_->book.with([](const auto& book) { return book.path_id(); }), path);
  EXPECT_TRUE(noted("mission plan: go accepted"));
}

// Less than a second after the first checkpoint.
TEST_F(RestartedMissionControlTest, PlanProgressSurvivesAnImmediateKill) {
  finish_plan();
  start(2);
  tick(200);
  EXPECT_EQ(commands_->size(), 2U);
  EXPECT_EQ(paths_->size(), 1U);
}

TEST_F(RestartedMissionControlTest, CancellationSurvivesAnImmediateKill) {
  finish_start_pose_and_path();
  operate(Command{}, true);
  start(2);
  say_state(supervisor_state_t::STANDBY);
  tick(200);
  EXPECT_EQ(commands_->back().kind, +ground_command_t::STOP);
}

}  // namespace
}  // namespace rover
