// Bus node: one TRAVERSABILITY per ELEVATION. Idle without elevation maps, as at the Efficient level.
#pragma once

#include <memory>
#include <rover/elevation_t.hpp>
#include <rover/pose_t.hpp>
#include <string>

#include "common/bus/node.hpp"
#include "traversability/config.hpp"

namespace rover::trav {

class TraversabilityNode {
 public:
  TraversabilityNode(Node& node, const NodeConfig& config);
  TraversabilityNode(const TraversabilityNode&) = delete;
  TraversabilityNode& operator=(const TraversabilityNode&) = delete;

 private:
  void on_elevation(const elevation_t& message);
  std::string rejection_of(const elevation_t& message) const;
  Pose2 fresh_pose() const;
  void report_status(double difficulty);

  Node& node_;
  NodeConfig config_;
  Utime last_map_utime_ = kNever;
  pose_t pose_{};
  bool difficulty_known_ = true;  // in the newest map
};

std::shared_ptr<TraversabilityNode> make_traversability(Node& node, const std::string& config_dir);

}  // namespace rover::trav
