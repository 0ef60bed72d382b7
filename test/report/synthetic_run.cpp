#include "synthetic_run.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <rover/control_status_t.hpp>
#include <rover/drive_permit_t.hpp>
#include <rover/hazards_t.hpp>
#include <rover/heartbeat_t.hpp>
#include <rover/path_t.hpp>
#include <rover/planner_status_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/slip_t.hpp>
#include <rover/supervisor_state_t.hpp>
#include <rover/truth_t.hpp>
#include <rover/vo_motion_t.hpp>
#include <rover/wheel_state_t.hpp>

#include "common/bus/channels.hpp"
#include "common/bus/convert.hpp"
#include "message_log.hpp"
#include "tools/report/polyline.hpp"
#include "tools/report/track.hpp"

namespace rover::report {
namespace {

constexpr double kOriginHeightM = 0.62;
constexpr double kSwerveM = 1.2;  // lateral
constexpr double kSwerveLengthM = 1.4;
constexpr double kSightM = 2.6;  // detection range ahead

class Writer {
 public:
  Writer(const SyntheticRun& run, const std::string& dir) : run_(run), log_(dir + "/traverse.lcm") {}

  void write() {
    state(supervisor_state_t::STANDBY, 0);
    path(channel::kGlobalPath, path_t::GLOBAL, path_t::MAP, 1, run_.planned, 0, "mission_control");
    const double length = length_m(run_.planned);
    Utime t = 0;
    for (; t < 1'000'000; t += kTickUs) tick(t, 0.0);
    state(supervisor_state_t::DRIVING, t);
    double s = 0.0;
    for (; s < length; t += kTickUs, s += run_.speed_mps * 0.02) {
      repair_when_due(t, s);
      tick(t, s);
    }
    state(supervisor_state_t::GOAL_REACHED, t);
    const Utime end = t + to_utime(run_.final_s);
    for (; t < end; t += kTickUs) tick(t, length);
  }

 private:
  Eigen::Vector2d on_path(double s, bool swerving) const {
    const Points start = part_ahead(run_.planned, run_.planned.front(), s);
    const Points further = part_ahead(run_.planned, run_.planned.front(), s + 0.1);
    const Eigen::Vector2d along = (further.back() - (s > 0.0 ? start.back() : run_.planned.front())).normalized();
    double aside = 0.0;
    for (const double at : run_.swerves_m) {
      const double u = (s - at) / kSwerveLengthM;
      if (swerving) aside += kSwerveM * std::exp(-0.5 * u * u);
    }
    const Eigen::Vector2d left(-along.y(), along.x());
    return start.back() + aside * (std::isfinite(left.x()) ? left : Eigen::Vector2d::Zero());
  }

  Eigen::Isometry3d true_pose(double s) const {
    const Eigen::Vector2d p = on_path(s, true);
    const Eigen::Vector2d back = on_path(std::max(0.0, s - 0.05), true);
    const Eigen::Vector2d front = on_path(s + 0.05, true);
    const double yaw = std::atan2(front.y() - back.y(), front.x() - back.x());
    const double c = std::cos(yaw);
    const double sn = std::sin(yaw);
    const auto h = [&](double dx, double dy) {
      return run_.height_m(p.x() + c * dx - sn * dy, p.y() + sn * dx + c * dy);
    };
    const double pitch = -std::atan2(h(0.75, 0.0) - h(-0.75, 0.0), 1.5);
    const double roll = std::atan2(h(0.0, 0.41) - h(0.0, -0.41), 0.82);
    return make_pose(rotation_from_rpy(roll, pitch, yaw), {p.x(), p.y(), h(0.0, 0.0) + kOriginHeightM});
  }

  // odom starts at the start pose; its error grows to the left of the straight line to the goal.
  Eigen::Isometry3d estimated_in_map(double s) const {
    Eigen::Isometry3d T = true_pose(s);
    const Eigen::Vector2d way = (run_.planned.back() - run_.planned.front()).normalized();
    T.translation().head<2>() += Eigen::Vector2d(-way.y(), way.x()) * (run_.drift_percent / 100.0 * driven_m_);
    return T;
  }

  void tick(Utime t, double s) {
    const Eigen::Isometry3d T = true_pose(s);
    driven_m_ += s > 0.0 ? (T.translation() - last_).head<2>().norm() : 0.0;
    last_ = T.translation();
    put_truth(t, T);
    put_pose(t, s);
    put_wheels(t, s);
    if (t % 400'000 == 0) put_hazards(t, T);
    if (t % 100'000 == 0) put_slow(t);
  }

  void put_truth(Utime t, const Eigen::Isometry3d& T) {
    truth_t m{};
    pose_to(T, m.position_map_body_m, m.quat_map_body_wxyz);
    m.velocity_map_mps[0] = run_.speed_mps + 0.01 * std::sin(1e-6 * static_cast<double>(t));
    std::fill_n(m.wheel_slip, 6, 0.04 + 0.03 * std::sin(2e-7 * static_cast<double>(t)));
    m.clearance_m = 0.24 + 0.04 * std::sin(3e-7 * static_cast<double>(t));
    log_.put(channel::kTruth, m, t, "rover_simulator");
  }

  void put_pose(Utime t, double s) {
    pose_t pose{};
    const Eigen::Isometry3d T_map_odom = true_pose(0.0);
    pose_to(T_map_odom.inverse() * estimated_in_map(s), pose.position_odom_body_m, pose.quat_odom_body_wxyz);
    pose_to(T_map_odom, pose.position_map_odom_m, pose.quat_map_odom_wxyz);
    log_.put(channel::kPose, pose, t, "localization", kTickUs);
    control_status_t control{};
    control.state = s > 0.0 ? control_status_t::FOLLOWING : control_status_t::IDLE;
    control.path_id = path_id_;
    control.cross_track_m = 0.03 * std::sin(4e-7 * static_cast<double>(t));
    log_.put(channel::kControlStatus, control, t, "trajectory_control", kTickUs);
    planner_status_t planner{};
    planner.state = planner_status_t::FOLLOWING;
    planner.replans = replans_;
    log_.put(channel::kPlannerStatus, planner, t, "path_planner", kTickUs);
  }

  void put_wheels(Utime t, double s) {
    wheel_state_t wheels{};
    for (int i = 0; i < 6; ++i) wheels.drive_rate_radps[i] = s > 0.0 ? run_.speed_mps / 0.125 : 0.0;
    for (int i = 0; i < 6; ++i)
      wheels.drive_current_a[i] = s > 0.0 ? 1.2 + 0.15 * i + 0.5 * std::sin(1e-6 * static_cast<double>(t) + i) : 0.0;
    log_.put(channel::kWheelState, wheels, t, "rover_simulator");
    drive_permit_t permit{};
    permit.granted = s > 0.0;
    permit.valid_until_utime = t + 200'000;
    log_.put(channel::kDrivePermit, permit, t, "supervisor", kTickUs);
    slip_t slip{};
    slip.valid = s > 0.0;
    slip.slip_ratio = 0.045 + 0.03 * std::sin(2e-7 * static_cast<double>(t) - 0.3);
    log_.put(channel::kSlip, slip, t, "localization", kTickUs);
  }

  void put_hazards(Utime t, const Eigen::Isometry3d& T) {
    constexpr int kCells = 40;
    hazards_t m{};
    m.cell_m = 0.1;
    m.origin_y_m = -2.0;
    m.cells_x = m.cells_y = kCells;
    m.size = kCells * kCells;
    m.cells.assign(kCells * kCells, static_cast<std::uint8_t>(hazards_t::FREE));
    m.coverage = 0.93F;
    for (int i = 0; i < m.size; ++i) {
      const HazardCell cell{{(i % kCells + 0.5) * 0.1, -2.0 + (i / kCells + 0.5) * 0.1}, false};
      if (cell.p_body.x() < 1.0 || cell.p_body.x() > kSightM) continue;
      const Eigen::Vector2d p = (T * Eigen::Vector3d(cell.p_body.x(), cell.p_body.y(), -kOriginHeightM)).head<2>();
      for (const Rock& rock : run_.rocks)
        if (rock.height_m >= 0.15 && std::hypot(p.x() - rock.x_m, p.y() - rock.y_m) < rock.radius_m)
          m.cells[static_cast<size_t>(i)] = static_cast<std::uint8_t>(hazards_t::OBSTACLE);
    }
    log_.put(channel::kHazards, m, t, "hazard_detector", 300'000);
    vo_motion_t vo{};
    vo.status = vo_motion_t::OK;
    log_.put(channel::kVo, vo, t, "visual_odometry", 200'000);
  }

  void put_slow(Utime t) {
    for (const char* name : {"stereo", "visual_odometry", "localization", "hazard_detector", "path_planner",
                             "trajectory_control", "locomotion", "supervisor", "recorder"}) {
      heartbeat_t heartbeat{};
      heartbeat.service = name;
      heartbeat.cpu_s = 1e-6 * static_cast<double>(t) * 0.02;
      heartbeat.rss_mb = 30.0;
      heartbeat.step_p50_ms = 1.5;
      heartbeat.step_p99_ms = 4.0;
      log_.put(channel::kHeartbeat, heartbeat, t, name, kTickUs);
    }
  }

  void state(std::int8_t value, Utime t) {
    supervisor_state_t m{};
    m.state = value;
    log_.put(channel::kState, m, t, "supervisor", 0);
  }

  void repair_when_due(Utime t, double s) {
    if (next_swerve_ >= run_.swerves_m.size() || s < run_.swerves_m[next_swerve_] - kSightM) return;
    ++next_swerve_;
    ++replans_;
    Points way;
    for (double u = s; u < s + 6.0; u += 0.1) way.push_back(on_path(u, true));
    const Pose2 map_from_odom = planar(true_pose(0.0));
    for (Eigen::Vector2d& p : way) p = transform(inverse(map_from_odom), p);
    path(channel::kPath, path_t::REPAIR, path_t::ODOM, ++path_id_, way, t, "path_planner");
  }

  void path(const char* channel, std::int8_t kind, std::int8_t frame, std::int64_t id, const Points& points, Utime t,
            const std::string& publisher) {
    path_t m{};
    m.path_id = id;
    m.kind = kind;
    m.frame = frame;
    m.point_count = static_cast<std::int32_t>(points.size());
    for (const Eigen::Vector2d& p : points) {
      m.x_m.push_back(p.x());
      m.y_m.push_back(p.y());
      m.level.push_back(std::int8_t{path_t::EFFICIENT});
      m.direction.push_back(std::int8_t{path_t::FORWARD});
    }
    log_.put(channel, m, t, publisher);
  }

  const SyntheticRun& run_;
  MessageLog log_;
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero();
  double driven_m_ = 0.0;
  std::int64_t path_id_ = 1;
  std::int32_t replans_ = 0;
  size_t next_swerve_ = 0;
};

}  // namespace

void write_synthetic_run(const SyntheticRun& run, const std::string& dir) {
  Writer(run, dir).write();
  std::ofstream(dir + "/run.json") << R"({"scenario":"synthetic","seed":3,"level":"auto","realtime":false})";
  std::ofstream(dir + "/simulation.json")
      << R"({"outcome":"goal_reached","deterministic":true,"simulated_s":100.0,"wall_s":20.0,"left":[]})";
}

}  // namespace rover::report
