#include "supervisor/persistent_state_codec.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace rover::supervisor {

std::vector<std::uint8_t> bytes_of(const PersistentState& persistent_state) {
  const nlohmann::json json = {
      {"state", static_cast<int>(persistent_state.state)}, {"level", static_cast<int>(persistent_state.level)},
      {"raised_by_path", persistent_state.raised_by_path}, {"forced", static_cast<int>(persistent_state.forced)},
      {"hazard_stops", persistent_state.hazard_stops},     {"faults", persistent_state.faults}};
  const std::string text = json.dump();
  return {text.begin(), text.end()};
}

std::optional<PersistentState> persistent_state_from(const std::vector<std::uint8_t>& bytes) {
  try {
    const nlohmann::json json = nlohmann::json::parse(bytes.begin(), bytes.end());
    const int state = json.at("state"), level = json.at("level"), forced = json.at("forced");
    const bool known = std::find(kStates.begin(), kStates.end(), static_cast<State>(state)) != kStates.end();
    if (!known || level < 0 || level > 1 || forced < 0 || forced > 2) return std::nullopt;
    PersistentState persistent_state;
    persistent_state.state = static_cast<State>(state);
    persistent_state.level = static_cast<Level>(level);
    persistent_state.forced = static_cast<ForcedLevel>(forced);
    persistent_state.raised_by_path = json.at("raised_by_path");
    persistent_state.hazard_stops = json.at("hazard_stops");
    persistent_state.faults = json.at("faults").get<std::vector<std::string>>();
    return persistent_state;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

}  // namespace rover::supervisor
