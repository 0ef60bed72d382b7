// fuzz_parsers PARSER: feeds mutated files to a parser of user files.
#include <cstdio>

#include "common/bus/command_line.hpp"
#include "parsers.hpp"

#ifdef __SANITIZE_ADDRESS__
// Unchecked allocation sizes are findings. The quarantine of freed memory is limited.
extern "C" const char* __asan_default_options() {
  return "max_allocation_size_mb=1024:quarantine_size_mb=16:detect_leaks=0";
}
#endif

namespace {

using namespace rover::fuzz;

const Parser& parser_named(const std::vector<Parser>& parsers, const std::string& name) {
  std::string names;
  for (const Parser& parser : parsers) {
    if (parser.name == name) return parser;
    names += " " + parser.name;
  }
  throw rover::ConfigError("fuzz_parsers: no parser '" + name + "'; there are:" + names);
}

size_t bytes_in(const std::vector<Input>& corpus) {
  size_t bytes = 0;
  for (const Input& file : corpus) bytes += file.bytes.size();
  return bytes;
}

// A row of test/results/fuzz.md.
void print(const Parser& parser, const Campaign& campaign, const Outcome& outcome) {
  std::printf("| %s | %llu | %llu | %.0f | %zu files, %.1f KB | %.0f MB | %.2f s (%llu) | %zu |\n", parser.name.c_str(),
              static_cast<unsigned long long>(outcome.inputs), static_cast<unsigned long long>(outcome.refused),
              outcome.seconds, parser.corpus.size(), static_cast<double>(bytes_in(parser.corpus)) / 1024.0,
              outcome.worst_memory_mb, outcome.worst_cpu_s, static_cast<unsigned long long>(outcome.worst_number),
              outcome.findings.size());
  for (const Finding& finding : outcome.findings)
    std::fprintf(stderr, "%s: %s\n  again: fuzz_parsers %s --seed %llu --first %llu --inputs 1\n", finding.file.c_str(),
                 finding.what.c_str(), parser.name.c_str(), static_cast<unsigned long long>(campaign.seed),
                 static_cast<unsigned long long>(finding.number));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Gives a parser of users' files one wrong file after the other", "fuzz_parsers");
  std::string name;
  bool list = false;
  Campaign campaign;
  campaign.findings_dir = "fuzz_findings";
  CLI::Option* parsers_option = app.add_option("parser", name, "one of --list");
  app.add_flag("--list", list, "the names of the parsers")->excludes(parsers_option);
  app.add_option("--seconds", campaign.seconds, "begin no batch of inputs later")->check(rover::not_negative());
  app.add_option("--inputs", campaign.inputs, "at most so many inputs");
  app.add_option("--seed", campaign.seed, "of the inputs")->capture_default_str();
  app.add_option("--first", campaign.first, "number of the first input")->capture_default_str();
  app.add_option("--findings", campaign.findings_dir, "folder for inputs that a parser failed at")
      ->transform(rover::is_user_path());
  try {
    rover::parse_arguments(app, argc, argv);
    const std::vector<Parser> parsers = all_parsers();
    if (list) {
      for (const Parser& parser : parsers) std::printf("%s\n", parser.name.c_str());
      return 0;
    }
    const Parser& parser = parser_named(parsers, name);
    const Outcome outcome = run_inputs(parser, campaign);
    print(parser, campaign, outcome);
    return outcome.findings.empty() ? 0 : 1;
  } catch (const CLI::ParseError& error) {
    return rover::end_of_parse(app, error);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
