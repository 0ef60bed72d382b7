#include "common/bus/channel_types.hpp"

#include <map>
#include <rover/cloud_t.hpp>
#include <rover/command_ack_t.hpp>
#include <rover/control_status_t.hpp>
#include <rover/correction_t.hpp>
#include <rover/disparity_t.hpp>
#include <rover/done_t.hpp>
#include <rover/drive_permit_t.hpp>
#include <rover/elevation_t.hpp>
#include <rover/fault_t.hpp>
#include <rover/ground_command_t.hpp>
#include <rover/hazards_t.hpp>
#include <rover/heartbeat_t.hpp>
#include <rover/image_t.hpp>
#include <rover/imu_t.hpp>
#include <rover/injection_t.hpp>
#include <rover/motion_command_t.hpp>
#include <rover/path_t.hpp>
#include <rover/planner_status_t.hpp>
#include <rover/pose_t.hpp>
#include <rover/ptu_command_t.hpp>
#include <rover/ptu_state_t.hpp>
#include <rover/service_state_t.hpp>
#include <rover/slam_pose_t.hpp>
#include <rover/slip_t.hpp>
#include <rover/supervisor_state_t.hpp>
#include <rover/tick_t.hpp>
#include <rover/traversability_t.hpp>
#include <rover/truth_t.hpp>
#include <rover/vo_motion_t.hpp>
#include <rover/wheel_command_t.hpp>
#include <rover/wheel_state_t.hpp>

#include "common/bus/channels.hpp"
#include "common/bus/message_fields.hpp"
#include "common/bus/streams.hpp"

namespace rover {
namespace {

template <class Message>
ChannelType carries() {
  return {Message::getTypeName(), Message::getHash(), [](const void* data, int size) {
            return peek_fingerprint(data, size) == Message::getHash() &&
                   is_whole_message(Message::getTypeName(), data, size);
          }};
}

const std::map<std::string, ChannelType>& types() {
  static const std::map<std::string, ChannelType> kTypes = {
      {channel::kTick, carries<tick_t>()},
      {channel::kDone, carries<done_t>()},
      {channel::kLocCamLeft, carries<image_t>()},
      {channel::kLocCamRight, carries<image_t>()},
      {channel::kNavCamLeft, carries<image_t>()},
      {channel::kNavCamRight, carries<image_t>()},
      {channel::kImu, carries<imu_t>()},
      {channel::kWheelState, carries<wheel_state_t>()},
      {channel::kPtuState, carries<ptu_state_t>()},
      {channel::kTruth, carries<truth_t>()},
      {channel::kLocCamRectLeft, carries<image_t>()},
      {channel::kLocCamRectRight, carries<image_t>()},
      {channel::kDisparity, carries<disparity_t>()},
      {channel::kVo, carries<vo_motion_t>()},
      {channel::kHazards, carries<hazards_t>()},
      {channel::kPose, carries<pose_t>()},
      {channel::kSlip, carries<slip_t>()},
      {channel::kPath, carries<path_t>()},
      {channel::kPlannerStatus, carries<planner_status_t>()},
      {channel::kMotionCommand, carries<motion_command_t>()},
      {channel::kControlStatus, carries<control_status_t>()},
      {channel::kWheelCommand, carries<wheel_command_t>()},
      {channel::kPtuCommand, carries<ptu_command_t>()},
      {channel::kCloud, carries<cloud_t>()},
      {channel::kSlamPose, carries<slam_pose_t>()},
      {channel::kElevation, carries<elevation_t>()},
      {channel::kTraversability, carries<traversability_t>()},
      {channel::kCorrection, carries<correction_t>()},
      {channel::kHeartbeat, carries<heartbeat_t>()},
      {channel::kDrivePermit, carries<drive_permit_t>()},
      {channel::kState, carries<supervisor_state_t>()},
      {channel::kFault, carries<fault_t>()},
      {channel::kServiceState, carries<service_state_t>()},
      {channel::kGroundCommand, carries<ground_command_t>()},
      {channel::kCommandAck, carries<command_ack_t>()},
      {channel::kGlobalPath, carries<path_t>()},
      {channel::kInject, carries<injection_t>()},
  };
  return kTypes;
}

}  // namespace

const ChannelType* find_channel_type(const std::string& channel) {
  const auto it = types().find(channel);
  return it == types().end() ? nullptr : &it->second;
}

std::vector<std::string> typed_channels() {
  std::vector<std::string> names;
  for (const auto& [name, type] : types()) names.push_back(name);
  return names;
}

}  // namespace rover
