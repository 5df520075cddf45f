#include "host/admin/BanStore.h"

#include <cstdint>
#include <optional>
#include <utility>

namespace naiad {

namespace {

constexpr const char* kKinds[] = {"name", "range", "exception"};  ///< by Ban::Kind

constexpr StateFile::Kind kFileOfBans{
    "file of bans", 0x4e616942,  // "NaiB"
    1,
    "CREATE TABLE bans(kind TEXT NOT NULL, target TEXT NOT NULL, reason TEXT NOT NULL, made_by TEXT NOT "
    "NULL, "
    "made INTEGER NOT NULL, until INTEGER, PRIMARY KEY(kind, target)) STRICT",
    false};

std::int64_t secondsOf(Ban::Time time) {
  return std::chrono::duration_cast<std::chrono::seconds>(time.time_since_epoch()).count();
}

Ban::Time timeOf(std::int64_t seconds) {
  return Ban::Time(std::chrono::seconds(seconds));
}

const char* kindName(const Ban& ban) {
  return kKinds[static_cast<int>(ban.kind)];
}

std::string storedTarget(const Ban& ban) {
  return ban.kind == Ban::Kind::kName ? ban.name : ban.range->text();
}

/// Nothing: no ban that this program writes.
std::optional<Ban> banAt(const StateStatement& statement) {
  Ban ban;
  const std::string kind = statement.text(0);
  const std::string target = statement.text(1);
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
  ban.reason = statement.text(2);
  ban.by = statement.text(3);
  ban.made = timeOf(statement.number(4));
  if (!statement.isNull(5)) ban.until = timeOf(statement.number(5));
  return ban;
}

}  // namespace

BanStore::BanStore(std::filesystem::path file) : m_file(std::move(file), kFileOfBans) {}

std::vector<Ban> BanStore::load() {
  if (!m_file.openIfThere()) return {};
  StateStatement statement =
      m_file.prepare("SELECT kind, target, reason, made_by, made, until FROM bans ORDER BY made, target");
  std::vector<Ban> bans;
  while (statement.step()) {
    auto ban = banAt(statement);
    if (!ban) m_file.fail("has a line that is no ban: \"" + statement.text(1) + "\"");
    bans.push_back(std::move(*ban));
  }
  if (!statement.isDone()) m_file.fail("cannot be read");
  return bans;
}

void BanStore::save(const Ban& ban) {
  m_file.openOrMake();
  StateStatement statement = m_file.prepare("INSERT OR REPLACE INTO bans VALUES(?, ?, ?, ?, ?, ?)");
  statement.bind(1, kindName(ban));
  statement.bind(2, storedTarget(ban));
  statement.bind(3, ban.reason);
  statement.bind(4, ban.by);
  statement.bind(5, secondsOf(ban.made));
  if (ban.until) statement.bind(6, secondsOf(*ban.until));
  statement.step();
  if (!statement.isDone()) m_file.fail("cannot be written");
}

void BanStore::erase(const Ban& ban) {
  if (!m_file.isOpen() && !m_file.openIfThere()) return;
  StateStatement statement = m_file.prepare("DELETE FROM bans WHERE kind = ? AND target = ?");
  statement.bind(1, kindName(ban));
  statement.bind(2, storedTarget(ban));
  statement.step();
  if (!statement.isDone()) m_file.fail("cannot be written");
}

}  // namespace naiad
