#include "common/bus/yaml_file.hpp"

#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>
#include <vector>

#include "common/bus/config.hpp"
#include "common/bus/text_file.hpp"

namespace rover {
namespace {

constexpr size_t kMaxBytes = 1 << 20;  // a path of some 50 km
constexpr size_t kMaxLevels = 32;

// Length in bytes of the UTF-8 character at `at`; 0 if invalid.
size_t utf8_length(const std::string& text, size_t at) {
  const auto byte = [&](size_t i) { return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0U; };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  const size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4) return 0;
  for (size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xc0U) != 0x80U) return 0;
  // Overlong encoding, surrogate, or beyond the last code point.
  if ((first == 0xe0 && byte(1) < 0xa0) || (first == 0xed && byte(1) > 0x9f)) return 0;
  if ((first == 0xf0 && byte(1) < 0x90) || (first == 0xf4 && byte(1) > 0x8f)) return 0;
  return length;
}

bool is_control(char c) {
  return (static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n' && c != '\r') || c == 0x7f;
}

void check_characters(const std::string& text, const std::string& name) {
  for (size_t at = 0, length = 0; at < text.size(); at += length) {
    length = utf8_length(text, at);
    if (length != 0 && !is_control(text[at])) continue;
    const auto lines = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    throw ConfigError(name + ":" + std::to_string(lines + 1) + ": not a text in UTF-8; save it as UTF-8");
  }
}

// Checks the parser's events, because yaml-cpp's tree does not show duplicates, anchors and tags.
class StrictReader : public YAML::EventHandler {
 public:
  explicit StrictReader(const std::string& name) : name_(name) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ > 1) fail(mark, "a second document begins here; only one is read, remove the other");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override {
    if (at_key()) fail(mark, "a key has no name");
    const bool of_key = !levels_.empty() && levels_.back().is_map;  // the parser reports the line after it
    fail(of_key ? levels_.back().key_mark : mark, "no value; 'key: value' is expected, with a blank after the colon");
    finish_value();
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { fail(mark, "aliases (*) are not read"); }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    check_properties(mark, tag, anchor);
    if (at_key()) {
      add_key(mark, value);
    } else {
      finish_value();
    }
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(mark, tag, anchor, false);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(mark, tag, anchor, true);
  }
  void OnMapEnd() override { close(); }

  // Throws ConfigError with the first error.
  void finish() const {
    if (documents_ == 0) throw ConfigError(name_ + ": empty");
    if (!refusal_.empty()) throw ConfigError(refusal_);
  }

 private:
  struct Level {
    bool is_map;
    bool at_key = true;
    std::string key;
    YAML::Mark key_mark;
    size_t index = 0;
    std::set<std::string> keys;
  };

  bool at_key() const { return !levels_.empty() && levels_.back().is_map && levels_.back().at_key; }

  std::string path() const {
    std::string path;
    for (const Level& level : levels_) {
      if (!level.is_map) path += "[" + std::to_string(level.index) + "]";
      if (!level.key.empty()) path += (path.empty() ? "" : ".") + level.key;
    }
    return path;
  }

  // Not thrown yet: a later syntax error (an open bracket) is reported first.
  void fail(const YAML::Mark& mark, const std::string& what) {
    if (!refusal_.empty()) return;
    const std::string at = path();
    refusal_ = name_ + ":" + std::to_string(mark.line + 1) + ": " + at + (at.empty() ? "" : ": ") + what;
  }

  void check_properties(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    if (anchor != 0) fail(mark, "anchors (&) are not read; write the value in each place");
    // "?" and "!" are plain and quoted.
    if (!tag.empty() && tag != "?" && tag != "!") fail(mark, "tags (!) are not read");
  }

  void add_key(const YAML::Mark& mark, const std::string& key) {
    Level& level = levels_.back();
    level.key = key;
    level.key_mark = mark;
    if (key.empty()) fail(mark, "a key has no name");
    if (key == "<<") fail(mark, "merge keys are not read; write the keys in each place");
    if (!level.keys.insert(key).second) fail(mark, "given twice");
    level.at_key = false;
  }

  void open(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, bool is_map) {
    if (at_key()) fail(mark, "a key that is not a text");
    check_properties(mark, tag, anchor);
    if (levels_.size() == kMaxLevels) fail(mark, "more than " + std::to_string(kMaxLevels) + " levels deep");
    levels_.push_back({is_map});
  }

  void close() {
    levels_.pop_back();
    finish_value();
  }

  void finish_value() {
    if (levels_.empty()) return;
    levels_.back().at_key = true;
    ++levels_.back().index;
  }

  const std::string& name_;
  int documents_ = 0;
  std::string refusal_;
  std::vector<Level> levels_;
};

}  // namespace

YAML::Node parse_yaml(const std::string& text, const std::string& name) {
  check_characters(text, name);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    StrictReader reader(name);
    // Stop at the second document: on some errors the parser produces documents without end.
    if (parser.HandleNextDocument(reader)) parser.HandleNextDocument(reader);
    reader.finish();
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw ConfigError(name + ":" + std::to_string(error.mark.line + 1) + ": not valid YAML: " + error.msg);
  }
}

YAML::Node load_yaml(const std::string& file) {
  return parse_yaml(read_text(file, kMaxBytes), file);
}

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
