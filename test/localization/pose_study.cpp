// Runs the cores of localization and SLAM on recorded drives, optionally without some of the visual motions, and prints
// the errors of odometry, SLAM and POSE against the truth. A tool.
//   pose_study [--lost FROM_S,PERIOD_S,DURATION_S] [--config DIR] [--motions FILE] RUN...
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

// Long enough for all that a visual motion corrects late, short enough to be no drift.
constexpr Utime kLag = 1'500'000;
constexpr double kStepM = 0.02;

class RootMeanSquare {
 public:
  void add(const Eigen::Vector2d& error) {
    sum_ += error.squaredNorm();
    ++count_;
  }
  double value() const { return std::sqrt(sum_ / std::max(1, count_)); }

 private:
  double sum_ = 0.0;
  int count_ = 0;
};

struct Ends {
  double driven_m = 0.0;
  double odometry_m = 0.0, slam_m = kNaN, pose_m = 0.0;  // errors at the end, without that of the start pose
  RootMeanSquare odometry_rms_m, slam_rms_m, pose_rms_m;
  RootMeanSquare lag_m;                             // change of odometry's error within kLag
  Eigen::Array3d squares = Eigen::Array3d::Zero();  // of POSE's errors in x, y, yaw over their variances
  int samples = 0;
  Eigen::Array2d visual_squares = Eigen::Array2d::Zero();  // of visual motions: position, rotation
  int visual_samples = 0;
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
  // motions: receives the errors of visual odometry, may be null.
  Drive(const std::string& run, const std::string& config_dir, const Loss& loss, std::FILE* motions)
      : log_(run),
        run_(run),
        motions_(motions),
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
    ends_.squares /= std::max(1, ends_.samples);
    ends_.visual_squares /= std::max(1, ends_.visual_samples);
    return ends_;
  }

 private:
  void take(const replay::LogMessage& m) {
    const std::string& c = m.channel;
    if (c == channel::kImu) localization_.add_imu(loc::imu_from(decoded<imu_t>(m)));
    if (c == channel::kWheelState) localization_.add_wheels(loc::wheels_from(decoded<wheel_state_t>(m)));
    if (c == channel::kWheelCommand)
      localization_.add_wheel_command(loc::wheel_command_from(decoded<wheel_command_t>(m)));
    if (c == channel::kVo && !loss_.at(m.header->utime)) {
      const loc::VisualMotion motion = loc::visual_from(decoded<vo_motion_t>(m));
      judge(motion);
      localization_.add_visual_motion(motion);
    }
    if (c == channel::kGroundCommand) start(decoded<ground_command_t>(m));
    if (c == channel::kState) full_ = decoded<supervisor_state_t>(m).level == supervisor_state_t::FULL;
    if (c == channel::kTruth) {
      const auto truth = decoded<truth_t>(m);
      truths_[truth.header.utime] = pose_from(truth.position_map_body_m, truth.quat_map_body_wxyz);
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
    if (const auto truth = truths_.find(message.header.utime); truth != truths_.end() && started_) {
      const Eigen::Vector2d error = error_of(result.T_map_odom, planar(odometry->T_odom_body), planar(truth->second));
      ends_.slam_m = error.norm();
      ends_.slam_rms_m.add(error);
    }
  }

  void deliver_slam(Utime now) {
    for (; !slam_poses_.empty() && slam_poses_.front().first <= now; slam_poses_.pop_front()) {
      const slam_pose_t& pose = slam_poses_.front().second;
      if (pose.status == slam_pose_t::OK) localization_.add_slam_pose(loc::measurement_from(pose));
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
    if (const auto truth = truths_.find(sample.utime); truth != truths_.end()) judge(sample, planar(truth->second));
  }

  // From the keyframe to the newest image.
  void judge(const loc::VisualMotion& motion) {
    if (motion.previous_utime == motion.keyframe_utime) T_key_cur_ = Eigen::Isometry3d::Identity();
    T_key_cur_ = T_key_cur_ * motion.T_prev_cur;  // not finite after a gap
    const auto from = truths_.find(motion.keyframe_utime), to = truths_.find(motion.utime);
    if (motion.status != loc::VisualStatus::kOk || from == truths_.end() || to == truths_.end()) {
      T_key_cur_ = nan_pose();
      return;
    }
    const Eigen::Isometry3d truth = from->second.inverse() * to->second;
    if (!is_finite(T_key_cur_) || truth.translation().norm() < kStepM) return;
    Eigen::Matrix<double, 6, 1> error;
    error << T_key_cur_.translation() - truth.translation(), log_so3(T_key_cur_.linear() * truth.linear().transpose());
    ends_.visual_squares +=
        Eigen::Array2d(error.head<3>().dot(motion.cov.topLeftCorner<3, 3>().inverse() * error.head<3>()) / 3.0,
                       error.tail<3>().dot(motion.cov.bottomRightCorner<3, 3>().inverse() * error.tail<3>()) / 3.0);
    ++ends_.visual_samples;
    if (motions_ == nullptr) return;
    const Eigen::Vector3d p = truth.translation();
    fmt::print(motions_, "{},{:.5f},{:.5f},{:.5f},{:.5f}", run_, p.x(), p.y(), p.z(), log_so3(truth.linear()).norm());
    for (int i = 0; i < 6; ++i) fmt::print(motions_, ",{:.3e},{:.3e}", error(i), std::sqrt(motion.cov(i, i)));
    fmt::print(motions_, "\n");
  }

  // Of a position, without that of the start pose.
  Eigen::Vector2d error_of(const Pose2& T_map_odom, const Pose2& T_odom_body, const Pose2& truth) const {
    const Pose2 body = slam::compose(start_error_, slam::compose(T_map_odom, T_odom_body));
    return {body.x_m - truth.x_m, body.y_m - truth.y_m};
  }

  void judge(const slam::PoseSample& sample, const Pose2& truth) {
    const Pose2 body = planar(sample.odometry.T_odom_body), T_map_odom = planar(sample.T_map_odom);
    if (!started_) {
      T_map_odom_start_ = T_map_odom;
      start_error_ = slam::compose(truth, slam::between(slam::compose(T_map_odom, body), Pose2{}));
      last_ = truth;
      started_ = true;
    }
    const double step_m = std::hypot(truth.x_m - last_.x_m, truth.y_m - last_.y_m);
    if (step_m > kStepM) {
      ends_.driven_m += step_m;
      last_ = truth;
    }
    const Eigen::Vector2d odometry = error_of(T_map_odom_start_, body, truth);
    const Eigen::Vector2d pose = error_of(T_map_odom, body, truth);
    ends_.odometry_m = odometry.norm();
    ends_.pose_m = pose.norm();
    ends_.odometry_rms_m.add(odometry);
    ends_.pose_rms_m.add(pose);
    errors_[sample.utime] = odometry;
    if (const auto before = errors_.find(sample.utime - kLag); before != errors_.end())
      ends_.lag_m.add(odometry - before->second);
    const Pose2 whole = slam::compose(T_map_odom, body);
    const Eigen::Array3d error(whole.x_m - truth.x_m, whole.y_m - truth.y_m, wrap_angle(whole.yaw_rad - truth.yaw_rad));
    const Matrix6d& cov = localization_.pose().cov;
    ends_.squares += error.square() / Eigen::Array3d(cov(0, 0), cov(1, 1), cov(5, 5));
    ++ends_.samples;
  }

  replay::RecordedLog log_;
  std::string run_;
  std::FILE* motions_;
  Loss loss_;
  loc::Localization localization_;
  slam::NodeConfig slam_config_;
  slam::Slam slam_;
  DeadReckonedDistance dead_reckoned_;
  slam::PoseHistory poses_;
  bool full_ = false;
  std::deque<std::pair<Utime, slam_pose_t>> slam_poses_;  // until their release
  std::map<Utime, Eigen::Isometry3d> truths_;             // T_map_body
  Eigen::Isometry3d T_key_cur_ = nan_pose();
  bool started_ = false;
  Pose2 T_map_odom_start_, start_error_, last_;
  std::map<Utime, Eigen::Vector2d> errors_;
  Ends ends_;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Odometry, SLAM and POSE on recorded drives, against the truth"};
  std::vector<double> lost;
  std::string config_dir = ROVER_SOURCE_DIR "/config";
  std::string motions_file;
  std::vector<std::string> runs;
  app.add_option("--lost", lost, "without visual motions: from, period, duration [s]")->delimiter(',')->expected(3);
  app.add_option("--config", config_dir, "configuration folder");
  app.add_option("--motions", motions_file,
                 "writes each visual motion since its keyframe: run, true x y z and angle, "
                 "then error and stated sigma of x y z and of the rotation");
  app.add_option("runs", runs, "run folders")->required();
  CLI11_PARSE(app, argc, argv);
  if (!lost.empty() && !(lost[1] > 0.0)) {
    std::fprintf(stderr, "pose_study: --lost: the period must be above 0 s\n");
    return 2;
  }
  const Loss loss = lost.empty() ? Loss{} : Loss{lost[0], lost[1], lost[2]};
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> motions(
      motions_file.empty() ? nullptr : std::fopen(motions_file.c_str(), "w"),
      [](std::FILE* file) { return std::fclose(file); });
  if (!motions_file.empty() && motions == nullptr) {
    std::fprintf(stderr, "pose_study: %s: cannot be written\n", motions_file.c_str());
    return 2;
  }
  fmt::print(
      "| drive | driven | odometry: end, rms | SLAM: end, rms | POSE: end, rms | change of odometry's error in 1.5 s, "
      "rms "
      "| squared error over variance: POSE x, y, yaw | VO position, rotation |\n|---|---|---|---|---|---|---|---|\n");
  for (const std::string& run : runs) try {
      const Ends e = Drive(run, config_dir, loss, motions.get()).run();
      const auto percent = [&](double error_m) { return 100.0 * error_m / std::max(e.driven_m, 1.0); };
      fmt::print(
          "| {} | {:.1f} m | {:.2f} %, {:.3f} m | {:.2f} %, {:.3f} m | {:.2f} %, {:.3f} m | {:.4f} m "
          "| {:.2f}, {:.2f}, {:.2f} | {:.1f}, {:.1f} |\n",
          run, e.driven_m, percent(e.odometry_m), e.odometry_rms_m.value(), percent(e.slam_m), e.slam_rms_m.value(),
          percent(e.pose_m), e.pose_rms_m.value(), e.lag_m.value(), e.squares(0), e.squares(1), e.squares(2),
          e.visual_squares(0), e.visual_squares(1));
      std::fflush(stdout);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "pose_study: %s: %s\n", run.c_str(), error.what());
      return 2;
    }
}
