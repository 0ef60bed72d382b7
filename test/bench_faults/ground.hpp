// The operator: sends zigzag paths, start and stop commands, and clears latched faults.
#pragma once

#include <lcm/lcm-cpp.hpp>
#include <random>
#include <rover/ground_command_t.hpp>

#include "common/bus/streams.hpp"
#include "test/bench_faults/observer.hpp"
#include "test/bench_faults/stand_in_rover.hpp"

namespace rover::bench_faults {

enum class Wish { kDrive, kStand };

class Ground {
 public:
  Ground(lcm::LCM& bus, const Observer& seen, const StandInRover& rover, Field& field, std::uint64_t seed)
      : bus_(bus), seen_(seen), rover_(rover), field_(field), random_(seed) {}

  // At most one command per 0.5 s.
  void step();
  void set_time(Utime now) { now_ = now; }
  void wish(Wish wish) { wish_ = wish; }
  void command(std::int8_t kind, const std::string& target = "", std::int8_t level = ground_command_t::AUTO);
  // Starts at the rover, with a keep-out under its front if wanted.
  void give_path(bool forbid_front = false);
  void clear_path() { field_.remove_rocks(); }
  void enclose() { field_.enclose(rover_.pose()); }
  // Discards the path: the next drive starts with another one.
  void forget_path() { has_path_ = false; }

 private:
  void clear();
  void drive();
  void set_start_pose();
  bool stuck() const;
  template <class Message>
  void send(const char* channel, Message& message);

  lcm::LCM& bus_;
  const Observer& seen_;
  const StandInRover& rover_;
  Field& field_;
  std::mt19937_64 random_;
  StreamCounter streams_{"ground", 1};
  Wish wish_ = Wish::kDrive;
  Utime now_ = 0;
  std::int64_t command_id_ = 0;
  bool has_path_ = false;
  Pose2 moved_from_;
  Utime moved_at_ = 0;
};

}  // namespace rover::bench_faults
