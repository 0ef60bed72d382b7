// Stand-ins of hazard_detector and traversability: the same messages at the same times, made from the true surface.
// They read TRUTH, so benches alone may use them.
#pragma once

#include <memory>
#include <string>

#include "common/bus/node.hpp"
#include "tools/truth_perception/true_surface.hpp"

namespace rover::truth {

// Shared by both nodes of a run.
struct TruthPerception {
  std::shared_ptr<TrueSurface> surface;
  std::string config_dir;
};

// HAZARDS of each LocCam exposure, from TRUTH alone.
std::shared_ptr<void> make_truth_hazards(Node& node, const TruthPerception& perception);
// TRAVERSABILITY of each ELEVATION; CLOUD says where the NavCam looked, POSE and TRUTH place odom in the world.
std::shared_ptr<void> make_truth_traversability(Node& node, const TruthPerception& perception);

}  // namespace rover::truth
