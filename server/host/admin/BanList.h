// The bans of a server: in memory, where they hold at once, and in a file, where they last.
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

#include "host/admin/AdminWorker.h"
#include "host/store/StateFile.h"
#include "shared/net/base/AddressRange.h"

namespace naiad {

/// One ban, or an exception to bans.
struct Ban {
  using Time = std::chrono::system_clock::time_point;
  enum class Kind {
    kName,       ///< those who come with this name, or one that looks like it
    kRange,      ///< connections from these addresses
    kException,  ///< no ban of a range holds for these
  };

  std::uint64_t number = 0;  ///< as long as the server runs
  Kind kind = Kind::kName;
  std::string name{};                   ///< of kName
  std::optional<AddressRange> range{};  ///< of the others
  std::string reason{};
  std::string by{};             ///< who gave the command
  Time made{};                  ///< whole seconds
  std::optional<Time> until{};  ///< nothing: for ever
  bool lasting = true;          ///< kept on disk

  bool isOver(Time now) const { return until && *until <= now; }
  /// "name:Ann" or "192.0.2.0/24": bans of the same are one.
  std::string target() const { return kind == Kind::kName ? "name:" + name : range->text(); }
  bool isSameTarget(const Ban& other) const {
    return (kind == Kind::kException) == (other.kind == Kind::kException) && target() == other.target();
  }
};

/// For the banned: 'You are banned from this server until 2026-11-25 19:01 UTC: "spam".'
std::string banSentence(const Ban& ban);

/// The file is there and cannot be used. what() is one sentence for people.
using BanFileError = StateFileError;

/// The file of bans: an SQLite database in the server's state folder. One thread at a time. Servers with the
/// same folder share the file; each reads what others wrote when it loads.
class BanStore {
 public:
  /// Nothing is opened or made yet.
  explicit BanStore(std::filesystem::path file);

  /// All bans, without numbers. None if there is no file. Throws BanFileError for one that cannot be read, is
  /// damaged, or is no file of bans: it is left as it is, and whoever is banned must not come in meanwhile.
  std::vector<Ban> load();
  /// Add the ban, in place of one of the same target. The file and its folder are made if need be (0600).
  /// Waits for the disk. Throws BanFileError.
  void save(const Ban& ban);
  /// Take it out, if it is there. Throws BanFileError.
  void erase(const Ban& ban);

 private:
  StateFile m_file;
};

/// All bans at one moment, sorted to be looked up, and never changed.
/// Safe to read from any thread. A look-up takes a binary search for each length of prefix that there is.
class BanSet {
 public:
  BanSet() = default;
  explicit BanSet(std::vector<Ban> bans);

  /// The ban that holds for this address now; null if none does. None ever holds for a loopback address:
  /// there the server's own doors and admins are.
  const Ban* find(const asio::ip::address& address, Ban::Time now) const;
  /// The same for a name (Names.h). `shapes` are of shapesOf().
  const Ban* findName(const std::vector<std::string>& shapes, Ban::Time now) const;
  /// By number.
  const std::vector<Ban>& all() const { return m_bans; }

 private:
  struct Place {
    int length;
    AddressRange::Bytes bytes;
    std::size_t ban;
  };
  /// Ranges by length and first address.
  struct Index {
    std::vector<Place> places;
    std::vector<int> lengths;
    void add(const AddressRange& range, std::size_t ban);
    void sort();
  };
  const Ban* findIn(const Index& index, const asio::ip::address& address, Ban::Time now) const;

  std::vector<Ban> m_bans;
  Index m_ranges;
  Index m_exceptions;
  std::vector<std::pair<std::string, std::size_t>> m_shapes;  ///< of banned names, sorted
};

/// Readers take a set that never changes (BanSet). All but isBanned(), now() and count() is for the host's
/// thread. The disk is the worker's.
class BanList {
 public:
  /// What became of it on disk: empty, or one sentence on why it holds only until the server ends. On the
  /// worker's thread.
  using Saved = std::function<void(const std::string& problem)>;
  /// A wall clock; tests have their own. Any thread.
  using Clock = std::function<Ban::Time()>;

  static constexpr std::size_t kMaxBans = 20'000;

  /// `folder`: of the file bans.sqlite3; empty: there is none, and bans end with the server. Throws
  /// BanFileError.
  BanList(AdminWorker& worker, const std::filesystem::path& folder, Clock clock);
  BanList(AdminWorker& worker, const std::filesystem::path& folder);
  ~BanList();

  /// Does one hold for this address now? Any thread; takes a microsecond.
  bool isBanned(const asio::ip::address& address) const;
  /// All of them. Any thread.
  std::shared_ptr<const BanSet> now() const;
  Ban::Time time() const { return m_clock(); }
  /// Why a client with this address and name may not play: a sentence; empty if it may.
  std::string refusal(const asio::ip::address& address, const std::string& name) const;
  /// Connections that isBanned() was true for.
  std::uint64_t count() const { return m_hits; }

  /// Add it, in place of one of the same target; bans that are over go. False: there are kMaxBans.
  bool add(Ban ban, Saved saved);
  /// Lift those that this text names: #NUMBER, name:NAME, an address or a range. How many.
  std::size_t remove(const std::string& text, Saved saved);
  /// What the file has now, with bans whose writing failed and was tried again; or why it cannot be read. On
  /// the worker's thread.
  using Loaded = std::function<void(std::vector<Ban> bans, const std::string& problem)>;
  /// Read the file again. False: there is none, or too much waits for the disk.
  bool reload(Loaded loaded);
  /// Go on with these, and with those of the present that are in memory alone.
  void take(std::vector<Ban> bans);

 private:
  /// The worker's.
  struct File;

  void replace(std::vector<Ban> bans);
  void save(std::function<void(File&)> change, Saved saved);

  AdminWorker& m_worker;
  Clock m_clock;
  std::shared_ptr<File> m_file;  ///< the worker's jobs', too; null: none
  mutable std::mutex m_mutex;    ///< of m_set
  std::shared_ptr<const BanSet> m_set = std::make_shared<BanSet>();
  mutable std::atomic<std::uint64_t> m_hits = 0;
  std::uint64_t m_newest = 0;
};

}  // namespace naiad
