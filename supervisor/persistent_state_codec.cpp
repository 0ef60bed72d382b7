#include "supervisor/persistent_state_codec.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace rover::supervisor {
namespace {

constexpr int kVersion = 3;

}  // namespace

std::vector<std::uint8_t> bytes_of(const PersistentState& s) {
  const nlohmann::json json = {{"version", kVersion},
                               {"state", static_cast<int>(s.state)},
                               {"level", static_cast<int>(s.level)},
                               {"raised_by_path", s.raised_by_path},
                               {"path_full", s.path_full},
                               {"forced", static_cast<int>(s.forced)},
                               {"hazard_stops", s.hazard_stops},
                               {"backtracking_path_id", s.backtracking_path_id},
                               {"faults", s.faults},
                               {"starts", s.counters.starts},
                               {"fault_stops_m", s.counters.fault_stops_m},
                               {"restart_attempts", s.restart_attempts},
                               {"utime", s.utime},
                               {"heat_utime", s.heat.utime},
                               {"drive_i2t_load", s.heat.drive_i2t_load},
                               {"steer_i2t_load", s.heat.steer_i2t_load}};
  // A name on the bus may be anything.
  const std::string text = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return {text.begin(), text.end()};
}

std::optional<PersistentState> persistent_state_from(const std::vector<std::uint8_t>& bytes) {
  try {
    const nlohmann::json json = nlohmann::json::parse(bytes.begin(), bytes.end());
    if (json.at("version") != kVersion) return std::nullopt;
    const int state = json.at("state"), level = json.at("level"), forced = json.at("forced");
    const bool known = std::find(kStates.begin(), kStates.end(), static_cast<State>(state)) != kStates.end();
    if (!known || level < 0 || level > 1 || forced < 0 || forced > 2) return std::nullopt;
    PersistentState s;
    s.state = static_cast<State>(state);
    s.level = static_cast<Level>(level);
    s.forced = static_cast<ForcedLevel>(forced);
    json.at("raised_by_path").get_to(s.raised_by_path);
    json.at("path_full").get_to(s.path_full);
    json.at("hazard_stops").get_to(s.hazard_stops);
    json.at("backtracking_path_id").get_to(s.backtracking_path_id);
    json.at("faults").get_to(s.faults);
    json.at("starts").get_to(s.counters.starts);
    json.at("fault_stops_m").get_to(s.counters.fault_stops_m);
    json.at("restart_attempts").get_to(s.restart_attempts);
    json.at("utime").get_to(s.utime);
    json.at("heat_utime").get_to(s.heat.utime);
    json.at("drive_i2t_load").get_to(s.heat.drive_i2t_load);
    json.at("steer_i2t_load").get_to(s.heat.steer_i2t_load);
    return s;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

}  // namespace rover::supervisor
