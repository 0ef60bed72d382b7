#include "visual_odometry/node.hpp"

#include <cmath>
#include <opencv2/core.hpp>
#include <rover/vo_motion_t.hpp>
#include <string>

#include "common/bus/convert.hpp"
#include "common/core/state_bytes.hpp"
#include "visual_odometry/convert.hpp"

namespace rover::vo {
namespace {

const char* to_string(Status status) {
  static constexpr const char* kNames[] = {"OK", "DEGRADED", "LOST", "DISPLACED"};
  return kNames[static_cast<int>(status)];
}

}  // namespace

OdometryNode::OdometryNode(Node& node, const NodeConfig& config)
    : node_(node), checkpoint_(node), odometry_(config.odometry), gyro_(to_utime(config.gyro_history_s)) {
  cv::setNumThreads(1);
  const Utime latency = to_utime(config.latency_s);
  node_.subscribe<imu_t>(channel::kImu, [this](const imu_t& m) { on_imu(m); });
  node_.subscribe_slow<image_t>(channel::kLocCamRectLeft, latency,
                                [this](const image_t& m) { on_image(channel::kLocCamRectLeft, m, left_); });
  node_.subscribe_slow<image_t>(channel::kLocCamRectRight, latency,
                                [this](const image_t& m) { on_image(channel::kLocCamRectRight, m, right_); });
  node_.subscribe_slow<disparity_t>(channel::kDisparity, latency, [this](const disparity_t& m) { on_disparity(m); });
  node_.on_step([this](Utime) { checkpoint_.publish_restored(); });
  restore();
}

void OdometryNode::on_imu(const imu_t& message) {
  // A faulty or missing IMU leaves a gap in the gyro buffer: the motion is then predicted without gyro.
  if (message.status != imu_t::OK) return;
  if (!gyro_.add(gyro_from(message))) node_.reject(channel::kImu, "increment not finite, out of range or out of order");
}

void OdometryNode::on_image(const char* channel, const image_t& message, std::optional<Stamped<GrayImage>>& slot) {
  GrayImage image = image_from(message);
  if (image.data.empty()) return node_.reject(channel, "size or encoding contradicts itself");
  slot = {message.header.utime, std::move(image)};
  step_if_complete();
}

void OdometryNode::on_disparity(const disparity_t& message) {
  Disparity disparity = disparity_from(message);
  if (disparity.px16.empty()) return node_.reject(channel::kDisparity, "size contradicts itself");
  const StereoCamera camera = camera_from(message);
  if (!is_valid(camera)) return node_.reject(channel::kDisparity, "camera not finite or out of range");
  disparity_ = {message.header.utime, {std::move(disparity), camera}};
  step_if_complete();
}

void OdometryNode::step_if_complete() {
  if (!left_ || !right_ || !disparity_) return;
  const Utime utime = left_->utime;
  if (right_->utime != utime || disparity_->utime != utime) return;
  StereoFrame frame{utime,
                    std::move(left_->content),
                    std::move(right_->content),
                    std::move(disparity_->content.disparity),
                    disparity_->content.camera,
                    std::nullopt};
  left_.reset();
  right_.reset();
  disparity_.reset();
  if (utime <= newest_utime_) return node_.reject(channel::kDisparity, "older than a pair already used");
  if (!sizes_match(frame)) return node_.reject(channel::kDisparity, "not of the size of the images");
  newest_utime_ = utime;
  if (odometry_.previous_utime() != kNever) frame.R_prev_cur = gyro_.rotation(odometry_.previous_utime(), utime);
  if (const auto result = odometry_.step(frame)) publish(*result);
}

void OdometryNode::publish(const OdometryResult& result) {
  vo_motion_t message{};
  motion_to(result, message);
  node_.publish(channel::kVo, message, result.utime);
  if (checkpoint_.due() || result.status != status_) save();
  if (result.status == status_) return;
  status_ = result.status;
  node_.set_status(status_ == Status::kOk ? heartbeat_t::OK : heartbeat_t::DEGRADED,
                   status_ == Status::kOk ? "" : std::string("odometry ") + to_string(status_));
  node_.log(status_ == Status::kOk ? "INFO" : "WARN", std::string("VO_STATUS status=") + to_string(status_) +
                                                          " inliers=" + std::to_string(result.inliers) +
                                                          " features=" + std::to_string(result.features));
}

void OdometryNode::restore() {
  checkpoint_.restore([this](const CheckpointStore::Bytes& bytes) {
    StateReader in(bytes);
    const auto evidence = in.get<OffsetEvidence>();
    if (!in.finished() || !std::isfinite(evidence.information + evidence.gradient)) return false;
    odometry_.restore(evidence);
    return true;
  });
}

void OdometryNode::save() {
  StateWriter out;
  out.put(odometry_.offset_evidence());
  checkpoint_.save(out.take());
}

}  // namespace rover::vo
