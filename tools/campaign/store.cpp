#include "tools/campaign/store.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <numeric>

#include "common/bus/config.hpp"
#include "tools/campaign/sqlite.hpp"

namespace rover::campaign {
namespace {

const std::string kSelectRows = "SELECT cells.cell AS cell_text, rows.* FROM rows JOIN cells ON cells.id = rows.cell ";

std::string database_file(const std::string& dir) {
  return dir + "/campaign.sqlite";
}

// Columns of rows that are not figures or texts.
constexpr int kFixed = 6;

Row read_row(const Statement& statement) {
  Row row;
  row.cell = parse_cell(statement.text(0));
  row.commit = statement.text(1);
  row.seed = statement.integer(3);
  row.attempts = static_cast<int>(statement.integer(4));
  row.status = statement.text(5);
  row.outcome = statement.text(6);
  for (int column = kFixed + 1; column < statement.columns(); ++column) {
    if (statement.is_number(column)) row.figures[statement.name(column)] = statement.number(column);
    if (statement.is_text(column)) row.texts[statement.name(column)] = statement.text(column);
  }
  return row;
}

}  // namespace

struct Store::Impl {
  Database database;
  std::map<std::string, std::int64_t> cell_ids;

  std::vector<std::pair<std::string, std::string>> columns() const;  // name and type
  void add_column(const std::string& name, const std::string& type) const;
  void add_columns(const std::vector<Row>& rows) const;
  std::int64_t cell_id(const Cell& cell);
  void insert(const std::vector<Row>& rows);
};

std::vector<std::pair<std::string, std::string>> Store::Impl::columns() const {
  std::vector<std::pair<std::string, std::string>> columns;
  for (Statement table(database, "PRAGMA table_info(rows)"); table.step();)
    columns.emplace_back(table.text(1), table.text(2));
  return columns;
}

void Store::Impl::add_column(const std::string& name, const std::string& type) const {
  database.execute("ALTER TABLE rows ADD COLUMN " + quoted(name) + " " + type);
}

void Store::Impl::add_columns(const std::vector<Row>& rows) const {
  std::map<std::string, std::string> known;
  for (const auto& [name, type] : columns()) known[name] = type;
  for (const Row& row : rows) {
    for (const auto& [name, value] : row.figures)
      if (known.emplace(name, "REAL").second) add_column(name, "REAL");
    for (const auto& [name, value] : row.texts)
      if (known.emplace(name, "TEXT").second) add_column(name, "TEXT");
  }
}

std::int64_t Store::Impl::cell_id(const Cell& cell) {
  const std::string text = cell_text(cell);
  if (const auto known = cell_ids.find(text); known != cell_ids.end()) return known->second;
  Statement insertion(database, "INSERT OR IGNORE INTO cells (cell) VALUES (?)");
  insertion.bind(1, text);
  insertion.step();
  Statement query(database, "SELECT id FROM cells WHERE cell = ?");
  query.bind(1, text);
  query.step();
  return cell_ids[text] = query.integer(0);
}

void Store::Impl::insert(const std::vector<Row>& rows) {
  std::map<std::string, int> parameter;
  std::string places;
  for (const auto& [name, type] : columns()) {
    parameter[name] = static_cast<int>(parameter.size()) + 1;
    places += places.empty() ? "?" : ",?";
  }
  Statement insertion(database, "INSERT OR IGNORE INTO rows VALUES (" + places + ")");
  for (const Row& row : rows) {
    insertion.reset();
    insertion.bind(1, row.commit);
    insertion.bind(2, cell_id(row.cell));
    insertion.bind(3, row.seed);
    insertion.bind(4, std::int64_t{row.attempts});
    insertion.bind(5, row.status);
    insertion.bind(6, row.outcome);
    for (const auto& [name, value] : row.figures) insertion.bind(parameter.at(name), value);
    for (const auto& [name, value] : row.texts) insertion.bind(parameter.at(name), value);
    insertion.step();
  }
}

double CellValues::median() const {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

double CellValues::mean() const {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

Store::Store(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Store::~Store() = default;
Store::Store(Store&&) noexcept = default;

Store Store::open(const std::string& dir) {
  if (!std::filesystem::exists(database_file(dir)))
    throw ConfigError(dir + ": not the folder of a campaign: no campaign.sqlite");
  return Store(std::unique_ptr<Impl>(new Impl{Database(database_file(dir), false), {}}));
}

Store Store::create(const std::string& dir) {
  Store store(std::unique_ptr<Impl>(new Impl{Database(database_file(dir), true), {}}));
  const Database& database = store.impl_->database;
  Transaction transaction(database);
  database.execute("CREATE TABLE IF NOT EXISTS cells (id INTEGER PRIMARY KEY, cell TEXT NOT NULL UNIQUE)");
  database.execute(
      "CREATE TABLE IF NOT EXISTS rows (\"commit\" TEXT NOT NULL, cell INTEGER NOT NULL REFERENCES cells, "
      "seed INTEGER NOT NULL, attempts INTEGER NOT NULL, status TEXT NOT NULL, outcome TEXT NOT NULL, "
      "UNIQUE (\"commit\", cell, seed))");
  transaction.commit();
  return store;
}

void Store::add(const std::vector<Row>& rows) try {
  Transaction transaction(impl_->database);
  impl_->add_columns(rows);
  impl_->insert(rows);
  transaction.commit();
} catch (const ConfigError&) {
  impl_->cell_ids.clear();  // rolled back
  throw;
}

std::int64_t Store::size() const {
  Statement query(impl_->database, "SELECT count(*) FROM rows");
  query.step();
  return query.integer(0);
}

std::set<Key> Store::keys(const std::string& commit) const {
  std::set<Key> keys;
  Statement query(impl_->database,
                  "SELECT cells.cell, seed FROM rows JOIN cells ON cells.id = rows.cell WHERE \"commit\" = ?");
  query.bind(1, commit);
  while (query.step()) keys.emplace(query.text(0), query.integer(1));
  return keys;
}

std::vector<Row> Store::rows() const {
  return rows_where("1");
}

std::vector<Row> Store::rows_where(const std::string& condition, const std::string& order) const {
  std::vector<Row> rows;
  for (Statement query(impl_->database, kSelectRows + "WHERE " + condition + " ORDER BY " + order); query.step();)
    rows.push_back(read_row(query));
  return rows;
}

void Store::each(const std::function<void(const Row&)>& use) const {
  for (Statement query(impl_->database, kSelectRows + "ORDER BY cell_text, seed, \"commit\""); query.step();)
    use(read_row(query));
}

std::vector<Cell> Store::cells() const {
  std::vector<Cell> cells;
  for (Statement query(impl_->database, "SELECT cell FROM cells ORDER BY cell"); query.step();)
    cells.push_back(parse_cell(query.text(0)));
  return cells;
}

std::vector<std::string> Store::figure_names() const {
  std::vector<std::string> names;
  for (const auto& [name, type] : impl_->columns())
    if (type == "REAL") names.push_back(name);
  return names;
}

std::vector<OutcomeCount> Store::outcomes() const {
  std::vector<OutcomeCount> counts;
  Statement query(impl_->database,
                  "SELECT cells.cell AS cell_text, status, outcome, count(*) FROM rows JOIN cells ON cells.id = "
                  "rows.cell GROUP BY cell_text, status, outcome ORDER BY cell_text, status, outcome");
  while (query.step()) counts.push_back({parse_cell(query.text(0)), query.text(1), query.text(2), query.integer(3)});
  return counts;
}

std::vector<CellValues> Store::values_of(const std::string& figure, bool goal_reached_only) const {
  std::vector<CellValues> cells;
  const std::vector<std::string> names = figure_names();
  if (std::find(names.begin(), names.end(), figure) == names.end()) return cells;
  Statement query(impl_->database,
                  "SELECT cells.cell AS cell_text, " + quoted(figure) +
                      " AS figure_value, seed FROM rows JOIN cells ON cells.id = rows.cell WHERE figure_value IS NOT "
                      "NULL AND status = 'done'" +
                      (goal_reached_only ? " AND outcome = 'goal_reached'" : "") +
                      " ORDER BY cell_text, figure_value, seed");
  for (std::string last; query.step();) {
    const std::string text = query.text(0);
    if (cells.empty() || text != last) cells.push_back({parse_cell(text), {}, {}});
    cells.back().values.push_back(query.number(1));
    cells.back().seeds.push_back(query.integer(2));
    last = text;
  }
  return cells;
}

}  // namespace rover::campaign
