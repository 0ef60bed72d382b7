// How a command ends whose arguments are wrong.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <string>

namespace rover {

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
