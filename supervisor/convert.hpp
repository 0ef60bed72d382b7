// Conversion between LCM messages and the types of the core.
#pragma once

#include <rover/control_status_t.hpp>
#include <rover/drive_permit_t.hpp>
#include <rover/fault_t.hpp>
#include <rover/ground_command_t.hpp>
#include <rover/hazards_t.hpp>
#include <rover/heartbeat_t.hpp>
#include <rover/imu_t.hpp>
#include <rover/path_t.hpp>
#include <rover/planner_status_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/slam_pose_t.hpp>
#include <rover/slip_t.hpp>
#include <rover/supervisor_state_t.hpp>
#include <rover/traversability_t.hpp>
#include <rover/vo_motion_t.hpp>
#include <rover/wheel_state_t.hpp>

#include "supervisor/supervisor.hpp"

namespace rover::supervisor {

PoseReport report_from(const pose_t& message, double origin_height_m);
HazardsReport report_from(const hazards_t& message);
PlannerReport report_from(const planner_status_t& message);
ControlReport report_from(const control_status_t& message);
SlipReport report_from(const slip_t& message);
WheelReport report_from(const wheel_state_t& message);
ImuReport report_from(const imu_t& message);
// `body_odom`: newest body pose in the odom frame.
TerrainReport report_from(const traversability_t& message, const Pose2& body_odom);
SlamReport report_from(const slam_pose_t& message);
VisualReport report_from(const vo_motion_t& message);
ServiceReport report_from(const heartbeat_t& message);
PathLevels levels_from(const path_t& message);
GroundCommand command_from(const ground_command_t& message);

drive_permit_t message_of(const Permit& permit);
fault_t message_of(const FaultChange& change);
// `change`: the transition that led to the state.
supervisor_state_t state_message(const StateChange& change, Utime since, int hazard_stops,
                                 const std::vector<std::string>& faults);

}  // namespace rover::supervisor
