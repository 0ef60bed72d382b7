#include "supervisor/fdir.hpp"

#include <algorithm>
#include <cmath>

#include "common/core/check.hpp"

namespace rover::supervisor {

Fdir::Fdir(const FdirConfig& config) {
  for (const FdirLine& line : config.lines) expand(line, config);
}

void Fdir::expand(const FdirLine& line, const FdirConfig& config) {
  const Quantity* quantity = find_quantity(line.quantity);
  ROVER_CHECK(quantity != nullptr, line.quantity);
  const auto each_service = [&](const std::vector<std::string>& services) {
    for (const std::string& service : services) add(line, quantity, "." + service, {service, 0});
  };
  const auto each_motor = [&](const auto& names) {
    for (size_t i = 0; i < names.size(); ++i)
      add(line, quantity, std::string(".") + names[i], {"", static_cast<int>(i)});
  };
  switch (quantity->expansion) {
    case Expansion::kOne:
      return add(line, quantity, "", {});
    case Expansion::kEachRequired:
      return each_service(config.required_services);
    case Expansion::kEachOptional:
      return each_service(config.optional_services);
    case Expansion::kEachFull:
      return each_service(config.full_services);
    case Expansion::kEachDrive:
      return each_motor(kDriveNames);
    case Expansion::kEachSteer:
      return each_motor(kSteerNames);
  }
}

void Fdir::add(const FdirLine& line, const Quantity* quantity, const std::string& suffix, const Subject& subject) {
  MonitorRow row = line.row;
  row.id += suffix;
  row.quantity = line.quantity;
  entries_.push_back({Monitor(row), quantity, subject});
}

Reading Fdir::read(const Entry& entry, const MonitorContext& context) {
  const MonitorRow& row = entry.monitor.row();
  const bool relaxed = row.response == Response::kStopBacktrack && context.backtracking;
  if (relaxed && std::isfinite(row.backtrack_limit)) {
    Reading out = entry.quantity->read(context, entry.subject, row.backtrack_limit);
    out.limit = row.backtrack_limit;
    return out;
  }
  Reading out = entry.quantity->read(context, entry.subject, row.limit);
  // Stale and invalid readings are not relaxed.
  if (relaxed && out.condition == Condition::kTrue) out.condition = Condition::kFalse;
  return out;
}

std::vector<FaultChange> Fdir::step(const MonitorContext& context, State state, Level level) {
  std::vector<FaultChange> changes;
  for (Entry& entry : entries_) {
    const MonitorRow& row = entry.monitor.row();
    const bool armed = row.armed.has(state) && row.level.value_or(level) == level;
    if (entry.monitor.step(context.utime, armed, read(entry, context))) changes.push_back(record(entry));
  }
  return changes;
}

FaultChange Fdir::change_of(const Entry& entry) const {
  const Monitor& m = entry.monitor;
  const bool first = !active_.empty() && active_.front() == m.row().id;
  return {
      m.row().id, m.reading().condition, m.row().response, m.reading().value, m.limit(), m.visible_utime(), m.active(),
      first,      entry.subject.service};
}

FaultChange Fdir::record(const Entry& entry) {
  const std::string& id = entry.monitor.row().id;
  const bool first = !active_.empty() && active_.front() == id;
  if (entry.monitor.active()) {
    active_.push_back(id);
    return change_of(entry);
  }
  std::erase(active_, id);
  FaultChange change = change_of(entry);
  change.first = first;
  return change;
}

const Fdir::Entry* Fdir::find(const std::string& id) const {
  const auto it =
      std::find_if(entries_.begin(), entries_.end(), [&](const Entry& w) { return w.monitor.row().id == id; });
  return it == entries_.end() ? nullptr : &*it;
}

Fdir::Cleared Fdir::clear(const std::string& id, const MonitorContext& context) {
  for (Entry& entry : entries_) {
    if (entry.monitor.row().id != id) continue;
    if (!entry.monitor.active()) return {};
    const Reading reading = read(entry, context);
    if (!entry.monitor.unlatch(reading)) return {{}, "the condition is still met"};
    return {{record(entry)}, ""};
  }
  return {{}, "no such fault"};
}

void Fdir::restore(const std::vector<std::string>& ids) {
  for (const std::string& id : ids)
    for (Entry& entry : entries_) {
      if (entry.monitor.row().id != id || entry.monitor.active()) continue;
      entry.monitor.restore_active();
      active_.push_back(id);
    }
}

std::vector<FaultChange> Fdir::report() const {
  std::vector<FaultChange> changes;
  for (const std::string& id : active_) changes.push_back(change_of(*find(id)));
  return changes;
}

template <class Fits>
const Monitor* Fdir::first_active(Fits fits) const {
  for (const std::string& id : active_) {
    const Monitor& monitor = find(id)->monitor;
    if (fits(monitor)) return &monitor;
  }
  return nullptr;
}

const Monitor* Fdir::first_blocking() const {
  return first_active([](const Monitor& m) { return m.blocks_motion(); });
}

const Monitor* Fdir::first_safe() const {
  return first_active([](const Monitor& m) { return m.row().response == Response::kSafe; });
}

const Monitor* Fdir::stops_only_at(Level level, Level now) const {
  const auto stops = [&](const Entry& entry) {
    const Monitor& m = entry.monitor;
    return m.row().level == level && m.row().stops_motion() && m.row().response != Response::kRestartService &&
           (level == now ? m.active() : m.reading().condition != Condition::kFalse);
  };
  const auto found = std::find_if(entries_.begin(), entries_.end(), stops);
  return found == entries_.end() ? nullptr : &found->monitor;
}

std::vector<std::string> Fdir::services_to_restart() const {
  std::vector<std::string> services;
  for (const std::string& id : active_) {
    const Entry& entry = *find(id);
    const bool bad = entry.monitor.reading().condition != Condition::kFalse;
    if (bad && entry.monitor.row().response == Response::kRestartService) services.push_back(entry.subject.service);
  }
  return services;
}

// An invalid reading requests none, because it shows no limit that backtracking may relax.
bool Fdir::backtrack_requested() const {
  return first_active([](const Monitor& m) {
           return m.row().response == Response::kStopBacktrack && m.reading().condition != Condition::kInvalid;
         }) != nullptr;
}

double Fdir::speed_limit_mps() const {
  double min_mps = kInfinity;
  for (const std::string& id : active_) min_mps = std::min(min_mps, find(id)->monitor.row().slow_mps);
  return min_mps;
}

}  // namespace rover::supervisor
