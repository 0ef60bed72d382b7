// Command-line values that CLI11 alone would misread.
#include "common/bus/command_line.hpp"

#include <gtest/gtest.h>

#include "wild.hpp"

namespace rover {
namespace {

// Options of all types. Returns the error line, or the parsed value.
std::string outcome(std::vector<std::string> typed) {
  std::int64_t seed = 0;
  int jobs = 1;
  std::uint64_t boot = 0;
  double speed = 0.0;
  std::string out = "none", place;
  std::vector<std::string> channels;
  CLI::App app("", "rover");
  CLI::App* run = app.add_subcommand("run");
  run->add_option("--seed", seed)->check(not_negative());
  run->add_option("--jobs", jobs)->check(CLI::Range(1, 64));
  run->add_option("--boot", boot);
  run->add_option("--speed", speed)->check(not_negative());
  run->add_option("--out", out)->transform(is_user_path());
  repeatable(run->add_option("--channels", channels))->delimiter(',');
  run->add_option("place", place);
  typed.insert(typed.begin(), {"rover", "run"});
  std::vector<char*> argv;
  for (std::string& text : typed) argv.push_back(text.data());
  try {
    parse_arguments(app, static_cast<int>(argv.size()), argv.data());
  } catch (const CLI::ParseError& error) {
    testing::internal::CaptureStderr();
    EXPECT_EQ(end_of_parse(app, error), 2);
    return testing::internal::GetCapturedStderr();
  }
  return "taken: " + std::to_string(seed) + " " + std::to_string(jobs) + " " + std::to_string(speed) + " " + place;
}

struct Typed {
  std::vector<std::string> words;
  const char* before;
};

TEST(CommandLine, ValuesThatCouldMeanSomethingElseAreRefusedInOneLine) {
  const std::vector<Typed> cases = {{{"--seed", "012"}, "taken as 10"},
                                    {{"--seed", "0x1F"}, "taken as 31"},
                                    {{"--seed", " 3"}, "taken as 3"},
                                    {{"--seed", "1e3"}, "refused"},
                                    {{"--seed", "99999999999999999999"}, "taken as 9223372036854775807"},
                                    {{"--seed", "-1"}, "refused"},
                                    {{"--seed", "1", "--seed", "2"}, "refused"},
                                    {{"--boot", "-1"}, "taken as 18446744073709551615"},
                                    {{"--jobs", "0"}, "refused"},
                                    {{"--jobs", "010"}, "taken as 8"},
                                    {{"--speed", "nan"}, "taken"},
                                    {{"--speed", "inf"}, "taken"},
                                    {{"--speed", "0x10"}, "taken as 16"},
                                    {{"--speed", "1,5"}, "refused"},
                                    {{"--out", ""}, "taken as not given"},
                                    {{"--channels", ""}, "taken as not given"},
                                    {{""}, "taken as not given"}};
  for (const Typed& c : cases) {
    std::string shown;
    for (const std::string& word : c.words) shown += (shown.empty() ? "" : " ") + (word.empty() ? "''" : word);
    const std::string line = outcome(c.words);
    EXPECT_EQ(line.rfind("rover run: ", 0), 0U) << shown << " -> " << line;
    EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1) << line;
    wild_row("Command line", shown, c.before, line.substr(0, line.size() - 1));
  }
}

TEST(CommandLine, UsualValuesAreTaken) {
  EXPECT_EQ(outcome({"x", "--seed", "7", "--jobs", "64", "--speed", "1e-1"}), "taken: 7 64 0.100000 x");
  EXPECT_EQ(outcome({"--speed", "+.5", "x"}), "taken: 0 1 0.500000 x");
}

}  // namespace
}  // namespace rover
