// Services in place of those that need pictures, or are no part of this bench: each publishes what it owes the others.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/bus/node.hpp"
#include "test/bench_faults/stand_in_rover.hpp"
#include "test/bench_faults/view.hpp"

namespace rover::bench_faults {

// What is broken about seeing.
struct Blindness {
  // Of the pixels that are measured in the n-th picture since it began; empty: all.
  std::function<double(int picture)> share;
  int pictures = 0;
  bool visual_lost = false;
  bool slam_lost = false;
};

// DISPARITY of each exposure.
std::shared_ptr<void> make_stereo(Node& node, const StandInRover& rover, Field& field, const View& view,
                                  Blindness& blindness);
// VO between exposures, exact but for its stated covariance.
std::shared_ptr<void> make_visual_odometry(Node& node, const StandInRover& rover, const Blindness& blindness);
// SLAM_POSE that agrees with the odometry.
std::shared_ptr<void> make_slam(Node& node, const Blindness& blindness);
// TRAVERSABILITY of easy ground around the newest POSE.
std::shared_ptr<void> make_traversability(Node& node);
// Heartbeats alone.
std::shared_ptr<void> make_silent(Node& node);

}  // namespace rover::bench_faults
