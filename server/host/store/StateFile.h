// A file that lasts beyond a restart: an SQLite database in the server's state folder, of one kind and
// format.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

struct sqlite3;
struct sqlite3_stmt;

namespace naiad {

/// The file is there and cannot be used. what() is one sentence for people.
class StateFileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A prepared statement. Columns and parameters as SQLite counts them: parameters from 1, columns from 0.
class StateStatement {
 public:
  StateStatement(sqlite3* p_database, const char* p_text);
  /// Could it be prepared?
  bool isGood() const { return m_statement != nullptr; }

  /// Copies the text.
  void bind(int place, const std::string& text) const;
  void bind(int place, std::int64_t number) const;
  /// Whether there is a row; isDone() says whether all have been read.
  bool step();
  bool isDone() const { return m_done; }
  /// Bind and step again.
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

/// One thread at a time. Servers with the same folder may share the file.
class StateFile {
 public:
  struct Kind {
    const char* what;    ///< "file of bans"
    int id;              ///< PRAGMA application_id
    int format;          ///< PRAGMA user_version
    const char* schema;  ///< statements that make the tables, in one transaction
    bool has_log;        ///< writers do not wait for readers (PRAGMA journal_mode = WAL)
  };

  /// Nothing is opened or made yet. The kind's texts are literals.
  StateFile(std::filesystem::path file, const Kind& kind);
  ~StateFile();

  // All of these throw StateFileError. A file that cannot be read, is damaged, or is of another kind is left
  // as it is.

  /// False: there is no file. Opens it, and looks it over the first time.
  bool openIfThere();
  /// Make file and folder if need be (0600), then as openIfThere().
  void openOrMake();
  /// In an open file. Waits for the disk where something is written.
  StateStatement prepare(const char* p_text);
  /// The last change is on disk even if the machine fails now.
  void run(const char* p_statements);
  bool isOpen() const { return m_database != nullptr; }
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
