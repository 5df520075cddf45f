// The client's world, with a replica for each epoch. Chooses the one for each snapshot and the one to show.
//
// The first world is not shown before it is complete: its objects may take several snapshots, and some time
// on a slow connection. A snapshot of the next epoch starts another world in a second replica, while the old
// one is shown. Either world is shown incomplete after kIncompleteTimeout.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

#include "shared/replica/Acks.h"
#include "shared/replica/Replica.h"

namespace naiad {

class EpochReplicas {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Time after its first snapshot, or after expectWorld(), for which a world is not shown while incomplete.
  static constexpr std::chrono::milliseconds kIncompleteTimeout{500};
  /// Number of consecutive stale snapshots after which the client requests the world again.
  static constexpr int kMaxStale = 30;

  /// `near`: numbers from which the next snapshots continue. `epoch`: their epoch.
  explicit EpochReplicas(const SnapshotContext& near = {}, std::uint8_t epoch = 0)
      : m_replica(Replica::continuing(near)),
        m_epoch(epoch),
        m_before(near.number),
        m_complete(near.number) {}

  enum class Result {
    kApplied,
    kShown,      ///< applied, and another world is shown from now on
    kIgnored,    ///< the snapshot belongs to a past epoch
    kStale,      ///< it uses an origin or a definition that a newer snapshot has replaced
    kMalformed,  ///< not a valid snapshot: the server is broken
  };
  /// Reads and applies a snapshot. If it can be applied, sets `header` to its header, then calls `before`.
  Result applySnapshot(std::string_view bytes, Time now, SnapshotHeader& header,
                       const std::function<void(std::uint32_t tick)>& before);

  /// Call when another world will follow. Its snapshots have this epoch; its tick is now near `tick`, which
  /// may be lower than that of the present world.
  void expectWorld(std::uint8_t epoch, std::uint32_t tick, Time now);
  /// Call when the server's tick is known to be at least `tick`. Snapshots carry only the low bits of their
  /// tick; they are taken to mean the tick nearest to this one.
  void advanceTick(std::uint32_t tick);

  const Replica& shown() const { return m_replica; }
  /// True once the first world is complete, or kIncompleteTimeout after its first snapshot; then stays true.
  bool hasPicture(Time now) const {
    return m_first_complete || (m_first_at && now - *m_first_at >= kIncompleteTimeout);
  }
  /// True if another replica is about to replace the shown one.
  bool isChanging() const { return m_next.has_value(); }
  /// True if kMaxStale or more consecutive snapshots were stale, so that the world should be sent again.
  bool needsReset() const { return m_stale_in_a_row >= kMaxStale; }
  /// True if the number of consecutive stale snapshots is a multiple of kMaxStale: request the world now.
  bool shouldRequestReset() const { return needsReset() && m_stale_in_a_row % kMaxStale == 0; }
  /// Returns the number of worlds after the first.
  std::uint64_t resets() const { return m_resets; }

 private:
  Replica* replicaFor(std::string_view bytes, Time now);
  void trackFirstWorld(const SnapshotHeader& header, Time now);

  Replica m_replica;
  std::uint8_t m_epoch;
  std::optional<Replica> m_next;
  std::uint8_t m_next_epoch = 0;
  Time m_reset_at{};
  std::uint64_t m_resets = 0;
  int m_stale_in_a_row = 0;

  // State of the first world only.
  std::uint32_t m_before;          ///< number of the last snapshot before those of this world
  std::uint32_t m_complete;        ///< number of the newest complete snapshot; m_before: none yet
  AckWindow m_arrived;             ///< received snapshots of this world
  std::optional<Time> m_first_at;  ///< arrival of this world's first snapshot
  bool m_first_complete = false;
};

}  // namespace naiad
