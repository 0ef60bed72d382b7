// Real-world YAML: anything that a parser would drop, guess or misread is refused in one line.
#include "common/bus/yaml_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "common/bus/config.hpp"
#include "temp_folder.hpp"
#include "wild.hpp"

namespace rover {
namespace {

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

struct StrictCase {
  const char* input;
  const char* text;
  const char* before;
  const char* line;  // start of the error line
};

// `read` reads the key `a` from a file with this text.
void expect_refused(const std::vector<StrictCase>& cases, const std::function<void(const Config&)>& read) {
  for (const StrictCase& c : cases) {
    const std::string error = error_of([&] {
      const Config config = Config::parse(c.text, "s.yaml");
      read(config);
      config.finish();
    });
    EXPECT_EQ(error.rfind(c.line, 0), 0U) << c.text << " -> " << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    wild_row("Configuration", c.input, c.before, error);
  }
}

TEST(StrictYaml, WhatAParserWouldDropOrGuessIsRefused) {
  const char* half = "the second half was ignored";
  expect_refused(
      {{"a scenario with a second document (---)", "a: 1\n---\na: 2\n", half, "s.yaml:2: a second document"},
       {"text after the end of the document (...)", "a: 1\n...\nseed\n", half, "s.yaml:3: a second document"},
       {"a list between two documents (found by the fuzzer)", "a: 1\n---\n    [m], drawn\n  b: [1, 2]\n", half,
        "s.yaml:2: a second document"},
       {"an anchor and its alias", "a: &x 1\nb: *x\n", "taken", "s.yaml:1: a: anchors"},
       {"an unknown anchor", "a: *x\n", "refused", "s.yaml:1: not valid YAML"},
       {"a merge key (<<)", "a: 1\n<<: {b: 2}\n", "taken where keys are not named", "s.yaml:2: <<: merge keys"},
       {"a tag (!!int)", "a: !!int 3\n", "taken", "s.yaml:1: a: tags"},
       {"a list as a key", "a: 1\n[b, c]: 2\n", "an exception of the library's", "s.yaml:2: a: a key that is not"},
       {"the same key twice in a section that is a list's", "a: 1\nb: [{c: 1, c: 2}]\n", "the first was ignored",
        "s.yaml:2: b[0].c: given twice"},
       {"a key without a value (seed:)", "b: 1\na:\n", "'not a number'", "s.yaml:2: a: no value"},
       {"no blank after the colon (level:auto)", "a: 1\nlevel:auto\n", "'unknown key', not why",
        "s.yaml:2: level:auto: no value"},
       {"two commas in a list", "a: [1,,2]\n", "'not a list of numbers', not where", "s.yaml:1: a[1]: no value"},
       {"a key with a blank", "a: 1\nb c: 2\n", "refused", "s.yaml:2: b c: unknown key"},
       {"a Cyrillic letter in a key", "a: 1\n\xd0\xb0: 2\n", "refused", "s.yaml:2: \xd0\xb0: unknown key"},
       {"a line break in a key", "a: 1\n\"b\\nc\": 2\n", "a refusal of two lines", "s.yaml:2: b c: unknown key"},
       {"Latin-1 (a degree sign) in a comment", "a: 1  # 5 \xb0\n", "taken, the letter replaced",
        "s.yaml:1: not a text"},
       {"a NUL", "a: 1\nb: \x01\n", "taken", "s.yaml:2: not a text in UTF-8"},
       {"an empty file", "# nothing\n", "refused", "s.yaml: empty"},
       {"a list where keys belong", "- a: 1\n", "refused", "s.yaml:1: a mapping of keys"}},
      [](const Config& config) {
        (void)config.number("a", {0, 10});
      });
}

TEST(StrictYaml, ANumberIsPlainDecimal) {
  expect_refused({{"seed: 012", "a: 012\n", "taken as 10", "s.yaml:1: a: not a whole number: '012'"},
                  {"seed: 0x1F", "a: 0x1F\n", "taken as 31", "s.yaml:1: a: not a whole number: '0x1F'"},
                  {"seed: 1e3", "a: 1e3\n", "refused", "s.yaml:1: a: not a whole number"},
                  {"seed: 1_000", "a: 1_000\n", "refused", "s.yaml:1: a: not a whole number"},
                  {"seed: 3.0", "a: 3.0\n", "refused", "s.yaml:1: a: not a whole number"},
                  {"seed: \"3\" (in quotes)", "a: \"3\"\n", "taken as 3", "s.yaml:1: a: not a whole number: \"3\""},
                  {"seed: 99999999999999999999", "a: 99999999999999999999\n", "refused", "s.yaml:1: a: not a whole"},
                  {"seed: [3]", "a: [3]\n", "refused", "s.yaml:1: a: a single value"}},
                 [](const Config& config) {
                   (void)config.integer64("a", {0, 1e18});
                 });
  expect_refused({{"timeout_s: 1:30 (base 60)", "a: 1:30\n", "refused", "s.yaml:1: a: not a number: '1:30'"},
                  {"timeout_s: 0100.5", "a: 0100.5\n", "taken as 100.5", "s.yaml:1: a: not a number: '0100.5'"},
                  {"a decimal comma", "a: 0,5\n", "refused", "s.yaml:1: a: not a number"},
                  {"timeout_s: 0x10", "a: 0x10\n", "refused", "s.yaml:1: a: not a number"},
                  {"timeout_s: .inf", "a: .inf\n", "out of range", "s.yaml:1: a: not a number"},
                  {"timeout_s: nan", "a: nan\n", "refused", "s.yaml:1: a: not a number"},
                  {"timeout_s: 1e999", "a: 1e999\n", "refused", "s.yaml:1: a: not a number"}},
                 [](const Config& config) {
                   (void)config.number("a", {0, 1e18});
                 });
  const Config config = Config::parse("a: 1e-5\nb: +0.5\nc: -3\nd: [.5, 5., 0, -0.0, 0e0]\ne: 0\n", "s.yaml");
  EXPECT_DOUBLE_EQ(config.number("a", {0, 1}), 1e-5);
  EXPECT_DOUBLE_EQ(config.number("b", {0, 1}), 0.5);
  EXPECT_EQ(config.integer("c", {-5, 5}), -3);
  EXPECT_EQ(config.numbers("d", {-9, 9}, 5).front(), 0.5);
  EXPECT_EQ(config.integer("e", {-5, 5}), 0);
}

TEST(StrictYaml, ATruthValueIsTrueOrFalse) {
  expect_refused({{"page: yes", "a: yes\n", "taken as true", "s.yaml:1: a: 'yes' is neither true nor false"},
                  {"page: Off", "a: Off\n", "taken as false", "s.yaml:1: a: 'Off' is neither"},
                  {"page: \"true\" (in quotes)", "a: \"true\"\n", "taken as true", "s.yaml:1: a: \"true\" is neither"},
                  {"page: 1", "a: 1\n", "refused", "s.yaml:1: a: '1' is neither"}},
                 [](const Config& config) { (void)config.boolean("a"); });
}

TEST(StrictYaml, ByteOrderMarkAndWindowsLinesAreFine) {
  const Config config = Config::parse(
      "\xef\xbb\xbf"
      "a: 1\r\nb: {c: true}\r\n",
      "s.yaml");
  EXPECT_EQ(config.integer("a", {0, 9}), 1);
  EXPECT_TRUE(config.section("b").boolean("c"));
  config.finish();
  wild_row("Configuration", "a byte order mark and lines that end as on Windows", "taken", "taken");
}

TEST(StrictYaml, EveryShippedFileIsReadAndStaysTheSameWhenWritten) {
  const testing_support::TempFolder folder;
  size_t files = 0;
  for (const char* dir : {"/config", "/config/scenarios", "/examples/driver"})
    for (const auto& entry : std::filesystem::directory_iterator(ROVER_SOURCE_DIR + std::string(dir))) {
      if (entry.path().extension() != ".yaml") continue;
      ++files;
      const YAML::Node node = load_yaml(entry.path());
      write_yaml(folder.file("copy.yaml"), node);
      EXPECT_EQ(YAML::Dump(load_yaml(folder.file("copy.yaml"))), YAML::Dump(node)) << entry.path();
    }
  EXPECT_GT(files, 20U);
}

TEST(StrictYaml, FilesThatNoSettingsAreAreRefused) {
  const testing_support::TempFolder folder;
  const auto error_with = [&](const std::string& text) {
    const std::string file = folder.file("s.yaml");
    std::ofstream(file) << text;
    return error_of([&] { (void)load_yaml(file); }).substr(folder.file("").size());
  };
  const std::string deep = error_with("a: " + std::string(500'000, '['));
  EXPECT_EQ(deep.rfind("s.yaml:1: not valid YAML", 0), 0U) << deep;
  EXPECT_EQ(error_with("x: 1\na: [1, 2\nb: 3\n"), "s.yaml:3: not valid YAML: end of sequence flow not found");
  const std::string nested = error_with("a: " + std::string(40, '[') + "1" + std::string(40, ']'));
  EXPECT_NE(nested.find(": more than 32 levels deep"), std::string::npos) << nested;
  const std::string large = error_with("a: 1 #" + std::string(2 << 20, '-'));
  EXPECT_EQ(large, "s.yaml: 2 MB; at most 1 MB are expected here");
  const std::string utf16("a\0:\0 \0001\0\n\0", 10);
  const std::string wide = error_with("\xff\xfe" + utf16);
  EXPECT_EQ(wide, "s.yaml:1: not a text in UTF-8; save it as UTF-8");
  wild_row("Configuration", "forty nested lists", "taken", nested);
  wild_row("Configuration", "half a million nested lists", "refused by the library", deep);
  wild_row("Configuration", "a file of more than 1 MB", "read whole", large);
  wild_row("Configuration", "UTF-16, as a Windows shell's > writes it", "taken", wide);
  EXPECT_EQ(error_of([&] { (void)load_yaml(folder.file("")); }), folder.file("") + ": not a file");
}

}  // namespace
}  // namespace rover
