#include "host/store/StateFile.h"

#include <fcntl.h>
#include <sqlite3.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "shared/net/base/SafeFile.h"

namespace naiad {

namespace {

namespace fs = std::filesystem;

constexpr int kBusyMillis = 2000;  ///< how long SQLite waits while another server writes

std::int64_t numberOf(sqlite3* p_database, const char* p_query) {
  StateStatement statement(p_database, p_query);
  return statement.isValid() && statement.step() ? statement.number(0) : -1;
}

}  // namespace

// ---- statements -------------------------------------------------------------------------------------------

void StateStatement::Finish::operator()(sqlite3_stmt* p_statement) const {
  sqlite3_finalize(p_statement);
}

StateStatement::StateStatement(sqlite3* p_database, const char* p_text) {
  sqlite3_stmt* p_statement = nullptr;
  sqlite3_prepare_v2(p_database, p_text, -1, &p_statement, nullptr);
  m_statement.reset(p_statement);
}

void StateStatement::bind(int place, const std::string& text) const {
  sqlite3_bind_text(m_statement.get(), place, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
}

void StateStatement::bind(int place, std::int64_t number) const {
  sqlite3_bind_int64(m_statement.get(), place, number);
}

bool StateStatement::step() {
  const int code = sqlite3_step(m_statement.get());
  m_done = code == SQLITE_DONE;
  return code == SQLITE_ROW;
}

void StateStatement::reset() {
  sqlite3_reset(m_statement.get());
  m_done = false;
}

std::string StateStatement::text(int column) const {
  const auto* p_text = reinterpret_cast<const char*>(sqlite3_column_text(m_statement.get(), column));
  return p_text != nullptr
             ? std::string(p_text, static_cast<std::size_t>(sqlite3_column_bytes(m_statement.get(), column)))
             : std::string();
}

std::int64_t StateStatement::number(int column) const {
  return sqlite3_column_int64(m_statement.get(), column);
}

bool StateStatement::isNull(int column) const {
  return sqlite3_column_type(m_statement.get(), column) == SQLITE_NULL;
}

// ---- the file ---------------------------------------------------------------------------------------------

void StateFile::Close::operator()(sqlite3* p_database) const {
  sqlite3_close(p_database);
}

StateFile::StateFile(fs::path file, const Kind& kind) : m_file(std::move(file)), m_kind(kind) {}

StateFile::~StateFile() = default;

void StateFile::fail(const std::string& what) const {
  std::string why = m_database ? sqlite3_errmsg(m_database.get()) : "";
  if (why == "not an error") why.clear();
  throw StateFileError(std::string("The ") + m_kind.what + " " + m_file.string() + " " + what +
                       (why.empty() ? "." : " (" + why + ")."));
}

// Creates the file (0600, unlike SQLite) under another name and links it to its final name when it is
// complete, because a file without tables counts as damaged. Keeps a file that another server has created in
// the meantime.
void StateFile::make() {
  std::error_code error;
  if (fs::exists(m_file, error)) return;
  fs::create_directories(m_file.parent_path(), error);
  const fs::path fresh = m_file.string() + "." + std::to_string(::getpid()) + ".new";
  ::unlink(fresh.c_str());
  const int descriptor = ::open(fresh.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (descriptor < 0) fail("cannot be created: " + std::error_code(errno, std::generic_category()).message());
  ::close(descriptor);
  openAt(fresh);
  try {
    if (m_kind.has_log) run("PRAGMA journal_mode = WAL");
    run((std::string("BEGIN; ") + m_kind.schema + "; PRAGMA user_version = " + std::to_string(m_kind.format) +
         "; PRAGMA application_id = " + std::to_string(m_kind.id) + "; COMMIT")
            .c_str());
  } catch (const StateFileError&) {
    m_database.reset();
    ::unlink(fresh.c_str());
    throw;
  }
  m_database.reset();
  const bool placed = ::link(fresh.c_str(), m_file.c_str()) == 0 || errno == EEXIST;
  const std::error_code why(errno, std::generic_category());
  ::unlink(fresh.c_str());
  if (!placed) fail("cannot be created: " + why.message());
}

void StateFile::openAt(const fs::path& path) {
  sqlite3* p_database = nullptr;
  const int code = sqlite3_open_v2(path.c_str(), &p_database, SQLITE_OPEN_READWRITE, nullptr);
  m_database.reset(p_database);
  if (code == SQLITE_OK) {
    sqlite3_busy_timeout(p_database, kBusyMillis);
    return;
  }
  const std::string why = sqlite3_errmsg(p_database);
  m_database.reset();
  throw StateFileError(std::string("The ") + m_kind.what + " " + path.string() + " cannot be opened (" + why +
                       ").");
}

void StateFile::open() {
  if (m_database) return;
  try {
    // SQLite also reads the files with these suffixes.
    for (const char* p_suffix : {"", "-journal", "-wal", "-shm"}) requireTrusted(m_file.string() + p_suffix);
  } catch (const std::system_error& error) {
    fail(std::string("cannot be used: ") + error.what());
  }
  openAt(m_file);
  try {
    check();
    run("PRAGMA synchronous = FULL");
  } catch (const StateFileError&) {
    m_database.reset();
    throw;
  }
}

void StateFile::check() {
  if (numberOf(m_database.get(), "SELECT count(*) FROM sqlite_master") < 1)
    fail("cannot be read: it is damaged, or not a database; restore it or move it away");
  if (numberOf(m_database.get(), "PRAGMA application_id") != m_kind.id)
    fail("is a database of another program");
  if (numberOf(m_database.get(), "PRAGMA user_version") != m_kind.format)
    fail("was written by another version of this program");
  StateStatement statement(m_database.get(), "PRAGMA quick_check(1)");
  if (!statement.isValid() || !statement.step() || statement.text(0) != "ok")
    fail("is damaged; restore it or move it away");
}

void StateFile::run(const char* p_statements) {
  if (sqlite3_exec(m_database.get(), p_statements, nullptr, nullptr, nullptr) != SQLITE_OK)
    fail("cannot be written");
}

StateStatement StateFile::prepare(const char* p_text) {
  StateStatement statement(m_database.get(), p_text);
  if (!statement.isValid()) fail("cannot be used");
  return statement;
}

bool StateFile::openExisting() {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(m_file, error);
  if (status.type() == fs::file_type::not_found) return false;
  if (status.type() == fs::file_type::none) fail("cannot be read: " + error.message());
  if (fs::file_size(m_file, error) == 0 && !m_database)
    fail("is empty, so it is damaged; restore it or move it away");
  open();
  return true;
}

void StateFile::openOrCreate() {
  make();
  open();
}

}  // namespace naiad
