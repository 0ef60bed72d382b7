#include "tools/launcher/run_report.hpp"

#include <cstdio>
#include <fstream>

#include "common/bus/child_process.hpp"

namespace rover {

void write_json(const std::string& file, const nlohmann::json& facts) {
  std::ofstream(file) << facts.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << "\n";
}

bool make_report(const std::string& bin_dir, const RunFolder& folder) {
  const std::string log = folder.dir + "/service_logs/report.log";
  if (run_into(log, {bin_dir + "/rover_report", folder.dir}) == 0) return true;
  std::fprintf(stderr, "the report failed; see %s\n", log.c_str());
  return false;
}

nlohmann::json read_metrics(const RunFolder& folder) {
  std::ifstream in(folder.dir + "/metrics.json");
  return nlohmann::json::parse(in, nullptr, false);
}

std::string figure(const nlohmann::json& metrics, const char* key, int decimals) {
  if (!metrics.contains(key) || !metrics[key].is_number()) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", decimals, metrics[key].get<double>());
  return text;
}

}  // namespace rover
