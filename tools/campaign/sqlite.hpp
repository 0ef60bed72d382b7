// SQLite in as few calls as the store needs. Every error is a ConfigError "FILE: what is wrong".
#pragma once

#include <cstdint>
#include <memory>
#include <string>

struct sqlite3;
struct sqlite3_stmt;

namespace rover::campaign {

class Database;

class Statement {
 public:
  Statement(const Database& database, const std::string& sql);
  // Parameters from 1; those that are not bound are NULL.
  void bind(int parameter, const std::string& value);
  void bind(int parameter, std::int64_t value);
  void bind(int parameter, double value);
  // True while there is a row of results.
  bool step();
  void reset();

  // Columns from 0.
  int columns() const;
  std::string name(int column) const;
  std::string text(int column) const;
  std::int64_t integer(int column) const;
  double number(int column) const;
  bool is_number(int column) const;
  bool is_text(int column) const;

 private:
  void check(int result) const;

  const Database& database_;
  std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> statement_;
};

class Database {
 public:
  Database(const std::string& file, bool writable);
  void execute(const std::string& sql) const;
  [[noreturn]] void fail() const;
  sqlite3* get() const { return database_.get(); }

 private:
  std::string file_;
  std::unique_ptr<sqlite3, int (*)(sqlite3*)> database_;
};

// Rolls back unless it was committed.
class Transaction {
 public:
  explicit Transaction(const Database& database);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  const Database& database_;
  bool open_ = true;
};

// A name as SQL has it.
std::string quoted(const std::string& name);

}  // namespace rover::campaign
