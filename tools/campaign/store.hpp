// The rows of a campaign in DIR/campaign.sqlite: a table `rows` with one column per figure and text, and a table
// `cells`. What is added is on the disk completely or not at all.
#pragma once

#include <functional>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tools/campaign/row.hpp"

namespace rover::campaign {

using Key = std::pair<std::string, std::int64_t>;  // cell_text() and seed

class Store {
 public:
  // Opens the store of a campaign's folder for reading. Throws ConfigError with one line if there is none.
  static Store open(const std::string& dir);
  // Opens it for writing, and makes it where it is missing.
  static Store create(const std::string& dir);
  ~Store();
  Store(Store&&) noexcept;

  // Rows whose key is present already are left as they are. All or none are added: throws ConfigError with one line,
  // for instance on a full disk.
  void add(const std::vector<Row>& rows);

  std::int64_t size() const;
  // All rows, by cell and seed, with these figures and texts, or with all: half a gigabyte for 100,000 rows of 60.
  std::vector<Row> rows(const std::vector<std::string>& columns = {}) const;
  std::int64_t died() const;
  // Calls `use` for each row by cell and seed, without keeping them.
  void each(const std::function<void(const Row&)>& use) const;
  std::set<Key> keys(const std::string& commit) const;

 private:
  struct Impl;
  explicit Store(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace rover::campaign
