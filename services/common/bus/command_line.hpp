// Shared parsing of command-line arguments.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>

#include "common/bus/bus_url.hpp"
#include "common/bus/config.hpp"
#include "common/bus/user_files.hpp"
#include "common/core/decimal.hpp"

namespace rover {

// For options whose value is a path.
inline CLI::Validator is_user_path() {
  const auto change = [](std::string& typed) -> std::string {
    try {
      typed = user_path(typed);
      return {};
    } catch (const ConfigError& error) {
      return error.what();
    }
  };
  return CLI::Validator(change, "PATH");
}

// For options whose value is a bus.
inline CLI::Validator is_bus_url() {
  return CLI::Validator([](std::string& url) { return bus_url_problem(url); }, "URL");
}

inline CLI::Validator not_negative() {
  const auto problem = [](std::string& value) -> std::string {
    return parse_number(value).value_or(-1.0) < 0.0 ? "'" + value + "' is negative" : std::string();
  };
  return CLI::Validator(problem, "");
}

// A list option takes one value each time it is given, so that it does not consume positional arguments.
inline CLI::Option* repeatable(CLI::Option* option) {
  return option->allow_extra_args(false);
}

// CLI11 reads 012 as octal, saturates 1e20, and accepts nan in every range.
inline std::string problem_of_value(const std::string& type, const std::string& value) {
  const auto whole = parse_whole_number(value);
  if (type.starts_with("INT") && !whole)
    return "not a whole number: '" + value + "'; decimal digits are expected, no leading zero";
  if (type.starts_with("UINT") && (!whole || *whole < 0)) return "not a whole number from 0: '" + value + "'";
  if (type.starts_with("FLOAT") && !parse_number(value))
    return "not a number: '" + value + "'; plain decimal is expected";
  if (type.starts_with("TEXT") && value.empty()) return "an empty text";
  return {};
}

inline void check_values(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    const std::string type = option->get_type_name();
    // Transformations run before CLI11's own checks.
    option->transform(CLI::Validator([type](std::string& value) { return problem_of_value(type, value); }, ""));
  }
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) check_values(*command);
}

// Replaces app.parse: numbers follow core/decimal.hpp, and empty texts are errors.
inline void parse_arguments(CLI::App& app, int argc, char** argv) {
  check_values(app);
  app.parse(argc, argv);
}

// Option of every command that reads a log.
inline CLI::Option* add_log_run(CLI::App& app, int& number) {
  return app.add_option("--log-run", number, "number of the run in a log of several runs, from 1")
      ->check(CLI::Range(1, 1'000'000));
}

// Exit status: 0 if --help was given, else 2 with one line that refers to it.
inline int end_of_parse(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) return app.exit(error);
  std::string command = app.get_name();
  for (const CLI::App* sub : app.get_subcommands()) command += " " + sub->get_name();
  std::fprintf(stderr, "%s: %s; see %s --help\n", command.c_str(), one_line(error.what()).c_str(), command.c_str());
  return 2;
}

}  // namespace rover
