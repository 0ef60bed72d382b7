// A synthetic drive at the Full level as bus messages, to view the page without services or simulator.
#pragma once

#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <rover/elevation_t.hpp>
#include <string>
#include <vector>

#include "common/core/frames.hpp"
#include "common/core/time.hpp"
#include "rover_simulator/world/world.hpp"

namespace rover::mission::test {

class MadeUpDrive {
 public:
  MadeUpDrive(lcm::LCM& bus, std::vector<std::string> services);

  // Publishes the messages of a driving rover at this tick.
  void say(Utime now);
  // The terrain of the drive.
  const World& world() const { return world_; }
  // The driven path in map.
  static Pose2 pose_at(double distance_m);

 private:
  template <class Message>
  void publish(const char* channel, Message message, Utime utime);
  void say_motion(Utime now);
  void say_supervision(Utime now);
  void say_paths(Utime now);
  void say_terrain(Utime now);
  void say_hazards(Utime now);
  void say_images(Utime now);
  void say_slam(Utime now);
  elevation_t elevation() const;
  bool seen(double x_m, double y_m) const;
  double distance_m(Utime now) const;

  lcm::LCM& bus_;
  std::vector<std::string> services_;
  World world_;
  double travelled_m_ = 0.0;
  std::vector<Pose2> stations_;  // on the last metres, from where the ground was seen
};

}  // namespace rover::mission::test
