// A file for state that survives restarts: an SQLite database in the server's state folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

struct sqlite3;
struct sqlite3_stmt;

namespace naiad {

/// Thrown if the file cannot be created or used. what() is a one-sentence message.
class StateFileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A prepared statement. As in SQLite, parameters count from 1 and columns from 0.
class StateStatement {
 public:
  StateStatement(sqlite3* p_database, const char* p_text);
  /// True if the statement was prepared without an error.
  bool isValid() const { return m_statement != nullptr; }

  /// Binds a parameter. Copies the text.
  void bind(int place, const std::string& text) const;
  void bind(int place, std::int64_t number) const;
  /// Moves to the next row. Returns false after the last row, and on an error (then isDone() is false).
  bool step();
  bool isDone() const { return m_done; }
  /// Allows the statement to be bound and executed again.
  void reset();

  std::string text(int column) const;
  std::int64_t number(int column) const;
  bool isNull(int column) const;

 private:
  struct Finish {
    void operator()(sqlite3_stmt* p_statement) const;
  };
  std::unique_ptr<sqlite3_stmt, Finish> m_statement;
  bool m_done = false;
};

/// Not thread-safe. Servers with a common folder may share the file.
class StateFile {
 public:
  struct Kind {
    const char* what;    ///< name in messages, like "ban file"
    int id;              ///< PRAGMA application_id
    int format;          ///< PRAGMA user_version
    const char* schema;  ///< statements that create the tables, run in one transaction
    bool has_log;        ///< PRAGMA journal_mode = WAL, so writers do not wait for readers
  };

  /// Does not open or create the file yet. The texts of `kind` must be literals.
  StateFile(std::filesystem::path file, const Kind& kind);
  ~StateFile();

  // The following functions throw StateFileError. They leave a file unchanged that is unreadable, damaged or
  // of another kind.

  /// Opens the file unless it is open, and checks it. Returns false if it does not exist.
  bool openExisting();
  /// Creates the file (0600) and its folder if necessary, and opens it like openExisting().
  void openOrCreate();
  /// Prepares a statement; the file must be open. Executing it waits for the disk if it writes.
  StateStatement prepare(const char* p_text);
  /// Executes statements. When it returns, changes survive a power failure.
  void run(const char* p_statements);
  bool isOpen() const { return m_database != nullptr; }
  /// Throws StateFileError: "The KIND FILE `what` (SQLite's error)."
  [[noreturn]] void fail(const std::string& what) const;

 private:
  struct Close {
    void operator()(sqlite3* p_database) const;
  };
  void make();
  void open();
  void openAt(const std::filesystem::path& path);
  void check();

  std::filesystem::path m_file;
  Kind m_kind;
  std::unique_ptr<sqlite3, Close> m_database;
};

}  // namespace naiad
