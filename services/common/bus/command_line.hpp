// What the arguments of all commands have in common.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <string>

#include "common/bus/config.hpp"
#include "common/bus/user_files.hpp"

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

// Makes an option for lists take one value each time that it is given: what follows it is not its own.
inline CLI::Option* repeatable(CLI::Option* option) {
  return option->allow_extra_args(false);
}

// Exit status: 0 where help was asked for, else 2 with one line that says where to find it.
inline int end_of_parse(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) return app.exit(error);
  std::string command = app.get_name();
  for (const CLI::App* sub : app.get_subcommands()) command += " " + sub->get_name();
  std::string said = error.what();
  std::replace(said.begin(), said.end(), '\n', ' ');
  std::fprintf(stderr, "%s: %s; %s --help tells more\n", command.c_str(), said.c_str(), command.c_str());
  return 2;
}

}  // namespace rover
