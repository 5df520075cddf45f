// The client's world as the snapshots tell it, resets included: which replica a snapshot is for, and which
// one is shown.
//
// The first world is nothing to show before it is whole: births may take several snapshots, and on a thin
// line a while. A snapshot of the next epoch begins a world that comes anew. It grows in a replica of its own
// while the old one is shown. Both wait until the world is complete or the player has waited long enough.
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

  /// Then a world that is not complete is shown.
  static constexpr std::chrono::milliseconds kPatience{500};
  /// Snapshots in a row that mean what is gone: then the world is to come anew.
  static constexpr int kMaxStale = 30;

  /// `near`: what the snapshots to come count on from. `epoch`: theirs.
  explicit WorldFeed(const SnapshotContext& near = {}, std::uint8_t epoch = 0)
      : m_replica(Replica::continuing(near)),
        m_epoch(epoch),
        m_before(near.number),
        m_complete(near.number) {}

  /// What became of a snapshot.
  enum class Taken {
    kApplied,
    kShown,      ///< applied, and another world is shown from now on
    kIgnored,    ///< of an epoch that is over
    kStale,      ///< it means what is gone
    kMalformed,  ///< the server is broken
  };
  /// Read and apply a snapshot; `header` is what it said of itself. `before` is called just before it is
  /// applied.
  Taken take(std::string_view bytes, Time now, SnapshotHeader& header,
             const std::function<void(std::uint32_t tick)>& before);

  /// The one to show.
  const Replica& shown() const { return m_replica; }
  /// Is there enough of the first world to show it? Once true, it stays so.
  bool hasPicture(Time now) const { return m_whole || (m_began && now - *m_began >= kPatience); }
  /// Is another one about to replace it?
  bool isChanging() const { return m_next.has_value(); }
  /// So many stale ones came in a row that the world should be sent anew.
  bool wantsReset() const { return m_stale_in_a_row >= kMaxStale; }
  /// This was the last straw: ask for it now.
  bool wantsResetNow() const { return wantsReset() && m_stale_in_a_row % kMaxStale == 0; }
  /// Worlds that came anew.
  std::uint64_t resets() const { return m_resets; }

 private:
  Replica* replicaFor(std::string_view bytes, Time now);
  void noteFirst(const SnapshotHeader& header, Time now);

  Replica m_replica;
  std::uint8_t m_epoch;
  std::optional<Replica> m_next;
  std::uint8_t m_next_epoch = 0;
  Time m_reset_at{};
  std::uint64_t m_resets = 0;
  int m_stale_in_a_row = 0;

  // Of the first world only.
  std::uint32_t m_before;       ///< number of the newest snapshot that was sent before those to come
  std::uint32_t m_complete;     ///< the newest that was complete; m_before: none yet
  AckWindow m_came;             ///< what has come
  std::optional<Time> m_began;  ///< when the first came
  bool m_whole = false;
};

}  // namespace naiad
