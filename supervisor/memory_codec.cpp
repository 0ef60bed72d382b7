#include "supervisor/memory_codec.hpp"

#include <nlohmann/json.hpp>

namespace rover::supervisor {

std::vector<std::uint8_t> bytes_of(const Memory& memory) {
  const nlohmann::json json = {{"state", static_cast<int>(memory.state)}, {"level", static_cast<int>(memory.level)},
                               {"raised_by_path", memory.raised_by_path}, {"forced", static_cast<int>(memory.forced)},
                               {"hazard_stops", memory.hazard_stops},     {"faults", memory.faults}};
  const std::string text = json.dump();
  return {text.begin(), text.end()};
}

std::optional<Memory> memory_from(const std::vector<std::uint8_t>& bytes) {
  try {
    const nlohmann::json json = nlohmann::json::parse(bytes.begin(), bytes.end());
    const int state = json.at("state"), level = json.at("level"), forced = json.at("forced");
    if (state < 0 || state >= kStateCount || level < 0 || level > 1 || forced < 0 || forced > 2) return std::nullopt;
    Memory memory;
    memory.state = static_cast<State>(state);
    memory.level = static_cast<Level>(level);
    memory.forced = static_cast<ForcedLevel>(forced);
    memory.raised_by_path = json.at("raised_by_path");
    memory.hazard_stops = json.at("hazard_stops");
    memory.faults = json.at("faults").get<std::vector<std::string>>();
    return memory;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

}  // namespace rover::supervisor
