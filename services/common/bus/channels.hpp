// All channels of the bus with their message types.
#pragma once

namespace rover::channel {

// World and barrier.
inline constexpr char kTick[] = "TICK";                 // tick_t
inline constexpr char kDone[] = "DONE";                 // done_t
inline constexpr char kLocCamLeft[] = "LOCCAM_LEFT";    // image_t
inline constexpr char kLocCamRight[] = "LOCCAM_RIGHT";  // image_t
inline constexpr char kNavCamLeft[] = "NAVCAM_LEFT";    // image_t
inline constexpr char kNavCamRight[] = "NAVCAM_RIGHT";  // image_t
inline constexpr char kImu[] = "IMU";                   // imu_t
inline constexpr char kWheelState[] = "WHEEL_STATE";    // wheel_state_t
inline constexpr char kPtuState[] = "PTU_STATE";        // ptu_state_t
inline constexpr char kTruth[] = "TRUTH";               // truth_t, judges only

// Efficient Navigation.
inline constexpr char kLocCamRectLeft[] = "LOCCAM_RECT_LEFT";    // image_t
inline constexpr char kLocCamRectRight[] = "LOCCAM_RECT_RIGHT";  // image_t
inline constexpr char kDisparity[] = "DISPARITY";                // disparity_t
inline constexpr char kVo[] = "VO";                              // vo_motion_t
inline constexpr char kHazards[] = "HAZARDS";                    // hazards_t
inline constexpr char kPose[] = "POSE";                          // pose_t
inline constexpr char kSlip[] = "SLIP";                          // slip_t
inline constexpr char kPath[] = "PATH";                          // path_t
inline constexpr char kPlannerStatus[] = "PLANNER_STATUS";       // planner_status_t
inline constexpr char kMotionCommand[] = "MOTION_COMMAND";       // motion_command_t
inline constexpr char kControlStatus[] = "CONTROL_STATUS";       // control_status_t
inline constexpr char kWheelCommand[] = "WHEEL_COMMAND";         // wheel_command_t

// Full Navigation.
inline constexpr char kPtuCommand[] = "PTU_COMMAND";         // ptu_command_t
inline constexpr char kCloud[] = "CLOUD";                    // cloud_t
inline constexpr char kSlamPose[] = "SLAM_POSE";             // slam_pose_t
inline constexpr char kElevation[] = "ELEVATION";            // elevation_t
inline constexpr char kTraversability[] = "TRAVERSABILITY";  // traversability_t
inline constexpr char kCorrection[] = "CORRECTION";          // correction_t

// Supervision and ground.
inline constexpr char kHeartbeat[] = "HEARTBEAT";           // heartbeat_t
inline constexpr char kDrivePermit[] = "DRIVE_PERMIT";      // drive_permit_t
inline constexpr char kState[] = "STATE";                   // supervisor_state_t
inline constexpr char kFault[] = "FAULT";                   // fault_t
inline constexpr char kServiceState[] = "SERVICE_STATE";    // service_state_t
inline constexpr char kGroundCommand[] = "GROUND_COMMAND";  // ground_command_t
inline constexpr char kCommandAck[] = "COMMAND_ACK";        // command_ack_t
inline constexpr char kGlobalPath[] = "GLOBAL_PATH";        // path_t
inline constexpr char kInject[] = "INJECT";                 // injection_t

}  // namespace rover::channel
