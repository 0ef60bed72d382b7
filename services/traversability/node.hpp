// The bus side of the traversability map: a TRAVERSABILITY for each ELEVATION. Without elevation maps, as in the
// Efficient level, it rests.
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
  void take(const elevation_t& message);
  std::string refusal_of(const elevation_t& message) const;
  Pose2 body() const;
  void report(double difficulty);

  Node& node_;
  NodeConfig config_;
  Utime last_map_ = kNever;
  pose_t pose_{};
  bool judged_ = true;  // the ground ahead, in the newest map
};

std::shared_ptr<TraversabilityNode> make_traversability(Node& node, const std::string& config_dir);

}  // namespace rover::trav
