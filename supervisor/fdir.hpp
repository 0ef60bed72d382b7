// Fault detection, isolation and recovery: the rows of config/fdir.yaml, each standing for itself, several at once.
#pragma once

#include <string>
#include <vector>

#include "supervisor/monitor.hpp"
#include "supervisor/quantities.hpp"

namespace rover::supervisor {

// One line of the table; a line about motors or services becomes a row for each.
struct FdirLine {
  MonitorRow row;
  std::string quantity;
};

struct FdirConfig {
  std::vector<FdirLine> lines;
  std::vector<std::string> required_services;  // without one of them the rover stands
  std::vector<std::string> optional_services;
  std::vector<std::string> full_services;  // required at the Full level
};

struct FaultChange {
  std::string id;
  Condition condition = Condition::kFalse;
  Response response = Response::kLog;
  double value = kNaN;
  double limit = kNaN;
  Utime visible_utime = kNever;
  bool standing = false;
  bool first = false;
  std::string service;  // whom the row is about
};

class Fdir {
 public:
  // Every quantity has to be known (checked).
  explicit Fdir(const FdirConfig& config);

  // Raised and cleared, in the table's order.
  std::vector<FaultChange> step(const Now& now, State state, Level level);
  // By ground command: the row's change, or why it was not cleared.
  struct Cleared {
    std::vector<FaultChange> change;
    std::string refusal;
  };
  Cleared clear(const std::string& id, const Now& now);
  // Those that stood before a restart of the supervisor. Names that the table does not know are left out.
  void restore(const std::vector<std::string>& ids);

  // Ids in the order in which they were raised.
  const std::vector<std::string>& standing() const { return standing_; }
  // The standing rows as they were raised, for those who missed it.
  std::vector<FaultChange> report() const;
  // Whether a row stands whose remedy is a way back.
  bool wants_retreat() const;
  // The first of those standing that stops the rover (for good); null: none.
  const Monitor* first_blocking() const;
  const Monitor* first_safe() const;
  // The most that the standing rows let the rover drive; infinity: none slows it.
  double speed_limit_mps() const;
  // Whom standing rows want to be started anew.
  std::vector<std::string> ailing_services() const;

 private:
  struct Watch {
    Monitor monitor;
    const Quantity* quantity;
    Subject subject;
  };
  void add(const FdirLine& line, const Quantity* quantity, const std::string& suffix, const Subject& subject);
  void expand(const FdirLine& line, const FdirConfig& config);
  const Watch* find(const std::string& id) const;
  static Reading read(const Watch& watch, const Now& now);
  FaultChange record(const Watch& watch);
  FaultChange change_of(const Watch& watch) const;
  template <class Fits>
  const Monitor* first_standing(Fits fits) const;

  std::vector<Watch> watches_;
  std::vector<std::string> standing_;
};

}  // namespace rover::supervisor
