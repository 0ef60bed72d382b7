#include "tools/campaign/sqlite.hpp"

#include <sqlite3.h>

#include "common/bus/config.hpp"

namespace rover::campaign {
namespace {

// Another program reads or writes. A campaign of days does not end because somebody looks at its rows for long.
constexpr int kBusyMs = 10'000;
constexpr int kWriterBusyMs = 600'000;

sqlite3* opened(const std::string& file, bool writable) {
  sqlite3* database = nullptr;
  // A reader has to roll back what a killed writer left; SQLite itself opens a protected file for reading alone.
  const int flags = SQLITE_OPEN_READWRITE | (writable ? SQLITE_OPEN_CREATE : 0);
  sqlite3_open_v2(file.c_str(), &database, flags, nullptr);
  return database;
}

sqlite3_stmt* prepared(const Database& database, const std::string& sql) {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database.get(), sql.c_str(), -1, &statement, nullptr) != SQLITE_OK) database.fail();
  return statement;
}

}  // namespace

Database::Database(const std::string& file, bool writable)
    : file_(file), database_(opened(file, writable), sqlite3_close) {
  if (sqlite3_errcode(get()) != SQLITE_OK) fail();
  sqlite3_busy_timeout(get(), writable ? kWriterBusyMs : kBusyMs);
}

void Database::execute(const std::string& sql) const {
  if (sqlite3_exec(get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail();
}

void Database::fail() const {
  throw ConfigError(file_ + ": " + (get() == nullptr ? "out of memory" : sqlite3_errmsg(get())));
}

Statement::Statement(const Database& database, const std::string& sql)
    : database_(database), statement_(prepared(database, sql), sqlite3_finalize) {}

void Statement::check(int result) const {
  if (result != SQLITE_OK) database_.fail();
}

void Statement::bind(int parameter, const std::string& value) {
  check(sqlite3_bind_text(statement_.get(), parameter, value.data(), static_cast<int>(value.size()), SQLITE_TRANSIENT));
}

void Statement::bind(int parameter, std::int64_t value) {
  check(sqlite3_bind_int64(statement_.get(), parameter, value));
}

void Statement::bind(int parameter, double value) {
  check(sqlite3_bind_double(statement_.get(), parameter, value));
}

bool Statement::step() {
  const int result = sqlite3_step(statement_.get());
  if (result != SQLITE_ROW && result != SQLITE_DONE) database_.fail();
  return result == SQLITE_ROW;
}

void Statement::reset() {
  check(sqlite3_reset(statement_.get()));
  sqlite3_clear_bindings(statement_.get());
}

int Statement::columns() const {
  return sqlite3_column_count(statement_.get());
}

std::string Statement::name(int column) const {
  return sqlite3_column_name(statement_.get(), column);
}

std::string Statement::text(int column) const {
  const unsigned char* value = sqlite3_column_text(statement_.get(), column);
  return value == nullptr ? std::string() : reinterpret_cast<const char*>(value);
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

double Statement::number(int column) const {
  return sqlite3_column_double(statement_.get(), column);
}

bool Statement::is_number(int column) const {
  const int type = sqlite3_column_type(statement_.get(), column);
  return type == SQLITE_FLOAT || type == SQLITE_INTEGER;
}

bool Statement::is_text(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_TEXT;
}

Transaction::Transaction(const Database& database) : database_(database) {
  database_.execute("BEGIN IMMEDIATE");
}

Transaction::~Transaction() {
  // A full disk may have rolled it back already.
  if (open_) sqlite3_exec(database_.get(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void Transaction::commit() {
  database_.execute("COMMIT");
  open_ = false;
}

std::string quoted(const std::string& name) {
  std::string text = "\"";
  for (const char c : name) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  return text + "\"";
}

}  // namespace rover::campaign
