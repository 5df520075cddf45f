#include "host/admin/BanList.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <tuple>
#include <utility>

#include "host/session/NameSanitizer.h"
#include "shared/net/base/AddressPrefix.h"
#include "shared/options/Duration.h"

namespace naiad {

namespace {

constexpr const char* kKinds[] = {"name", "range", "exception"};  ///< index: Ban::Kind

constexpr StateFile::Kind kFileOfBans{
    "ban file", 0x4e616942,  // "NaiB"
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

/// Reads the ban in the current row. Returns nullopt if the row is not valid.
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

constexpr const char* kNoFile = "This server has no --state folder, so its bans end when it stops.";

Ban::Time wholeSeconds() {
  return std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
}

/// True if this text, typed by an admin, names the ban.
bool names(const std::string& text, const Ban& ban) {
  if (text == "#" + std::to_string(ban.number) || text == ban.target()) return true;
  if (ban.kind == Ban::Kind::kName) return text == ban.name;
  const auto range = AddressRange::parse(text);
  return range && *range == *ban.range;
}

}  // namespace

BanStore::BanStore(std::filesystem::path file) : m_file(std::move(file), kFileOfBans) {}

std::vector<Ban> BanStore::load() {
  if (!m_file.openExisting()) return {};
  StateStatement statement =
      m_file.prepare("SELECT kind, target, reason, made_by, made, until FROM bans ORDER BY made, target");
  std::vector<Ban> bans;
  while (statement.step()) {
    auto ban = banAt(statement);
    if (!ban) m_file.fail("has an invalid entry: \"" + statement.text(1) + "\"");
    bans.push_back(std::move(*ban));
  }
  if (!statement.isDone()) m_file.fail("cannot be read");
  return bans;
}

void BanStore::save(const Ban& ban) {
  m_file.openOrCreate();
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
  if (!m_file.isOpen() && !m_file.openExisting()) return;
  StateStatement statement = m_file.prepare("DELETE FROM bans WHERE kind = ? AND target = ?");
  statement.bind(1, kindName(ban));
  statement.bind(2, storedTarget(ban));
  statement.step();
  if (!statement.isDone()) m_file.fail("cannot be written");
}

std::string banMessage(const Ban& ban) {
  std::string sentence = "You are banned from this server";
  if (ban.until) sentence += " until " + timeText(*ban.until);
  return sentence + (ban.reason.empty() ? "." : ": " + ban.reason);
}

void BanSet::Index::add(const AddressRange& range, std::size_t ban) {
  keys.push_back({range.length(), range.bytes(), ban});
  if (std::find(lengths.begin(), lengths.end(), range.length()) == lengths.end())
    lengths.push_back(range.length());
}

void BanSet::Index::sort() {
  std::sort(keys.begin(), keys.end(), [](const RangeKey& a, const RangeKey& b) {
    return std::tie(a.length, a.bytes) < std::tie(b.length, b.bytes);
  });
  std::sort(lengths.begin(), lengths.end());
}

BanSet::BanSet(std::vector<Ban> bans) : m_bans(std::move(bans)) {
  for (std::size_t i = 0; i < m_bans.size(); ++i) {
    const Ban& ban = m_bans[i];
    if (ban.kind == Ban::Kind::kRange) m_ranges.add(*ban.range, i);
    if (ban.kind == Ban::Kind::kException) m_exceptions.add(*ban.range, i);
    if (ban.kind != Ban::Kind::kName) continue;
    for (std::string& shape : nameSkeletons(ban.name)) m_skeletons.emplace_back(std::move(shape), i);
  }
  m_ranges.sort();
  m_exceptions.sort();
  std::sort(m_skeletons.begin(), m_skeletons.end());
}

const Ban* BanSet::findIn(const Index& index, const asio::ip::address& address, Ban::Time now) const {
  const AddressRange::Bytes bytes = AddressRange::bytesOf(address);
  for (const int length : index.lengths) {
    const RangeKey wanted{length, AddressRange::masked(bytes, length), 0};
    const auto found = std::lower_bound(index.keys.begin(), index.keys.end(), wanted,
                                        [](const RangeKey& a, const RangeKey& b) {
                                          return std::tie(a.length, a.bytes) < std::tie(b.length, b.bytes);
                                        });
    if (found == index.keys.end() || found->length != length || found->bytes != wanted.bytes) continue;
    const Ban& ban = m_bans[found->ban];  // the only ban of this range; if it is expired, bans of other
                                          // prefix lengths may match
    if (!ban.isExpired(now) && ban.range->contains(address)) return &ban;
  }
  return nullptr;
}

const Ban* BanSet::find(const asio::ip::address& address, Ban::Time now) const {
  const asio::ip::address own = unmapped(address);
  if (m_ranges.keys.empty() || own.is_loopback()) return nullptr;
  const Ban* const p_ban = findIn(m_ranges, own, now);
  if (p_ban == nullptr || findIn(m_exceptions, own, now) != nullptr) return nullptr;
  return p_ban;
}

const Ban* BanSet::findName(const std::vector<std::string>& skeletons, Ban::Time now) const {
  for (const std::string& shape : skeletons) {
    auto found = std::lower_bound(m_skeletons.begin(), m_skeletons.end(), std::pair(shape, std::size_t{0}));
    for (; found != m_skeletons.end() && found->first == shape; ++found) {
      if (!m_bans[found->second].isExpired(now)) return &m_bans[found->second];
    }
  }
  return nullptr;
}

struct BanList::File {
  struct Change {
    Ban ban;
    bool is_removal;
  };
  BanStore store;
  std::vector<Change> unwritten;  ///< oldest first; failed ones are tried again

  explicit File(const std::filesystem::path& path) : store(path) {}

  void write() {
    for (; !unwritten.empty(); unwritten.erase(unwritten.begin())) {
      const Change& next = unwritten.front();
      next.is_removal ? store.erase(next.ban) : store.save(next.ban);
    }
  }
  std::vector<Ban> load() {
    write();
    return store.load();
  }
};

BanList::BanList(JobThread& worker, const std::filesystem::path& folder)
    : BanList(worker, folder, wholeSeconds) {}

BanList::BanList(JobThread& worker, const std::filesystem::path& folder, Clock clock)
    : m_worker(worker), m_clock(std::move(clock)) {
  if (folder.empty()) return;
  m_file = std::make_shared<File>(folder / "bans.sqlite3");
  replace(m_file->load());
}

BanList::~BanList() = default;

bool BanList::isBanned(const asio::ip::address& address) const {
  const bool banned = currentSet()->find(address, m_clock()) != nullptr;
  if (banned) ++m_hits;
  return banned;
}

std::shared_ptr<const BanSet> BanList::currentSet() const {
  const std::lock_guard lock(m_mutex);
  return m_set;
}

std::string BanList::refusal(const asio::ip::address& address, const std::string& name) const {
  const auto set = currentSet();
  const Ban* p_ban = set->find(address, m_clock());
  if (p_ban == nullptr && !set->all().empty()) p_ban = set->findName(nameSkeletons(name), m_clock());
  return p_ban != nullptr ? banMessage(*p_ban) : std::string();
}

void BanList::replace(std::vector<Ban> bans) {
  const Ban::Time present = m_clock();
  std::erase_if(bans, [present](const Ban& ban) { return ban.isExpired(present); });
  for (Ban& ban : bans) {
    if (ban.number == 0) ban.number = ++m_newest;
  }
  auto set = std::make_shared<const BanSet>(std::move(bans));
  const std::lock_guard lock(m_mutex);
  m_set.swap(set);
}

// Expired bans are removed from memory only. In the file they stay until a new ban with the same target
// replaces them, which saves writes.
bool BanList::add(const std::vector<Ban>& added, Saved saved) {
  std::vector<Ban> bans = currentSet()->all();
  std::erase_if(bans, [&added, present = m_clock()](const Ban& other) {
    return other.isExpired(present) ||
           std::ranges::any_of(added, [&other](const Ban& ban) { return other.isSameTarget(ban); });
  });
  bans.insert(bans.end(), added.begin(), added.end());
  if (bans.size() > kMaxBans) return false;
  replace(std::move(bans));
  added.front().persistent ? save(added, false, std::move(saved)) : saved("");
  return true;
}

std::size_t BanList::remove(const std::string& text, Saved saved) {
  std::vector<Ban> kept;
  std::vector<Ban> lifted;
  for (const Ban& ban : currentSet()->all()) (names(text, ban) ? lifted : kept).push_back(ban);
  if (lifted.empty()) return 0;
  replace(std::move(kept));
  save(lifted, true, std::move(saved));
  return lifted.size();
}

bool BanList::reload(Loaded loaded) {
  return m_file && m_worker.enqueue([file = m_file, loaded = std::move(loaded)] {
    std::vector<Ban> bans;
    std::string problem;
    try {
      bans = file->load();
    } catch (const BanFileError& error) {
      problem = error.what();
    }
    loaded(std::move(bans), problem);
  });
}

void BanList::replaceAll(std::vector<Ban> bans) {
  for (const Ban& ban : currentSet()->all()) {
    if (!ban.persistent) bans.push_back(ban);
  }
  replace(std::move(bans));
}

void BanList::save(const std::vector<Ban>& bans, bool is_removal, Saved saved) {
  if (!m_file) return saved(kNoFile);
  const bool given = m_worker.enqueue([file = m_file, bans, is_removal, saved] {
    for (const Ban& ban : bans) file->unwritten.push_back({ban, is_removal});
    std::string problem;
    try {
      file->write();
    } catch (const BanFileError& error) {
      problem = error.what();
    }
    saved(problem);
  });
  if (!given) saved("Too many changes are waiting for the disk; this one was dropped.");
}

}  // namespace naiad
