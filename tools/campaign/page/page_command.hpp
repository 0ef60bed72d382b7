// ./rover campaign page and compare: read the rows of a folder, write the answer.
#pragma once

#include <string>

namespace rover::campaign {

struct PageArguments {
  std::string dir;
  std::string out;      // NAME.html: the page; NAME.md: the table, and its picture NAME.png; empty: all, as DIR/page.*
  std::string command;  // for the table
};
// Throws ConfigError with one line.
int page(const PageArguments& arguments);

struct CompareArguments {
  std::string dir_a;
  std::string dir_b;
  std::string out;  // NAME.html or NAME.md; empty: both, as DIR_B/compare_<name of A>.*
  std::string command;
};
// Throws ConfigError with one line.
int compare_campaigns(const CompareArguments& arguments);

}  // namespace rover::campaign
