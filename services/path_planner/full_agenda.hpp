// The order in which the Full level looks for a plan, kept from frame to frame as that of a repair (repair_agenda.hpp):
// what is known of the ground is taken for less and less, and each time the lattice is asked again in other ways.
#pragma once

#include <cstdint>

#include "path_planner/full_planner.hpp"

namespace rover::planning {

class FullAgenda {
 public:
  enum class Ground : std::uint8_t {
    kKnown,
    kLeastTurns,     // point turns with the least margin
    kAfarDoubted,    // small spots of the map never seen from near do not count
    kSeenFreeSpots,  // no small spot counts that the LocCam saw free
    kEnd
  };

  Ground ground() const { return ground_; }
  LatticeUse lattice() const { return lattice_; }
  bool begun() const { return ground_ != Ground::kKnown || lattice_ != LatticeUse::kLenient; }

  // To the next search after one that found nothing. False at the end; the agenda then stands at its beginning.
  bool advance(const FullPlan& failed) {
    const bool sure_next = lattice_ == LatticeUse::kLenient && !failed.hopeless;
    const bool hasty_next = lattice_ == LatticeUse::kSure && exhausted_;
    exhausted_ = sure_next && failed.exhausted;
    lattice_ = sure_next ? LatticeUse::kSure : hasty_next ? LatticeUse::kHasty : LatticeUse::kLenient;
    if (lattice_ == LatticeUse::kLenient) ground_ = static_cast<Ground>(static_cast<int>(ground_) + 1);
    if (ground_ != Ground::kEnd) return true;
    restart();
    return false;
  }

  void restart() { *this = FullAgenda(); }

 private:
  Ground ground_ = Ground::kKnown;
  LatticeUse lattice_ = LatticeUse::kLenient;
  bool exhausted_ = false;  // the lenient lattice led on for longer than the search went
};

}  // namespace rover::planning
