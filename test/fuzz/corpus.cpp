#include "corpus.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

namespace rover::fuzz {
namespace fs = std::filesystem;

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<Input> files_of(const std::string& name) {
  const fs::path dir = fs::path(ROVER_SOURCE_DIR) / "test" / "fuzz" / "corpus" / name;
  std::vector<Input> files;
  for (const auto& entry : fs::recursive_directory_iterator(dir)) {
    if (!entry.is_regular_file()) continue;
    files.push_back({fs::relative(entry.path(), dir).string(), bytes_of(entry.path())});
  }
  std::sort(files.begin(), files.end(), [](const Input& a, const Input& b) { return a.name < b.name; });
  return files;
}

void lay_out(const std::vector<Input>& corpus, const Input& input, Scratch& scratch) {
  for (const Input& file : corpus) scratch.write(file.name, file.name == input.name ? input.bytes : file.bytes);
}

const std::vector<std::string>& yaml_words() {
  static const std::vector<std::string> kWords = {
      "\n---\n", "\n...\n", "&a ",  "*a",  "<<: *a\n", "!!int ", "? ", ": ",           "- ",
      "[",       "]",       "{",    "}",   "|\n",      ">\n",    "#",  "\"",           "'",
      "~",       "null",    "true", "yes", ".nan",     ".inf",   "\t", "\xef\xbb\xbf", "%YAML 1.2\n---\n",
      "\\x00",   "  "};
  return kWords;
}

}  // namespace rover::fuzz
