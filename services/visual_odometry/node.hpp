// Visual odometry on the bus: LOCCAM_RECT_LEFT, LOCCAM_RECT_RIGHT, DISPARITY and IMU in, VO out.
#pragma once

#include <optional>
#include <rover/disparity_t.hpp>
#include <rover/image_t.hpp>
#include <rover/imu_t.hpp>

#include "common/bus/checkpoint_store.hpp"
#include "common/bus/node.hpp"
#include "visual_odometry/config.hpp"
#include "visual_odometry/odometry.hpp"
#include "visual_odometry/rotation_buffer.hpp"

namespace rover::vo {

class OdometryNode {
 public:
  OdometryNode(Node& node, const NodeConfig& config);

 private:
  template <class Content>
  struct Stamped {
    Utime utime = kNever;
    Content content;
  };
  struct DisparityInput {
    Disparity disparity;
    StereoCamera camera;
  };

  void on_imu(const imu_t& message);
  void on_image(const char* channel, const image_t& message, std::optional<Stamped<GrayImage>>& slot);
  void on_disparity(const disparity_t& message);
  void step_if_complete();
  void publish(const OdometryResult& result);
  void restore();
  void save();

  Node& node_;
  CheckpointStore checkpoint_;
  Odometry odometry_;
  RotationBuffer gyro_;
  std::optional<Stamped<GrayImage>> left_;
  std::optional<Stamped<GrayImage>> right_;
  std::optional<Stamped<DisparityInput>> disparity_;
  Utime newest_utime_ = kNever;
  Status status_ = Status::kOk;
};

}  // namespace rover::vo
