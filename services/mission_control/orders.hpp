// The ground's orders for one traverse, given one after the other: start pose, global path, go. Each waits for its
// acknowledgement, is given again where none comes, and is tried again for a while where it is refused.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/core/frames.hpp"
#include "common/core/time.hpp"

namespace rover {

// Where the ground believes the rover to stand, and how sure it is.
struct StartPose {
  Pose2 pose;
  double z_m = 0.0;
  double sigma_m = 0.1;
  double sigma_yaw_rad = 0.02;
  double clear_radius_m = 1.5;  // certified as free of hazards: the ground under the rover is never seen
};

struct GlobalPath {
  std::vector<double> x_m;  // map
  std::vector<double> y_m;
  std::vector<std::int8_t> level;
  double corridor_half_width_m = 1.5;
  double goal_tolerance_m = 0.5;
};

enum class Order { kStartPose, kPath, kGo };

class Orders {
 public:
  struct Given {
    Order order;
    std::int64_t command_id;
  };

  // The order to give at this time, if any. `standby`: the supervisor's state allows to go. `command_id`: not given
  // to any command before; taken where there is an order.
  std::optional<Given> step(Utime now, bool standby, std::int64_t command_id);
  // Whether it was an answer to the order that waits.
  bool acknowledge(std::int64_t command_id, bool accepted, const std::string& reason);

  // The order that is next, or waits for its answer; of no meaning when all are accepted.
  Order waiting() const { return next_; }
  bool all_accepted() const { return next_ > Order::kGo; }
  // The operator has taken over: nothing more is given.
  void abandon() { next_ = static_cast<Order>(static_cast<int>(Order::kGo) + 1); }
  // Over restarts of the process. A number that is none of progress() begins anew.
  int progress() const { return static_cast<int>(next_); }
  void resume_at(int progress);
  // Why the last order was refused, empty where it was not.
  const std::string& refusal() const { return refusal_; }

 private:
  Order next_ = Order::kStartPose;
  std::int64_t command_id_ = 0;
  Utime given_at_ = kNever;
  std::string refusal_;
};

}  // namespace rover
