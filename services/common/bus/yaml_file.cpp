#include "common/bus/yaml_file.hpp"

#include <fstream>

#include "common/bus/config.hpp"

namespace rover {

void write_yaml(const std::string& file, const YAML::Node& node) {
  constexpr int kDigits = 17;  // of a double
  YAML::Emitter out;
  out.SetDoublePrecision(kDigits);
  out << node;
  std::ofstream stream(file);
  stream << out.c_str() << "\n";
  stream.close();
  if (!stream) throw ConfigError(file + ": cannot be written");
}

}  // namespace rover
