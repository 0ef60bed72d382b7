#include "common/bus/field_faults.hpp"

#include <map>
#include <rover/control_status_t.hpp>
#include <rover/disparity_t.hpp>
#include <rover/drive_permit_t.hpp>
#include <rover/hazards_t.hpp>
#include <rover/imu_t.hpp>
#include <rover/motion_command_t.hpp>
#include <rover/path_t.hpp>
#include <rover/planner_status_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/slip_t.hpp>
#include <rover/vo_motion_t.hpp>
#include <rover/wheel_command_t.hpp>
#include <rover/wheel_state_t.hpp>
#include <type_traits>

#include "common/bus/channels.hpp"
#include "common/bus/streams.hpp"

namespace rover {
namespace {

// One function for each type: shows every field of it to `visit(name, field)`.
template <class Visit>
void visit_fields(pose_t& m, Visit visit) {
  visit("position_odom_body_m", m.position_odom_body_m);
  visit("quat_odom_body_wxyz", m.quat_odom_body_wxyz);
  visit("position_map_odom_m", m.position_map_odom_m);
  visit("quat_map_odom_wxyz", m.quat_map_odom_wxyz);
  visit("covariance", m.covariance);
  visit("velocity_body_mps", m.velocity_body_mps);
  visit("rate_body_radps", m.rate_body_radps);
  visit("travelled_m", m.travelled_m);
}

template <class Visit>
void visit_fields(vo_motion_t& m, Visit visit) {
  visit("position_m", m.position_m);
  visit("quat_wxyz", m.quat_wxyz);
  visit("covariance", m.covariance);
  visit("reprojection_rms_px", m.reprojection_rms_px);
}

template <class Visit>
void visit_fields(imu_t& m, Visit visit) {
  visit("dt_s", m.dt_s);
  visit("delta_angle_rad", m.delta_angle_rad);
  visit("delta_velocity_mps", m.delta_velocity_mps);
  visit("fog_delta_yaw_rad", m.fog_delta_yaw_rad);
}

template <class Visit>
void visit_fields(wheel_state_t& m, Visit visit) {
  visit("drive_angle_rad", m.drive_angle_rad);
  visit("drive_rate_radps", m.drive_rate_radps);
  visit("drive_current_a", m.drive_current_a);
  visit("steer_angle_rad", m.steer_angle_rad);
  visit("steer_current_a", m.steer_current_a);
  visit("bogie_angle_rad", m.bogie_angle_rad);
}

template <class Visit>
void visit_fields(slip_t& m, Visit visit) {
  visit("window_s", m.window_s);
  visit("commanded_mps", m.commanded_mps);
  visit("wheel_mps", m.wheel_mps);
  visit("visual_mps", m.visual_mps);
  visit("slip_ratio", m.slip_ratio);
}

template <class Visit>
void visit_fields(control_status_t& m, Visit visit) {
  visit("arc_length_m", m.arc_length_m);
  visit("remaining_m", m.remaining_m);
  visit("cross_track_m", m.cross_track_m);
  visit("heading_error_rad", m.heading_error_rad);
  visit("predicted_corridor_error_m", m.predicted_corridor_error_m);
  visit("corridor_half_width_m", m.corridor_half_width_m);
}

template <class Visit>
void visit_fields(planner_status_t& m, Visit visit) {
  visit("blocked_in_m", m.blocked_in_m);
  visit("goal_distance_m", m.goal_distance_m);
  visit("corridor_offset_m", m.corridor_offset_m);
}

template <class Visit>
void visit_fields(hazards_t& m, Visit visit) {
  visit("coverage", m.coverage);
  visit("nearest_hazard_m", m.nearest_hazard_m);
  visit("plane_pitch_rad", m.plane_pitch_rad);
  visit("plane_roll_rad", m.plane_roll_rad);
  visit("cell_m", m.cell_m);
  visit("origin_x_m", m.origin_x_m);
  visit("origin_y_m", m.origin_y_m);
}

template <class Visit>
void visit_fields(disparity_t& m, Visit visit) {
  visit("focal_px", m.focal_px);
  visit("cx_px", m.cx_px);
  visit("cy_px", m.cy_px);
  visit("baseline_m", m.baseline_m);
  visit("position_body_cam_m", m.position_body_cam_m);
  visit("quat_body_cam_wxyz", m.quat_body_cam_wxyz);
  visit("valid_fraction", m.valid_fraction);
}

template <class Visit>
void visit_fields(path_t& m, Visit visit) {
  visit("corridor_half_width_m", m.corridor_half_width_m);
  visit("goal_tolerance_m", m.goal_tolerance_m);
  visit("x_m", m.x_m);
  visit("y_m", m.y_m);
}

template <class Visit>
void visit_fields(motion_command_t& m, Visit visit) {
  visit("speed_mps", m.speed_mps);
  visit("curvature_per_m", m.curvature_per_m);
  visit("turn_rate_radps", m.turn_rate_radps);
}

template <class Visit>
void visit_fields(wheel_command_t& m, Visit visit) {
  visit("drive_rate_radps", m.drive_rate_radps);
  visit("steer_angle_rad", m.steer_angle_rad);
}

template <class Visit>
void visit_fields(drive_permit_t& m, Visit visit) {
  visit("max_speed_mps", m.max_speed_mps);
}

using Bytes = std::vector<std::uint8_t>;
using Change = std::function<double(double)>;

struct Editor {
  std::vector<std::string> (*names)();
  Bytes (*edit)(const std::string& field, const Change& change, Bytes bytes);
};

template <class Message>
std::vector<std::string> names_in() {
  std::vector<std::string> names;
  Message message{};
  visit_fields(message, [&](const char* name, auto&) { names.emplace_back(name); });
  return names;
}

template <class Message>
Bytes edit_in(const std::string& field, const Change& change, Bytes bytes) {
  Message message;
  if (!decode_message(bytes.data(), static_cast<int>(bytes.size()), message)) return bytes;
  visit_fields(message, [&](const char* name, auto& value) {
    if (!field.empty() && field != name) return;
    using Value = std::remove_reference_t<decltype(value)>;
    if constexpr (std::is_floating_point_v<Value>) {
      value = static_cast<Value>(change(value));
    } else {
      for (auto& number : value) number = change(number);
    }
  });
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));  // only numbers changed, so the length is the same
  return bytes;
}

template <class Message>
Editor editor() {
  return {names_in<Message>, edit_in<Message>};
}

const Editor* find_editor(const std::string& channel) {
  static const std::map<std::string, Editor> kEditors = {
      {channel::kPose, editor<pose_t>()},
      {channel::kVo, editor<vo_motion_t>()},
      {channel::kImu, editor<imu_t>()},
      {channel::kWheelState, editor<wheel_state_t>()},
      {channel::kSlip, editor<slip_t>()},
      {channel::kControlStatus, editor<control_status_t>()},
      {channel::kPlannerStatus, editor<planner_status_t>()},
      {channel::kHazards, editor<hazards_t>()},
      {channel::kDisparity, editor<disparity_t>()},
      {channel::kPath, editor<path_t>()},
      {channel::kGlobalPath, editor<path_t>()},
      {channel::kMotionCommand, editor<motion_command_t>()},
      {channel::kWheelCommand, editor<wheel_command_t>()},
      {channel::kDrivePermit, editor<drive_permit_t>()},
  };
  const auto it = kEditors.find(channel);
  return it == kEditors.end() ? nullptr : &it->second;
}

}  // namespace

FieldTarget split_field(const std::string& target) {
  const size_t dot = target.find('.');
  if (dot == std::string::npos) return {target, ""};
  return {target.substr(0, dot), target.substr(dot + 1)};
}

std::vector<std::string> fields_of(const std::string& channel) {
  const Editor* editor = find_editor(channel);
  return editor == nullptr ? std::vector<std::string>{} : editor->names();
}

Bytes change_fields(const FieldTarget& at, const Change& change, Bytes bytes) {
  const Editor* editor = find_editor(at.channel);
  return editor == nullptr ? bytes : editor->edit(at.field, change, std::move(bytes));
}

}  // namespace rover
