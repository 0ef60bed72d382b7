#include "tools/campaign/store.hpp"

#include <algorithm>
#include <filesystem>

#include "common/bus/config.hpp"
#include "common/bus/user_files.hpp"
#include "tools/campaign/sqlite.hpp"

namespace rover::campaign {
namespace {

// `what`: columns of rows; see read_row().
std::string select_rows(const std::string& what) {
  return "SELECT cells.cell AS cell_text, " + what + " FROM rows JOIN cells ON cells.id = rows.cell ";
}

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

Store::Store(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Store::~Store() = default;
Store::Store(Store&&) noexcept = default;

Store Store::open(const std::string& dir) {
  if (const std::string problem = folder_problem(dir); !problem.empty()) throw ConfigError(dir + ": " + problem);
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

std::vector<Row> Store::rows(const std::vector<std::string>& columns) const {
  std::string what = "rows.*";
  if (!columns.empty()) {
    what = "rows.\"commit\", rows.cell, seed, attempts, status, outcome";
    // SQLite takes the name of a missing column for a text.
    for (const auto& [name, type] : impl_->columns())
      if (std::find(columns.begin(), columns.end(), name) != columns.end()) what += ", rows." + quoted(name);
  }
  std::vector<Row> rows;
  for (Statement query(impl_->database, select_rows(what) + "ORDER BY cell_text, seed"); query.step();)
    rows.push_back(read_row(query));
  return rows;
}

std::int64_t Store::died() const {
  Statement query(impl_->database, "SELECT count(*) FROM rows WHERE status = 'died'");
  query.step();
  return query.integer(0);
}

void Store::each(const std::function<void(const Row&)>& use) const {
  for (Statement query(impl_->database, select_rows("rows.*") + "ORDER BY cell_text, seed, \"commit\""); query.step();)
    use(read_row(query));
}

}  // namespace rover::campaign
