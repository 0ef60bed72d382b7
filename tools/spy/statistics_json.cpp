#include "tools/spy/statistics_json.hpp"

#include <cmath>
#include <limits>

namespace rover::spy {
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kLongest = 100;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json value_json(const Field& field, size_t index, size_t longest) {
  return std::visit(
      [&](const auto& all) -> Json {
        using Value = typename std::decay_t<decltype(all)>::value_type;
        if constexpr (std::is_same_v<Value, double>) {
          return number(all[index]);
        } else if constexpr (std::is_same_v<Value, Fields>) {
          return fields_json(all[index], longest);
        } else {
          return all[index];
        }
      },
      field.values);
}

// Nests the values by dimension, the first one outermost.
Json array_json(const Field& field, size_t dimension, size_t& next, size_t longest) {
  if (dimension == field.shape.size()) return value_json(field, next++, longest);
  Json list = Json::array();
  for (int i = 0; i < field.shape[dimension]; ++i) list.push_back(array_json(field, dimension + 1, next, longest));
  return list;
}

}  // namespace

Json fields_json(const Fields& fields, size_t longest) {
  Json json = Json::object();
  for (const Field& field : fields) {
    size_t next = 0;
    json[field.name] =
        field.size() > longest ? Json(std::to_string(field.size()) + " values") : array_json(field, 0, next, longest);
  }
  return json;
}

Json statistics_json(const TrafficStatistics& statistics, const std::string& source,
                     const std::set<std::string>& chosen) {
  const size_t longest = chosen.empty() ? kLongest : std::numeric_limits<size_t>::max();
  Json channels = Json::object();
  for (const auto& [name, c] : statistics.channels) {
    if (!chosen.empty() && !chosen.contains(name)) continue;
    const auto fields = decode_fields(name, c.newest.data(), static_cast<int>(c.newest.size()));
    channels[name] = {{"type", c.type.empty() ? Json(nullptr) : Json(c.type)},
                      {"publishers", c.publishers},
                      {"hz", number(c.hz)},
                      {"age_s", number(c.age_s)},
                      {"gaps", c.gaps},
                      {"malformed", c.malformed},
                      {"messages", c.messages},
                      {"bytes", c.bytes},
                      {"bytes_per_s", number(c.bytes_per_s)},
                      {"fields", fields ? fields_json(*fields, longest) : Json(nullptr)}};
  }
  return {{"source", source},
          {"now_s", statistics.now == kNever ? Json(nullptr) : Json(to_seconds(statistics.now))},
          {"realtime_factor", number(statistics.realtime_factor)},
          {"span_s", statistics.span_s},
          {"channels", channels}};
}

}  // namespace rover::spy
