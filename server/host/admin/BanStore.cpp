#include "host/admin/BanStore.h"

#include <fcntl.h>
#include <sqlite3.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <optional>
#include <system_error>
#include <utility>

namespace naiad {

namespace {

namespace fs = std::filesystem;

constexpr int kBusyMillis = 2000;                                 ///< while another server writes
constexpr int kFileFormat = 1;                                    ///< PRAGMA user_version
constexpr int kFileKind = 0x4e616942;                             ///< PRAGMA application_id: "NaiB"
constexpr const char* kKinds[] = {"name", "range", "exception"};  ///< by Ban::Kind

struct FinishStatement {
  void operator()(sqlite3_stmt* p_statement) const { sqlite3_finalize(p_statement); }
};
using Statement = std::unique_ptr<sqlite3_stmt, FinishStatement>;

Statement prepare(sqlite3* p_database, const char* p_text) {
  sqlite3_stmt* p_statement = nullptr;
  sqlite3_prepare_v2(p_database, p_text, -1, &p_statement, nullptr);
  return Statement(p_statement);
}

void bindText(const Statement& statement, int place, const std::string& text) {
  sqlite3_bind_text(statement.get(), place, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
}

std::int64_t secondsOf(Ban::Time time) {
  return std::chrono::duration_cast<std::chrono::seconds>(time.time_since_epoch()).count();
}

Ban::Time timeOf(std::int64_t seconds) {
  return Ban::Time(std::chrono::seconds(seconds));
}

std::string textAt(const Statement& statement, int column) {
  const auto* p_text = reinterpret_cast<const char*>(sqlite3_column_text(statement.get(), column));
  return p_text != nullptr
             ? std::string(p_text, static_cast<std::size_t>(sqlite3_column_bytes(statement.get(), column)))
             : std::string();
}

const char* kindName(const Ban& ban) {
  return kKinds[static_cast<int>(ban.kind)];
}

std::string storedTarget(const Ban& ban) {
  return ban.kind == Ban::Kind::kName ? ban.name : ban.range->text();
}

/// Nothing: no ban that this program writes.
std::optional<Ban> banAt(const Statement& statement) {
  Ban ban;
  const std::string kind = textAt(statement, 0);
  const std::string target = textAt(statement, 1);
  int number = 0;
  while (number < 3 && kind != kKinds[number]) ++number;
  if (number == 3) return std::nullopt;
  ban.kind = static_cast<Ban::Kind>(number);
  if (ban.kind == Ban::Kind::kName) {
    ban.name = target;
  } else {
    ban.range = AddressRange::parse(target);
    if (!ban.range) return std::nullopt;
  }
  ban.reason = textAt(statement, 2);
  ban.by = textAt(statement, 3);
  ban.made = timeOf(sqlite3_column_int64(statement.get(), 4));
  if (sqlite3_column_type(statement.get(), 5) != SQLITE_NULL)
    ban.until = timeOf(sqlite3_column_int64(statement.get(), 5));
  return ban;
}

std::int64_t numberOf(sqlite3* p_database, const char* p_query) {
  const Statement statement = prepare(p_database, p_query);
  if (!statement || sqlite3_step(statement.get()) != SQLITE_ROW) return -1;
  return sqlite3_column_int64(statement.get(), 0);
}

}  // namespace

void BanStore::Close::operator()(sqlite3* p_database) const {
  sqlite3_close(p_database);
}

BanStore::BanStore(fs::path file) : m_file(std::move(file)) {}

BanStore::~BanStore() = default;

void BanStore::fail(const std::string& what) const {
  std::string why = m_database ? sqlite3_errmsg(m_database.get()) : "";
  if (why == "not an error") why.clear();
  throw BanFileError("The file of bans " + m_file.string() + " " + what +
                     (why.empty() ? "." : " (" + why + ")."));
}

// Made whole beside its place, and put there in one step: a file without its table is a damaged one. Another
// server's file that has come meanwhile stays. SQLite itself would make one that others can read.
void BanStore::make() {
  std::error_code error;
  if (fs::exists(m_file, error)) return;
  fs::create_directories(m_file.parent_path(), error);
  const fs::path fresh = m_file.string() + "." + std::to_string(::getpid()) + ".new";
  const int descriptor = ::open(fresh.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (descriptor < 0) fail("cannot be made: " + std::error_code(errno, std::generic_category()).message());
  ::close(descriptor);
  openAt(fresh);
  try {
    run(("BEGIN; CREATE TABLE bans(kind TEXT NOT NULL, target TEXT NOT NULL, reason TEXT NOT NULL, made_by "
         "TEXT "
         "NOT NULL, made INTEGER NOT NULL, until INTEGER, PRIMARY KEY(kind, target)) STRICT; PRAGMA "
         "user_version = " +
         std::to_string(kFileFormat) + "; PRAGMA application_id = " + std::to_string(kFileKind) + "; COMMIT")
            .c_str());
  } catch (const BanFileError&) {
    m_database.reset();
    ::unlink(fresh.c_str());
    throw;
  }
  m_database.reset();
  const bool placed = ::link(fresh.c_str(), m_file.c_str()) == 0 || errno == EEXIST;
  const std::error_code why(errno, std::generic_category());
  ::unlink(fresh.c_str());
  if (!placed) fail("cannot be made: " + why.message());
}

void BanStore::openAt(const fs::path& path) {
  sqlite3* p_database = nullptr;
  const int code = sqlite3_open_v2(path.c_str(), &p_database, SQLITE_OPEN_READWRITE, nullptr);
  m_database.reset(p_database);
  if (code == SQLITE_OK) {
    sqlite3_busy_timeout(p_database, kBusyMillis);
    return;
  }
  const std::string why = sqlite3_errmsg(p_database);
  m_database.reset();
  throw BanFileError("The file of bans " + path.string() + " cannot be opened (" + why + ").");
}

void BanStore::open() {
  if (m_database) return;
  openAt(m_file);
  try {
    check();
  } catch (const BanFileError&) {
    m_database.reset();
    throw;
  }
}

void BanStore::check() {
  if (numberOf(m_database.get(), "SELECT count(*) FROM sqlite_master") < 1)
    fail("cannot be read: it is damaged, or none");
  if (numberOf(m_database.get(), "PRAGMA application_id") != kFileKind)
    fail("is a database of something else");
  if (numberOf(m_database.get(), "PRAGMA user_version") != kFileFormat)
    fail("was written by another version of this program");
  const Statement statement = prepare(m_database.get(), "PRAGMA quick_check(1)");
  if (!statement || sqlite3_step(statement.get()) != SQLITE_ROW || textAt(statement, 0) != "ok")
    fail("is damaged");
}

void BanStore::run(const char* p_statements) {
  if (sqlite3_exec(m_database.get(), p_statements, nullptr, nullptr, nullptr) != SQLITE_OK)
    fail("cannot be written");
}

std::vector<Ban> BanStore::load() {
  std::error_code error;
  const fs::file_status status = fs::status(m_file, error);
  if (status.type() == fs::file_type::not_found) return {};
  if (status.type() == fs::file_type::none) fail("cannot be read: " + error.message());
  if (status.type() != fs::file_type::regular) fail("is no regular file");
  if (fs::file_size(m_file, error) == 0 && !m_database) fail("is empty, which it never is by itself");
  open();
  const Statement statement = prepare(
      m_database.get(), "SELECT kind, target, reason, made_by, made, until FROM bans ORDER BY made, target");
  if (!statement) fail("cannot be read");
  std::vector<Ban> bans;
  int code = SQLITE_ROW;
  while ((code = sqlite3_step(statement.get())) == SQLITE_ROW) {
    auto ban = banAt(statement);
    if (!ban) fail("has a line that is no ban: \"" + textAt(statement, 1) + "\"");
    bans.push_back(std::move(*ban));
  }
  if (code != SQLITE_DONE) fail("cannot be read");
  return bans;
}

void BanStore::save(const Ban& ban) {
  make();
  open();
  const Statement statement =
      prepare(m_database.get(), "INSERT OR REPLACE INTO bans VALUES(?, ?, ?, ?, ?, ?)");
  if (!statement) fail("cannot be written");
  bindText(statement, 1, kindName(ban));
  bindText(statement, 2, storedTarget(ban));
  bindText(statement, 3, ban.reason);
  bindText(statement, 4, ban.by);
  sqlite3_bind_int64(statement.get(), 5, secondsOf(ban.made));
  if (ban.until) sqlite3_bind_int64(statement.get(), 6, secondsOf(*ban.until));
  if (sqlite3_step(statement.get()) != SQLITE_DONE) fail("cannot be written");
}

void BanStore::erase(const Ban& ban) {
  std::error_code error;
  if (!m_database && !fs::exists(m_file, error)) return;
  open();
  const Statement statement = prepare(m_database.get(), "DELETE FROM bans WHERE kind = ? AND target = ?");
  if (!statement) fail("cannot be written");
  bindText(statement, 1, kindName(ban));
  bindText(statement, 2, storedTarget(ban));
  if (sqlite3_step(statement.get()) != SQLITE_DONE) fail("cannot be written");
}

}  // namespace naiad
