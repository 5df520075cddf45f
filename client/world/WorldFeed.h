// The client's world as the snapshots describe it, resets included: which replica a snapshot is for, and
// which replica is shown.
//
// The first world is not shown before it is complete: births may take several snapshots, and some time on a
// slow line. A snapshot of the next epoch begins another world, in a second replica, while the old one is
// shown. Both are shown incomplete if the player has waited for kPatience.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

#include "shared/replica/Acks.h"
#include "shared/replica/Replica.h"

namespace naiad {

class WorldFeed {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// After this time a world that is not complete is shown.
  static constexpr std::chrono::milliseconds kPatience{500};
  /// After so many stale snapshots in a row the client asks for the world again.
  static constexpr int kMaxStale = 30;

  /// `near`: the numbers that the next snapshots continue from. `epoch`: theirs.
  explicit WorldFeed(const SnapshotContext& near = {}, std::uint8_t epoch = 0)
      : m_replica(Replica::continuing(near)),
        m_epoch(epoch),
        m_before(near.number),
        m_complete(near.number) {}

  /// What became of a snapshot.
  enum class Result {
    kApplied,
    kShown,      ///< applied, and another world is shown from now on
    kIgnored,    ///< of an epoch that is over
    kStale,      ///< it uses an origin or a name that a newer snapshot has replaced
    kMalformed,  ///< the server is broken
  };
  /// Read and apply a snapshot; `header` becomes its header. `before` is called just before it is
  /// applied.
  Result applySnapshot(std::string_view bytes, Time now, SnapshotHeader& header,
                       const std::function<void(std::uint32_t tick)>& before);

  /// Another world follows, in this epoch, which is in about this tick now: perhaps before that of the
  /// present one.
  void expectWorld(std::uint8_t epoch, std::uint32_t tick, Time now);
  /// The server's tick is at least this one: snapshots to come have the low bits of ticks near it.
  void noteTick(std::uint32_t tick);

  /// The one to show.
  const Replica& shown() const { return m_replica; }
  /// Is there enough of the first world to show it? Once true, it stays so.
  bool hasPicture(Time now) const {
    return m_first_complete || (m_first_at && now - *m_first_at >= kPatience);
  }
  /// Is another one about to replace it?
  bool isChanging() const { return m_next.has_value(); }
  /// Were so many snapshots in a row stale that the world should be sent again?
  bool wantsReset() const { return m_stale_in_a_row >= kMaxStale; }
  /// The last stale one reached that number: ask now.
  bool wantsResetNow() const { return wantsReset() && m_stale_in_a_row % kMaxStale == 0; }
  /// Worlds begun after the first.
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

  // Of the first world only.
  std::uint32_t m_before;          ///< number of the newest snapshot that was sent before those to come
  std::uint32_t m_complete;        ///< the newest that was complete; m_before: none yet
  AckWindow m_arrived;             ///< of this world
  std::optional<Time> m_first_at;  ///< when the first arrived
  bool m_first_complete = false;
};

}  // namespace naiad
