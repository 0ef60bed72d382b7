// What the arguments of all commands have in common.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>

#include "common/bus/bus_url.hpp"
#include "common/bus/config.hpp"
#include "common/bus/user_files.hpp"
#include "common/core/decimal.hpp"

namespace rover {

// For options whose values are paths of the user's.
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

// For options whose values are buses.
inline CLI::Validator is_bus_url() {
  return CLI::Validator([](std::string& url) { return bus_url_problem(url); }, "URL");
}

inline CLI::Validator not_negative() {
  const auto problem = [](std::string& value) -> std::string {
    return parse_number(value).value_or(-1.0) < 0.0 ? "'" + value + "' is negative" : std::string();
  };
  return CLI::Validator(problem, "");
}

// Makes an option for lists take one value each time that it is given: what follows it is not its own.
inline CLI::Option* repeatable(CLI::Option* option) {
  return option->allow_extra_args(false);
}

// The library takes 012 for ten, saturates 1e20, and leaves nan within every range.
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
    // A transformation comes before the library's own checks.
    option->transform(CLI::Validator([type](std::string& value) { return problem_of_value(type, value); }, ""));
  }
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) check_values(*command);
}

// Instead of app.parse: numbers are those of core/decimal.hpp and no text is empty, in all options and commands.
inline void parse_arguments(CLI::App& app, int argc, char** argv) {
  check_values(app);
  app.parse(argc, argv);
}

// The same for every command that reads a log.
inline CLI::Option* add_log_run(CLI::App& app, int& number) {
  return app.add_option("--log-run", number, "of a log that holds several runs: the first is 1")
      ->check(CLI::Range(1, 1'000'000));
}

// Exit status: 0 where help was asked for, else 2 with one line that says where to find it.
inline int end_of_parse(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) return app.exit(error);
  std::string command = app.get_name();
  for (const CLI::App* sub : app.get_subcommands()) command += " " + sub->get_name();
  std::fprintf(stderr, "%s: %s; %s --help tells more\n", command.c_str(), one_line(error.what()).c_str(),
               command.c_str());
  return 2;
}

}  // namespace rover
