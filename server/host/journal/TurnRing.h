// Where records wait for the disk: a ring of bytes in shared memory, which outlives this process.
//
// The tick thread stores each record before the world gets it, and never waits. A worker takes what is there,
// and releases it when it is on the disk. A process that is killed leaves the ring behind, under the round's
// name: with the file it has everything.
//
//   ring   magic (8) | uuid (16) | folder (8) | capacity (8) | bytes stored (8) | bytes released (8) | bytes
//
// The folder is that of the round's file, as a hash: a ring without a file is removed by the next server
// there. The two counts are positions in the stream of records, as TURN chunks have them (Dfr.h).
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace naiad {

class TurnRing {
 public:
  /// In memory of this process alone, or, with a name, in /dev/shm. If that cannot be, in this process's
  /// after all: isShared() says so.
  /// `position`: of the first byte, in the stream of records. `folder`: ringFolder() of the file's; 0:
  /// unknown.
  TurnRing(std::size_t capacity, const std::array<std::uint8_t, 16>& uuid, bool shared,
           std::uint64_t position = 0, std::uint64_t folder = 0);
  /// The shared memory is removed, unless leave() was called.
  ~TurnRing();
  TurnRing(const TurnRing&) = delete;
  TurnRing& operator=(const TurnRing&) = delete;

  bool isShared() const { return !m_path.empty(); }
  /// Of the shared memory; empty if it is not shared.
  const std::string& path() const { return m_path; }

  /// Another process goes on with the round, and takes what is in the shared memory from there (LeftRing).
  void leave() { m_left = true; }

  /// Store bytes, for one thread. False, and none are stored: there is no room.
  bool store(std::string_view bytes);
  /// More than half of it is in use.
  bool isFilling() const;

  // For one other thread.

  /// Append up to `most` of what is stored and not released to `out`. Return how many bytes.
  std::size_t peek(std::string& out, std::size_t most) const;
  /// These, the oldest, are not needed any more.
  void release(std::size_t count);

 private:
  struct Head {
    char magic[8];
    std::uint8_t uuid[16];
    std::uint64_t folder;
    std::uint64_t capacity;
    std::atomic<std::uint64_t> stored;
    std::atomic<std::uint64_t> released;
  };
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

  friend class LeftRing;
  friend std::size_t removeStrayRings(std::uint64_t, const std::set<std::string>&);
  bool mapShared(const std::array<std::uint8_t, 16>& uuid);
  char* bytes() const { return reinterpret_cast<char*>(m_p_head + 1); }

  std::size_t m_capacity;
  std::string m_path;
  bool m_left = false;
  int m_file = -1;  ///< of the shared memory, locked: as long as this process lives
  Head* m_p_head = nullptr;
};

/// The ring of a process that was killed.
class LeftRing {
 public:
  /// Nothing if there is none for this round, it is malformed, or its process lives.
  static std::optional<LeftRing> find(const std::array<std::uint8_t, 16>& uuid);
  LeftRing(LeftRing&&) = default;
  LeftRing& operator=(LeftRing&&) = default;

  /// The bytes of the stream from this position on; nothing if some of them are gone.
  std::optional<std::string> bytesFrom(std::uint64_t position) const;
  /// It is not needed any more.
  void remove() const;

 private:
  LeftRing() = default;

  std::string m_path;
  std::string m_bytes;  ///< head and all
};

/// By what a ring names the folder of its file.
std::uint64_t ringFolder(const std::string& folder);

/// Remove the rings of this folder whose processes have ended and whose rounds, by uuid, are not among
/// `kept`: a server was killed before its file was there, or the file was removed. Return how many.
std::size_t removeStrayRings(std::uint64_t folder, const std::set<std::string>& kept);

/// "0123…": 32 hexadecimal digits.
std::string uuidText(const std::array<std::uint8_t, 16>& uuid);

}  // namespace naiad
