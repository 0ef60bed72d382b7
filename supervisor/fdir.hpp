// Fault detection, isolation and recovery (FDIR): independent monitors built from config/fdir.yaml.
#pragma once

#include <string>
#include <vector>

#include "supervisor/monitor.hpp"
#include "supervisor/quantities.hpp"

namespace rover::supervisor {

// One line of the table; lines about motors or services expand to one monitor each.
struct FdirLine {
  MonitorRow row;
  std::string quantity;
};

struct FdirConfig {
  std::vector<FdirLine> lines;
  // The rover stops if one of these is missing.
  std::vector<std::string> required_services = {"stereo",       "visual_odometry",    "localization", "hazard_detector",
                                                "path_planner", "trajectory_control", "locomotion"};
  std::vector<std::string> optional_services = {"recorder", "mission_control", "global_localization"};
  // Required at the Full level.
  std::vector<std::string> full_services = {"point_cloud", "pan_tilt", "slam", "traversability"};
};

struct FaultChange {
  std::string id;
  Condition condition = Condition::kFalse;
  Response response = Response::kLog;
  double value = kNaN;
  double limit = kNaN;
  Utime visible_utime = kNever;
  bool active = false;
  bool first = false;
  std::string service;  // affected service, empty if none
};

class Fdir {
 public:
  // All quantities must be known (checked).
  explicit Fdir(const FdirConfig& config);

  // Returns raised and cleared faults in table order.
  std::vector<FaultChange> step(const MonitorContext& context, State state, Level level);
  // Ground command CLEAR_FAULT: the change (none if the fault is not active), or the reason why it was refused.
  struct Cleared {
    std::vector<FaultChange> change;
    std::string refusal_reason;
  };
  Cleared clear(const std::string& id, const MonitorContext& context);
  // Restores faults that were active before a restart; unknown ids are ignored.
  void restore(const std::vector<std::string>& ids);

  // Ids of active faults in the order of raising.
  const std::vector<std::string>& active() const { return active_; }
  // Active faults as change records, for periodic publication.
  std::vector<FaultChange> report() const;
  // True if an active fault has the response stop_backtrack.
  bool backtrack_requested() const;
  // First active fault that stops the rover, or that leads to SAFE; null if none.
  const Monitor* first_blocking() const;
  const Monitor* first_safe() const;
  // First row that stops the rover at `level` only and does so now; at another level: would do so by its reading. Null
  // if none.
  const Monitor* stops_only_at(Level level, Level now) const;
  // Lowest slow_mps of the active faults; infinity if none.
  double speed_limit_mps() const;
  // Services with an active restart_service fault.
  std::vector<std::string> services_to_restart() const;

 private:
  struct Entry {
    Monitor monitor;
    const Quantity* quantity;
    Subject subject;
  };
  void add(const FdirLine& line, const Quantity* quantity, const std::string& suffix, const Subject& subject);
  void expand(const FdirLine& line, const FdirConfig& config);
  const Entry* find(const std::string& id) const;
  static Reading read(const Entry& entry, const MonitorContext& context);
  FaultChange record(const Entry& entry);
  FaultChange change_of(const Entry& entry) const;
  template <class Fits>
  const Monitor* first_active(Fits fits) const;

  std::vector<Entry> entries_;
  std::vector<std::string> active_;
};

}  // namespace rover::supervisor
