// The bans of a server: in memory, where they take effect at once, and in a file, where they persist.
#pragma once

#include <asio/ip/address.hpp>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/store/StateFile.h"
#include "shared/net/base/AddressRange.h"
#include "shared/program/JobThread.h"

namespace naiad {

/// One ban, or an exception to bans.
struct Ban {
  using Time = std::chrono::system_clock::time_point;
  enum class Kind {
    kName,       ///< bans players with this name or one that looks like it
    kRange,      ///< bans connections from these addresses
    kException,  ///< exempts these addresses from all bans of ranges
  };

  std::uint64_t number = 0;  ///< unique while the server runs; not saved
  Kind kind = Kind::kName;
  std::string name{};                   ///< only for kName
  std::optional<AddressRange> range{};  ///< set for the other kinds
  std::string reason{};
  std::string by{};             ///< caller of the command that made the ban
  Time made{};                  ///< whole seconds
  std::optional<Time> until{};  ///< nullopt: permanent
  bool persistent = true;       ///< true if the ban is saved on disk

  bool isExpired(Time now) const { return until && *until <= now; }
  /// Returns "name:Ann" or "192.0.2.0/24".
  std::string target() const { return kind == Kind::kName ? "name:" + name : range->text(); }
  /// True if adding one removes the other: their targets are equal, and both or neither are exceptions.
  bool isSameTarget(const Ban& other) const {
    return (kind == Kind::kException) == (other.kind == Kind::kException) && target() == other.target();
  }
};

/// Returns the message for the player: "You are banned from this server until 2026-11-25 19:01 UTC: spam".
std::string banMessage(const Ban& ban);

/// Thrown if the file cannot be created or used. what() is a one-sentence message.
using BanFileError = StateFileError;

/// The ban file: an SQLite database in the server's state folder. For one thread at a time. Servers with a
/// common folder share the file; load() also reads the changes of the other servers.
class BanStore {
 public:
  /// Does not open or create the file yet.
  explicit BanStore(std::filesystem::path file);

  /// Returns all bans, without numbers; none without a file. Throws BanFileError, and leaves the file
  /// unchanged, if it is unreadable or invalid. The server must not start then, or banned players could join.
  std::vector<Ban> load();
  /// Writes the ban, replacing one of its kind and target. Creates the file (0600) and its folder if
  /// necessary. Waits for the disk. Throws BanFileError.
  void save(const Ban& ban);
  /// Removes the ban, if it is there. Throws BanFileError.
  void erase(const Ban& ban);

 private:
  StateFile m_file;
};

/// An immutable set of bans, indexed for look-ups: one binary search for each prefix length in use.
/// Any thread may read it.
class BanSet {
 public:
  BanSet() = default;
  explicit BanSet(std::vector<Ban> bans);

  /// Returns the ban that applies to this address now; null if none does. Loopback addresses are never
  /// banned, because all players on this machine have them.
  const Ban* find(const asio::ip::address& address, Ban::Time now) const;
  /// Returns the ban that applies to a name now, or null. `skeletons`: nameSkeletons(name) (NameSanitizer.h).
  const Ban* findName(const std::vector<std::string>& skeletons, Ban::Time now) const;
  const std::vector<Ban>& all() const { return m_bans; }

 private:
  struct RangeKey {
    int length;
    AddressRange::Bytes bytes;
    std::size_t ban;
  };
  /// Ranges, sorted by length and first address.
  struct Index {
    std::vector<RangeKey> keys;
    std::vector<int> lengths;
    void add(const AddressRange& range, std::size_t ban);
    void sort();
  };
  const Ban* findIn(const Index& index, const asio::ip::address& address, Ban::Time now) const;

  std::vector<Ban> m_bans;
  Index m_ranges;
  Index m_exceptions;
  std::vector<std::pair<std::string, std::size_t>> m_skeletons;  ///< skeletons of banned names, sorted
};

/// The bans in force. isBanned(), currentSet() and count() may be called from any thread, all other members
/// only from the host's thread. The constructor reads the file; later only the worker accesses the disk.
class BanList {
 public:
  /// Called on the worker's thread when a change was written or could not be. Called at once, on the caller's
  /// thread, if the ban is not persistent, there is no file, or too many jobs wait. `problem` is empty, or
  /// says in one sentence why the change will be lost when the server ends.
  using Saved = std::function<void(const std::string& problem)>;
  /// A wall clock; tests pass their own. May be called from any thread.
  using Clock = std::function<Ban::Time()>;

  static constexpr std::size_t kMaxBans = 20'000;

  /// Uses the file bans.sqlite3 in `folder`. If `folder` is empty, there is no file, and bans end with the
  /// server. Throws BanFileError.
  BanList(JobThread& worker, const std::filesystem::path& folder, Clock clock);
  BanList(JobThread& worker, const std::filesystem::path& folder);
  ~BanList();

  /// True if a ban applies to this address now. Any thread; takes a microsecond.
  bool isBanned(const asio::ip::address& address) const;
  /// Returns the current bans. Any thread.
  std::shared_ptr<const BanSet> currentSet() const;
  Ban::Time time() const { return m_clock(); }
  /// Returns why a client with this address and name may not play; empty if it may.
  std::string refusal(const asio::ip::address& address, const std::string& name) const;
  /// Number of calls for which isBanned() returned true.
  std::uint64_t count() const { return m_hits; }

  /// Adds bans, replacing those for which isSameTarget() is true, and removes expired ones. Returns false,
  /// adds none, and does not call `saved`, if there would be more than kMaxBans. Saves them if the first one
  /// is persistent.
  bool add(const std::vector<Ban>& added, Saved saved);
  /// Removes the bans named by this text: #NUMBER, name:NAME, NAME, an address or a range. Returns the number
  /// removed; if that is 0, does not call `saved`.
  std::size_t remove(const std::string& text, Saved saved);
  /// Called on the worker's thread with the bans in the file, or the reason why it cannot be written or read.
  using Loaded = std::function<void(std::vector<Ban> bans, const std::string& problem)>;
  /// Makes the changes that could not be written, then reads the file. False if there is no file or too many
  /// jobs wait for the disk.
  bool reload(Loaded loaded);
  /// Replaces the persistent bans; all others stay.
  void replaceAll(std::vector<Ban> bans);

 private:
  /// The ban file, and the changes that could not be written to it yet. Used by the worker's jobs.
  struct File;

  void replace(std::vector<Ban> bans);
  void save(const std::vector<Ban>& bans, bool is_removal, Saved saved);

  JobThread& m_worker;
  Clock m_clock;
  std::shared_ptr<File> m_file;  ///< shared with the worker's jobs; null: no file
  mutable std::mutex m_mutex;    ///< guards m_set
  std::shared_ptr<const BanSet> m_set = std::make_shared<BanSet>();
  mutable std::atomic<std::uint64_t> m_hits = 0;
  std::uint64_t m_newest = 0;
};

}  // namespace naiad
