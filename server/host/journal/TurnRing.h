// A ring buffer of records that wait for the disk, in shared memory that outlives this process.
//
// The tick thread stores each record before the world gets it, and never waits. A worker writes the stored
// records to disk and then releases them. A killed process leaves the ring behind, under the round's name:
// file and ring together have every record.
//
//   ring   magic (8) | uuid (16) | folder (8) | capacity (8) | bytes stored (8) | bytes released (8)
//          | length of the beginning (8) | bytes | beginning
//
// The folder is that of the round's file, as a hash. The two counts are positions in the record stream, like
// those in TURN chunks (Dfr.h). The beginning is the file's name, a zero byte and the first bytes of the
// file, because the worker creates the file only after the round has begun. If a ring has no file, the next
// server in that folder creates the file or removes the ring.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace naiad {

/// The beginning of a round's file.
struct FilePrologue {
  std::string name;   ///< name of the file, without its folder
  std::string bytes;  ///< header and facts
};

class TurnRing {
 public:
  /// Creates a ring of `capacity` bytes: in /dev/shm under the round's name if `shared` and if that works
  /// (see isShared()), otherwise in memory of this process alone. `position`: position of the first byte in
  /// the record stream. `folder`: ringFolder() of the file's folder; 0: unknown. `beginning`: beginning of
  /// the file, if it does not exist yet. Throws std::system_error if there is no memory.
  TurnRing(std::size_t capacity, const std::array<std::uint8_t, 16>& uuid, bool shared,
           std::uint64_t position = 0, std::uint64_t folder = 0, const FilePrologue& beginning = {});
  /// Removes the shared memory, unless handOver() was called.
  ~TurnRing();
  TurnRing(const TurnRing&) = delete;
  TurnRing& operator=(const TurnRing&) = delete;

  bool isShared() const { return !m_path.empty(); }
  /// Returns the path of the shared memory; empty if it is not shared.
  const std::string& path() const { return m_path; }

  /// Leaves the shared memory to another process, which resumes the round from there (OrphanedRing).
  void handOver() { m_handed_over = true; }

  /// Stores bytes. Only one thread may call this. Returns false, and stores none, if space is lacking.
  bool store(std::string_view bytes);
  /// True if more than half of the ring is in use.
  bool isFilling() const;

  /// True if this file, opened for reading, is a ring for that folder.
  static bool isRingOf(int file, std::uint64_t folder);

  // One other thread calls these.

  /// Appends up to `most` bytes that are stored and not released to `out`. Returns their number.
  std::size_t peek(std::string& out, std::size_t most) const;
  /// Releases the oldest `count` bytes, which are not needed any more.
  void release(std::size_t count);

 private:
  struct Head {
    char magic[8];
    std::uint8_t uuid[16];
    std::uint64_t folder;
    std::uint64_t capacity;
    std::atomic<std::uint64_t> stored;
    std::atomic<std::uint64_t> released;
    std::uint64_t beginning;
  };
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

  friend class OrphanedRing;
  bool mapShared(const std::array<std::uint8_t, 16>& uuid);
  char* bytes() const { return reinterpret_cast<char*>(m_p_head + 1); }

  std::size_t size() const { return sizeof(Head) + m_capacity + m_prologue_size; }

  std::size_t m_capacity;
  std::size_t m_prologue_size;  ///< size of the beginning of the round's file, in bytes
  std::string m_path;
  bool m_handed_over = false;
  int m_file = -1;  ///< file of the shared memory, locked as long as this process lives
  Head* m_p_head = nullptr;
};

/// The ring of a killed process.
class OrphanedRing {
 public:
  /// Opens the ring of a round. Returns nullopt if there is none, it is malformed, or its process lives.
  static std::optional<OrphanedRing> find(const std::array<std::uint8_t, 16>& uuid);
  /// Returns the rings of a folder whose rounds, by uuid, are not among `known`: their servers were killed
  /// before the file existed. Rings without a beginning() are omitted.
  static std::vector<OrphanedRing> findWithoutFile(std::uint64_t folder, const std::set<std::string>& known);
  OrphanedRing(OrphanedRing&&) = default;
  OrphanedRing& operator=(OrphanedRing&&) = default;

  /// Returns the beginning of the round's file; nullopt if the file existed, or if no turn was stored.
  std::optional<FilePrologue> beginning() const;
  /// Returns the bytes of the stream from this position on; nullopt if some of them were overwritten,
  /// or if the position is after the last stored byte.
  std::optional<std::string> bytesFrom(std::uint64_t position) const;
  const std::string& path() const { return m_path; }
  /// Removes the shared memory.
  void remove() const;

 private:
  OrphanedRing() = default;
  static std::optional<OrphanedRing> open(std::string path);

  std::string m_path;
  std::string m_bytes;  ///< the whole ring, including its head
};

/// Returns the hash by which a ring names the folder of its file.
std::uint64_t ringFolder(const std::string& folder);

/// Removes the rings of this folder whose processes have ended and whose rounds, by uuid, are not among
/// `kept`: the server was killed before its file existed, or the file was removed. Returns their number.
std::size_t removeStrayRings(std::uint64_t folder, const std::set<std::string>& kept);

/// Returns the uuid as 32 hexadecimal digits.
std::string uuidText(const std::array<std::uint8_t, 16>& uuid);

}  // namespace naiad
