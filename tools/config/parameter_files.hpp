// The parameter files of the configuration and the READMEs that show them, both made from the programs' descriptions.
#pragma once

#include <string>
#include <vector>

namespace rover::config_tool {

// What has parameters: services, the orbital planner, and "navigation" for what services share.
std::vector<std::string> parameter_files();

// The parameters of one of them, as "text", "yaml" or "markdown". Throws ConfigError if its program is not built.
std::string parameters_of(const std::string& name, const std::string& format);

// `text` with the lines between the two markers replaced by `table`; throws ConfigError if there are no markers.
std::string with_table(const std::string& text, const std::string& table, const std::string& file);

struct MadeFile {
  std::string file;
  std::string content;  // as it should be
};
// config/NAME.yaml and the README of NAME below the project's folder.
std::vector<MadeFile> made_files(const std::string& project, const std::string& name);

}  // namespace rover::config_tool
