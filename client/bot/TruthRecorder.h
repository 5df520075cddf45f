// Records a bot's picture of every tick, to be compared with the server's truth file afterwards.
//
// Several snapshots may share a tick, so a tick's picture is final only when a later tick's first snapshot
// arrives, or at the end. It is recorded only if it was complete after the last of these snapshots
// (CompletenessTracker); otherwise the server has more to send, or an earlier snapshot is lost or late. For a
// tick without a snapshot, the extrapolated picture is recorded, because the server relies on the client to
// extrapolate. On the stream, the server also skips ticks while earlier data waits, so ticks without a
// snapshot are not recorded there. Recording stops when a limit of ticks or cells is reached.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>

#include "shared/replica/Acks.h"
#include "shared/replica/Replica.h"
#include "shared/replica/SnapshotCodec.h"

namespace naiad {

/// Finds out whether a client shows everything that the server has sent it. Only then may its picture be
/// compared with the world's.
///
/// A complete snapshot says that the server has nothing more to send. An earlier snapshot may still be lost
/// or late, because a datagram or the second stream can overtake the first stream, and the first the second.
class CompletenessTracker {
 public:
  /// Call after a snapshot was applied. `acks`: the snapshots received, including this one. `before`:
  /// the number of the last snapshot before this session.
  void addSnapshot(const SnapshotHeader& header, const AckWindow& acks, std::uint32_t before = 0) {
    if (header.number == acks.newest) {
      m_complete = header.complete;
      m_tick = header.tick;
    }
    m_whole = m_complete && hasAll(acks, before);
  }
  /// True if the newest snapshot was complete and no earlier one is missing.
  bool isComplete() const { return m_whole; }
  /// The tick of the snapshot with the highest number; snapshots that arrive late do not change it.
  std::uint32_t tick() const { return m_tick; }

 private:
  /// Snapshots older than the window count as received, because the sender treats them as lost and sends
  /// their contents again before it marks a snapshot as complete.
  static bool hasAll(const AckWindow& acks, std::uint32_t before) {
    const auto between = static_cast<std::int32_t>(acks.newest - before) - 1;
    if (between <= 0) return between == 0;
    const std::uint64_t all = between >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << between) - 1;
    return (acks.mask & all) == all;
  }

  std::uint32_t m_tick = 0;
  bool m_complete = false;  ///< the newest snapshot was complete
  bool m_whole = false;
};

class TruthRecorder {
 public:
  static constexpr std::size_t kMaxTicks = 2000;
  /// Limit on the cells of all pictures together: 128 MB.
  static constexpr std::size_t kMaxCells = 16u << 20;

  explicit TruthRecorder(std::size_t max_cells = kMaxCells) : m_max_cells(max_cells) {}

  /// Call before a snapshot of `tick` is applied to `replica`: records the pictures of the ticks before
  /// `tick`, from that of the last snapshot, if no part of it was missing.
  void beforeSnapshot(const Replica& replica, std::uint32_t tick);
  /// Like CompletenessTracker::addSnapshot(). `skips`: the server may skip ticks after this one.
  void afterSnapshot(const SnapshotHeader& header, const AckWindow& acks, bool skips,
                     std::uint32_t before = 0);
  /// Records the tick of the newest snapshot, if complete. Call when no further snapshot will come.
  void finish(const Replica& replica);

  std::size_t tickCount() const { return m_pictures.size(); }
  /// Returns the recorded pictures by tick.
  const std::map<std::uint32_t, df::Canvas>& pictures() const { return m_pictures; }
  /// Returns the number of Objects that were in different cells of the world at different times.
  std::size_t movingCount() const;

  struct Comparison {
    bool readable = false;  ///< the file could be opened and was well-formed
    std::uint64_t ticks = 0;
    std::uint64_t cells = 0;
    std::uint64_t wrong = 0;
    std::uint32_t first_wrong_tick = 0;  ///< 0: none
    Comparison& operator+=(const Comparison& other);
  };
  /// Compares the recorded pictures with those of `player` in the truth file.
  Comparison compare(const std::string& path, std::uint32_t player) const;

 private:
  void record(const Replica& replica, std::uint32_t tick);

  struct Track {
    std::uint32_t generation = 0;
    CellPosition first;
    bool moved = false;
  };
  std::size_t m_max_cells;
  std::size_t m_cells = 0;
  bool m_full = false;
  bool m_started = false;
  CompletenessTracker m_tracker;
  std::uint32_t m_tick = 0;  ///< tick of the newest applied snapshot
  bool m_complete = false;   ///< the picture was complete after the last snapshot of that tick
  bool m_skips = false;
  std::map<std::uint32_t, df::Canvas> m_pictures;
  std::unordered_map<std::uint32_t, Track> m_tracks;  ///< indexed by slot
  std::size_t m_removed_moved = 0;                    ///< number of moved Objects whose slot was reused
};

}  // namespace naiad
