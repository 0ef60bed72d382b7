// Small valid files.
#pragma once

#include "common/bus/config.hpp"
#include "run_inputs.hpp"

namespace rover::fuzz {

std::string bytes_of(const std::filesystem::path& file);
// The files of corpus/NAME with their names in it, in the order of these.
std::vector<Input> files_of(const std::string& name);
// All files of the corpus, one of them exchanged for the input.
void lay_out(const std::vector<Input>& corpus, const Input& input, Scratch& scratch);
// For an input that several readers get: what one refuses goes to the next.
template <class Read>
void read_or_refuse(Read read) {
  try {
    read();
  } catch (const ConfigError&) {
    return;
  }
}
// What words mean something to a YAML parser.
const std::vector<std::string>& yaml_words();

}  // namespace rover::fuzz
