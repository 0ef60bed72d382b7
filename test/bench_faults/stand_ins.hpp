// Replacements of services that need images or are not tested here: each publishes the messages the others require.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/bus/node.hpp"
#include "test/bench_faults/stand_in_rover.hpp"
#include "test/bench_faults/view.hpp"

namespace rover::bench_faults {

// Defects of the cameras.
struct Blindness {
  // Fraction of valid pixels in the n-th image since the start; empty: all.
  std::function<double(int picture)> share;
  int pictures = 0;
  bool visual_lost = false;
  bool displaced = false;
  bool slam_lost = false;
};

// DISPARITY of each exposure.
std::shared_ptr<void> make_stereo(Node& node, const StandInRover& rover, Field& field, const View& view,
                                  Blindness& blindness);
// Exact VO between exposures, with a covariance.
std::shared_ptr<void> make_visual_odometry(Node& node, const StandInRover& rover, const Blindness& blindness);
// SLAM_POSE equal to the odometry.
std::shared_ptr<void> make_slam(Node& node, const Blindness& blindness);
// TRAVERSABILITY of easy terrain around the newest POSE.
std::shared_ptr<void> make_traversability(Node& node);
// Only heartbeats.
std::shared_ptr<void> make_silent(Node& node);

}  // namespace rover::bench_faults
