// Runs the cores of localization and SLAM on recorded drives, optionally without some of the visual motions, and prints
// the errors of odometry, SLAM and POSE against the truth. A tool.
//   pose_study [--lost FROM_S,PERIOD_S,DURATION_S] [--config DIR] RUN...
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <deque>
#include <map>
#include <rover/supervisor_state_t.hpp>
#include <rover/truth_t.hpp>

#include "common/bus/convert.hpp"
#include "common/bus/vehicle_config.hpp"
#include "localization/config.hpp"
#include "localization/convert.hpp"
#include "slam/config.hpp"
#include "slam/convert.hpp"
#include "slam/node.hpp"
#include "tools/replay/recorded_log.hpp"

namespace {

using namespace rover;

struct Loss {
  double from_s = kInfinity, period_s = 1.0, duration_s = 0.0;
  bool at(Utime utime) const {
    const double t_s = to_seconds(utime) - from_s;
    return t_s >= 0.0 && std::fmod(t_s, period_s) < duration_s;
  }
};

struct Ends {
  double driven_m = 0.0;
  double odometry_m = 0.0, slam_m = 0.0, pose_m = 0.0;  // errors at the end
  double pose_rms_m = 0.0, nees = 0.0;                  // of x and y of POSE; normalised by its covariance
};

template <class Message>
Message decoded(const replay::LogMessage& message) {
  Message out{};
  if (out.decode(message.bytes.data(), 0, static_cast<int>(message.bytes.size())) < 0)
    throw std::runtime_error(message.channel + ": message cannot be read");
  return out;
}

class Drive {
 public:
  Drive(const std::string& run, const std::string& config_dir, const Loss& loss)
      : log_(run),
        loss_(loss),
        localization_(loc::load_config(config_dir), load_vehicle(config_dir)),
        slam_config_(slam::load_config(config_dir)),
        slam_(slam_config_.core),
        dead_reckoned_(1.0) {}

  Ends run() {
    while (const auto group = log_.next()) {
      for (const replay::LogMessage& message : group->messages) take(message);
      deliver_slam(group->tick);
      localization_.step(group->tick);
      publish_pose();
    }
    ends_.pose_rms_m = std::sqrt(squares_ / std::max(1, samples_));
    ends_.nees /= std::max(1, samples_);
    return ends_;
  }

 private:
  void take(const replay::LogMessage& m) {
    const std::string& c = m.channel;
    if (c == channel::kImu) localization_.add_imu(loc::imu_from(decoded<imu_t>(m)));
    if (c == channel::kWheelState) localization_.add_wheels(loc::wheels_from(decoded<wheel_state_t>(m)));
    if (c == channel::kWheelCommand)
      localization_.add_wheel_command(loc::wheel_command_from(decoded<wheel_command_t>(m)));
    if (c == channel::kVo && !loss_.at(m.header->utime))
      localization_.add_visual_motion(loc::visual_from(decoded<vo_motion_t>(m)));
    if (c == channel::kGroundCommand) start(decoded<ground_command_t>(m));
    if (c == channel::kState) full_ = decoded<supervisor_state_t>(m).level == supervisor_state_t::FULL;
    if (c == channel::kTruth) {
      const auto truth = decoded<truth_t>(m);
      truths_[truth.header.utime] = planar(pose_from(truth.position_map_body_m, truth.quat_map_body_wxyz));
    }
    if (c == channel::kCloud && full_) map_cloud(decoded<cloud_t>(m));
  }

  void start(const ground_command_t& command) {
    if (command.kind == ground_command_t::SET_START_POSE) localization_.set_start_pose(loc::start_pose_from(command));
  }

  void map_cloud(const cloud_t& message) {
    const auto odometry = poses_.at(message.header.utime);
    if (!odometry) return;
    const slam::SlamResult result = slam_.step(slam::cloud_from(message), *odometry);
    if (!result.rejection.empty()) return;
    slam_pose_t out{};
    out.header.utime = message.header.utime;
    slam::slam_pose_to(result, out);
    slam_poses_.push_back({message.header.release_utime + slam_config_.latency_us, out});
    judge(message.header.utime, *odometry, result);
  }

  void deliver_slam(Utime now) {
    for (; !slam_poses_.empty() && slam_poses_.front().first <= now; slam_poses_.pop_front()) {
      const slam_pose_t& pose = slam_poses_.front().second;
      if (pose.status == slam_pose_t::OK && pose.information > 0.0)
        localization_.add_slam_pose(loc::measurement_from(pose));
    }
  }

  void publish_pose() {
    pose_t message{};
    loc::pose_to(localization_.pose(), message);
    message.header.utime = localization_.pose().utime;
    if (message.status == pose_t::UNINITIALISED) return;
    slam::PoseSample sample = slam::sample_from(message);
    sample.odometry.dead_reckoned_m = dead_reckoned_.add(message);
    poses_.add(sample);
    slam_.add_pose(sample.utime, sample.T_map_odom, sample.odometry.T_odom_body);
    published_[sample.utime] = {sample.T_map_odom, localization_.pose().cov};
  }

  // Errors since the first cloud: without that of the start pose.
  void judge(Utime utime, const slam::Odometry& odometry, const slam::SlamResult& result) {
    const auto truth = truths_.find(utime);
    const auto published = published_.find(utime);
    if (truth == truths_.end() || published == published_.end()) return;
    const Pose2 body = planar(odometry.T_odom_body), T_map_odom = planar(published->second.first);
    if (samples_ == 0) {
      start_ = T_map_odom;
      error_ = slam::compose(truth->second, slam::between(slam::compose(start_, body), Pose2{}));
    } else {
      ends_.driven_m += std::hypot(truth->second.x_m - last_.x_m, truth->second.y_m - last_.y_m);
    }
    last_ = truth->second;
    const auto error = [&](const Pose2& T) {
      const Pose2 estimate = slam::compose(error_, slam::compose(T, body));
      return Eigen::Vector2d(estimate.x_m - last_.x_m, estimate.y_m - last_.y_m);
    };
    ends_.odometry_m = error(start_).norm();
    ends_.slam_m = error(result.T_map_odom).norm();
    ends_.pose_m = error(T_map_odom).norm();
    const Pose2 pose = slam::compose(T_map_odom, body);
    const Eigen::Vector2d whole(pose.x_m - last_.x_m, pose.y_m - last_.y_m);
    ends_.nees += whole.dot(published->second.second.topLeftCorner<2, 2>().inverse() * whole);
    squares_ += error(T_map_odom).squaredNorm();
    ++samples_;
  }

  replay::RecordedLog log_;
  Loss loss_;
  loc::Localization localization_;
  slam::NodeConfig slam_config_;
  slam::Slam slam_;
  DeadReckonedDistance dead_reckoned_;
  slam::PoseHistory poses_;
  bool full_ = false;
  std::deque<std::pair<Utime, slam_pose_t>> slam_poses_;  // until their release
  std::map<Utime, Pose2> truths_;
  std::map<Utime, std::pair<Eigen::Isometry3d, Matrix6d>> published_;
  Pose2 start_, error_, last_;
  Ends ends_;
  double squares_ = 0.0;
  int samples_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Odometry, SLAM and POSE on recorded drives, against the truth"};
  std::vector<double> lost;
  std::string config_dir = ROVER_SOURCE_DIR "/config";
  std::vector<std::string> runs;
  app.add_option("--lost", lost, "without visual motions: from, period, duration [s]")->delimiter(',')->expected(3);
  app.add_option("--config", config_dir, "configuration folder");
  app.add_option("runs", runs, "run folders")->required();
  CLI11_PARSE(app, argc, argv);
  if (!lost.empty() && !(lost[1] > 0.0)) {
    std::fprintf(stderr, "pose_study: --lost: the period must be above 0 s\n");
    return 2;
  }
  const Loss loss = lost.empty() ? Loss{} : Loss{lost[0], lost[1], lost[2]};
  fmt::print(
      "| drive | driven | odometry | SLAM | POSE | POSE, rms | squared error of x, y over its variance "
      "|\n|---|---|---|---|---|---|---|\n");
  for (const std::string& run : runs) try {
      const Ends e = Drive(run, config_dir, loss).run();
      const auto percent = [&](double error_m) { return 100.0 * error_m / std::max(e.driven_m, 1.0); };
      fmt::print("| {} | {:.1f} m | {:.2f} % | {:.2f} % | {:.2f} % | {:.3f} m | {:.2f} |\n", run, e.driven_m,
                 percent(e.odometry_m), percent(e.slam_m), percent(e.pose_m), e.pose_rms_m, 0.5 * e.nees);
      std::fflush(stdout);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "pose_study: %s: %s\n", run.c_str(), error.what());
      return 2;
    }
}
