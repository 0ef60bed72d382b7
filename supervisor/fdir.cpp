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
  watches_.push_back({Monitor(row), quantity, subject});
}

Reading Fdir::read(const Watch& watch, const Now& now) {
  const MonitorRow& row = watch.monitor.row();
  const bool relaxed = row.response == Response::kStopRetreat && now.way_back;
  if (relaxed && std::isfinite(row.back_limit)) {
    Reading out = watch.quantity->read(now, watch.subject, row.back_limit);
    out.limit = row.back_limit;
    return out;
  }
  Reading out = watch.quantity->read(now, watch.subject, row.limit);
  // What is not known or not a number is no better on the way back.
  if (relaxed && out.condition == Condition::kTrue) out.condition = Condition::kFalse;
  return out;
}

std::vector<FaultChange> Fdir::step(const Now& now, State state, Level level) {
  std::vector<FaultChange> changes;
  for (Watch& watch : watches_) {
    const MonitorRow& row = watch.monitor.row();
    const bool armed = row.armed.has(state) && row.level.value_or(level) == level;
    if (watch.monitor.step(now.utime, armed, read(watch, now))) changes.push_back(record(watch));
  }
  return changes;
}

FaultChange Fdir::change_of(const Watch& watch) const {
  const Monitor& m = watch.monitor;
  const bool first = !standing_.empty() && standing_.front() == m.row().id;
  return {m.row().id,
          m.reading().condition,
          m.row().response,
          m.reading().value,
          m.limit(),
          m.visible_utime(),
          m.standing(),
          first,
          watch.subject.service};
}

FaultChange Fdir::record(const Watch& watch) {
  const std::string& id = watch.monitor.row().id;
  const bool first = !standing_.empty() && standing_.front() == id;
  if (watch.monitor.standing()) {
    standing_.push_back(id);
    return change_of(watch);
  }
  std::erase(standing_, id);
  FaultChange change = change_of(watch);
  change.first = first;
  return change;
}

const Fdir::Watch* Fdir::find(const std::string& id) const {
  const auto it =
      std::find_if(watches_.begin(), watches_.end(), [&](const Watch& w) { return w.monitor.row().id == id; });
  return it == watches_.end() ? nullptr : &*it;
}

Fdir::Cleared Fdir::clear(const std::string& id, const Now& now) {
  for (Watch& watch : watches_) {
    if (watch.monitor.row().id != id || !watch.monitor.standing()) continue;
    const Reading reading = read(watch, now);
    if (!watch.monitor.unlatch(reading)) return {{}, "the condition still holds"};
    return {{record(watch)}, ""};
  }
  return {{}, "no such fault stands"};
}

void Fdir::restore(const std::vector<std::string>& ids) {
  for (const std::string& id : ids)
    for (Watch& watch : watches_) {
      if (watch.monitor.row().id != id || watch.monitor.standing()) continue;
      watch.monitor.restore_standing();
      standing_.push_back(id);
    }
}

std::vector<FaultChange> Fdir::report() const {
  std::vector<FaultChange> changes;
  for (const std::string& id : standing_) changes.push_back(change_of(*find(id)));
  return changes;
}

template <class Fits>
const Monitor* Fdir::first_standing(Fits fits) const {
  for (const std::string& id : standing_) {
    const Monitor& monitor = find(id)->monitor;
    if (fits(monitor)) return &monitor;
  }
  return nullptr;
}

const Monitor* Fdir::first_blocking() const {
  return first_standing([](const Monitor& m) { return m.blocks(); });
}

const Monitor* Fdir::first_safe() const {
  return first_standing([](const Monitor& m) { return m.row().response == Response::kSafe; });
}

std::vector<std::string> Fdir::ailing_services() const {
  std::vector<std::string> services;
  for (const std::string& id : standing_) {
    const Watch& watch = *find(id);
    const bool bad = watch.monitor.reading().condition != Condition::kFalse;
    if (bad && watch.monitor.row().response == Response::kRestartService) services.push_back(watch.subject.service);
  }
  return services;
}

bool Fdir::wants_retreat() const {
  return first_standing([](const Monitor& m) { return m.row().response == Response::kStopRetreat; }) != nullptr;
}

double Fdir::speed_limit_mps() const {
  double least = kInfinity;
  for (const std::string& id : standing_) least = std::min(least, find(id)->monitor.row().slow_mps);
  return least;
}

}  // namespace rover::supervisor
