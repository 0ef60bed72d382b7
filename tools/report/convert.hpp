// Converts messages to the run record.
#pragma once

#include <optional>
#include <rover/control_status_t.hpp>
#include <rover/correction_t.hpp>
#include <rover/drive_permit_t.hpp>
#include <rover/fault_t.hpp>
#include <rover/hazards_t.hpp>
#include <rover/heartbeat_t.hpp>
#include <rover/path_t.hpp>
#include <rover/planner_status_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/slam_pose_t.hpp>
#include <rover/slip_t.hpp>
#include <rover/supervisor_state_t.hpp>
#include <rover/traversability_t.hpp>
#include <rover/truth_t.hpp>
#include <rover/vo_motion_t.hpp>
#include <rover/wheel_state_t.hpp>

#include "tools/report/run_record.hpp"

namespace rover::report {

TruthSample truth_from(const truth_t& message);
PoseSample pose_from(const pose_t& message);
VisualSample visual_from(const vo_motion_t& message);
ControlSample control_from(const control_status_t& message);
WheelSample wheels_from(const wheel_state_t& message);
SlipSample slip_from(const slip_t& message);
StateChange state_from(const supervisor_state_t& message);
PathRecord path_from(const path_t& message);
HazardMap hazards_from(const hazards_t& message);
// Empty if the message contradicts itself. MARGIN is kUnseen: it covers measured and hidden ground.
std::optional<PassabilityMap> passability_from(const hazards_t& message);
std::optional<PassabilityMap> passability_from(const traversability_t& message);
PlannerSample planner_from(const planner_status_t& message);
FaultRecord fault_from(const fault_t& message);
CorrectionRecord correction_from(const correction_t& message);
SlamSample slam_from(const slam_pose_t& message);
void add_heartbeat(const heartbeat_t& message, std::map<std::string, ServiceRecord>& services);

}  // namespace rover::report
