// Localization on the bus.
#pragma once

#include <rover/ground_command_t.hpp>
#include <rover/slam_pose_t.hpp>
#include <string>

#include "common/bus/checkpoint_store.hpp"
#include "common/bus/node.hpp"
#include "common/core/vehicle.hpp"
#include "localization/localization.hpp"

namespace rover::loc {

class LocalizationNode {
 public:
  LocalizationNode(Node& node, const LocalizationConfig& config, const Vehicle& vehicle);

 private:
  void subscribe_vehicle();  // IMU and wheels
  void subscribe();
  void on_ground_command(const ground_command_t& command);
  void on_step(Utime now);
  void publish();
  void report_status();
  void restore();
  void save();
  // Counts a rejected input.
  void check(const char* channel, std::string_view rejection);

  Node& node_;
  CheckpointStore checkpoint_;
  Localization localization_;
  PoseStatus status_ = PoseStatus::kOk;
  bool told_ = false;  // a pose that nobody repeats, since the last save
  std::string reason_;
  Utime next_slip_ = 0;
};

}  // namespace rover::loc
