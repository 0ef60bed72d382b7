// Small valid files.
#pragma once

#include "common/bus/config.hpp"
#include "run_inputs.hpp"

namespace rover::fuzz {

std::string bytes_of(const std::filesystem::path& file);
// The files of corpus/NAME, sorted by name.
std::vector<Input> files_of(const std::string& name);
// All files of the corpus, with one replaced by the input.
void lay_out(const std::vector<Input>& corpus, const Input& input, Scratch& scratch);
// Tries several readers in order until one accepts the input.
template <class Read>
void read_or_refuse(Read read) {
  try {
    read();
  } catch (const ConfigError&) {
    return;
  }
}
// Tokens of YAML.
const std::vector<std::string>& yaml_words();

}  // namespace rover::fuzz
