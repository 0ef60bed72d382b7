// The rows of a campaign in DIR/campaign.sqlite: a table `rows` with one column per figure and text, and a table
// `cells`. 100,000 rows are aggregated in a second. What is added is on the disk completely or not at all.
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

// Number of drives of a cell with this status and outcome.
struct OutcomeCount {
  Cell cell;
  std::string status;
  std::string outcome;
  std::int64_t drives = 0;
};

// The values of one figure in a cell, of the rows that have it, ascending; with their seeds.
struct CellValues {
  Cell cell;
  std::vector<double> values;
  std::vector<std::int64_t> seeds;
  double median() const;  // NaN without values
  double mean() const;
};

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
  void add(const Row& row) { add(std::vector<Row>{row}); }

  std::int64_t size() const;
  // All rows, by cell and seed: half a gigabyte for 100,000 rows of 60 figures. Prefer the aggregates.
  std::vector<Row> rows() const;
  // Rows that fulfil a condition in SQL on the columns, as "outcome != 'goal_reached'"; `order`: as "ratio desc limit
  // 3".
  std::vector<Row> rows_where(const std::string& condition, const std::string& order = "cell_text, seed") const;
  // Calls `use` for each row by cell and seed, without keeping them.
  void each(const std::function<void(const Row&)>& use) const;
  std::set<Key> keys(const std::string& commit) const;
  std::vector<Cell> cells() const;
  std::vector<std::string> figure_names() const;

  // Aggregates, one entry per cell (and status, outcome), by cell text.
  std::vector<OutcomeCount> outcomes() const;
  // Of the rows that reached their goal, or of all that are done.
  std::vector<CellValues> values_of(const std::string& figure, bool goal_reached_only = true) const;

 private:
  struct Impl;
  explicit Store(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace rover::campaign
