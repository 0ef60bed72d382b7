// Services that the geometric tier of perception replaces: they publish at the same message times what stereo,
// visual_odometry and point_cloud would measure, from exposures at true poses.
#pragma once

#include <Eigen/Geometry>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/bus/node.hpp"
#include "rover_simulator/camera/geometric_view.hpp"
#include "rover_simulator/simulated_rover.hpp"

namespace rover {

struct Exposure {
  Utime utime = kNever;
  Eigen::Isometry3d T_map_left = Eigen::Isometry3d::Identity();  // true left camera
};

// Exposures that wait for a stand-in.
class Exposures {
 public:
  void add(Utime utime, const Eigen::Isometry3d& T_map_left) { waiting_.push_back({utime, T_map_left}); }
  // The newest whose images would have arrived by now; removes it and the older ones.
  std::optional<Exposure> newest(Utime now);

 private:
  std::deque<Exposure> waiting_;
};

// What the stand-ins share, in the run's process.
struct GeometricPerception {
  GeometricPerception(const SimulatedRover& the_rover, const GroundAppearanceConfig& appearance, std::uint64_t the_seed)
      : rover(the_rover), seed(the_seed), view(the_rover.world(), appearance) {}

  const SimulatedRover& rover;
  std::uint64_t seed;
  GeometricView view;
  Exposures loccam;         // for stereo
  Exposures loccam_motion;  // the same, for visual odometry
  Exposures navcam;         // for point_cloud
};

std::shared_ptr<void> make_geometric_stereo(Node& node, const std::string& config_dir, GeometricPerception& perception);
std::shared_ptr<void> make_geometric_odometry(Node& node, const std::string& config_dir,
                                              GeometricPerception& perception);
std::shared_ptr<void> make_geometric_cloud(Node& node, const std::string& config_dir, GeometricPerception& perception);

}  // namespace rover
