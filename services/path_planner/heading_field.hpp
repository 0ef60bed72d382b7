// What is left to go from each place and heading: A* backwards from the goal line over a lattice of poses, for a
// vehicle that drives arcs no tighter than its own, forwards or stern first, and turns on the spot at a price. A field
// over places alone sends the rover into gaps that it cannot bend into; as what the way from the rover costs at least
// it tells the lattice where to look.
#pragma once

#include <cstdint>
#include <vector>

#include "path_planner/goal_field.hpp"

namespace rover::planning {

// What driving costs, beside the ground.
struct DrivingPrices {
  double max_curvature_per_m = 0.8;
  double curvature_cost = 0.15;  // per metre, at the largest curvature
  double turn_cost_m = 3.0;      // a point turn takes about 15 s, in which the rover could drive 3 m
  double turn_cost_per_rad_m = 1.0;
  double tight_factor = 2.0;       // of the cost, where only the tight margin is kept ...
  double squeeze_factor = 4.0;     // ... and where only the least is
  double tight_turn_factor = 3.0;  // likewise of a point turn's
  double back_factor = 1.5;        // of the cost, stern first
  double reversal_cost_m = 1.5;    // from ahead to astern, or back: the rover halts
};

struct HeadingQuery {
  const Terrain& terrain;
  const GoalField& goal;
  Footprint footprint;
  Pose2 rover;
  double roomy_margin_m = 0.0;
  double turn_margin_m = 0.0;  // for point turns; between the two
  double tight_margin_m = 0.0;
  double squeeze_margin_m = 0.0;  // the least
  // Less margin than that: gaps that a pose between the lattice's fits through stay open. Negative: only ways that
  // surely are ways.
  double slack_m = 0.0;
  bool may_back = true;  // stern first, over ground that was seen
};

class HeadingField {
 public:
  static constexpr int kHeadings = 32;
  static constexpr int kRoomHeadings = kHeadings / 2;  // the rectangle looks the same from behind

  HeadingField(const DrivingPrices& prices, const HeadingQuery& query);

  // The least of the lattice poses about this one; infinity: nothing leads on, or not within the field's reach.
  double to_go(const Pose2& pose) const { return least_about(pose, Motion::kDrive); }
  // Likewise for a rover that turns on the spot.
  double to_go_turning(const Pose2& pose) const { return least_about(pose, Motion::kTurn); }
  // Likewise for one that drives stern first.
  double to_go_backing(const Pose2& pose) const { return least_about(pose, Motion::kBack); }
  int settled() const { return settled_; }

 private:
  enum class Motion : std::uint8_t { kDrive = 0, kTurn = 1, kBack = 2 };
  static constexpr size_t kMotions = 3;
  enum Room : std::uint8_t { kRoomy, kTight, kTurnless, kSqueezed, kBlocked };  // each less than the one before
  struct Arc {
    int from_heading;
    int to_heading;
    int dx;  // cells
    int dy;
    int middle_dx;
    int middle_dy;
    int middle_heading;
    float length_m;
    float extra;  // cost beside the ground's
  };

  double least_about(const Pose2& pose, Motion motion) const;
  void make_arcs();
  void lay_rooms();
  using RoomLayers = std::vector<std::vector<std::uint8_t>>;  // one of all cells for each heading
  void stamp(double margin_m, Room room, RoomLayers& layers) const;
  void stamp_heading(int heading, double margin_m, Room room, const std::vector<int>& hazards,
                     std::vector<std::uint8_t>& layer) const;
  void seed();
  void spread();
  void offer(size_t state, float cost);
  void spread_driving(int cell, int heading, float cost);
  void spread_turning(int cell, int heading, float cost);
  void spread_backing(int cell, int heading, float cost);
  // Of an arc from the cell; infinity: not free, or outside.
  float arc_cost(int cell, const Arc& arc) const;
  // What is near on the ground is near in memory: the field is bound by how fast that is read.
  static size_t state_of(Motion motion, int cell, int heading) {
    return (static_cast<size_t>(cell) * kMotions + static_cast<size_t>(motion)) * kHeadings +
           static_cast<size_t>(heading);
  }
  Room room(int cell, int heading) const {
    return static_cast<Room>(rooms_[static_cast<size_t>(cell) * kRoomHeadings + heading % kRoomHeadings]);
  }
  float metre_cost(int cell, int heading) const;
  static double yaw_of(int heading) { return 2.0 * kPi * heading / kHeadings; }

  DrivingPrices prices_;
  HeadingQuery query_;
  const Terrain& terrain_;
  int cells_;
  size_t count_;
  std::vector<std::vector<Arc>> arcs_to_;    // by the heading at their end
  std::vector<std::vector<Arc>> arcs_from_;  // the same by the heading at their start
  std::vector<std::uint8_t> rooms_;          // cell by cell, of each heading
  std::vector<float> ground_;                // cost per metre by cell
  std::vector<float> from_rover_;            // what the way from the rover costs at least, by cell
  std::vector<float> cost_;                  // of each state
  std::vector<bool> done_;                   // likewise: has been spread, at that cost
  size_t bucket_ = 0;                        // that is being worked off
  std::vector<std::vector<std::uint32_t>> buckets_;
  int settled_ = 0;
};

}  // namespace rover::planning
