// Checks in production that a client sees what the world shows its player, for one session at a time.
//
// The server keeps a replica, the shadow. It applies the snapshots that the client acknowledged, so it equals
// the client's replica. If the newest of them carried everything pending and no lost change is missing, the
// shadow must draw cell by cell what the engine drew for the player in that tick.
//
// The shadow needs all snapshots of a world. So an audit starts with a session's first snapshot, or when its
// world is sent again: after a reset, for a new round or room, or to another process of the client.
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "host/session/Counters.h"
#include "host/snapshot/SnapshotSender.h"
#include "shared/replica/Replica.h"
#include "shared/values/Canvas.h"

namespace naiad {

/// Memory: the shadow, up to 128 unacknowledged snapshots and up to 128 pictures. Thread: the session's.
class ReplicaAudit {
 public:
  /// The audit counts in audited_pictures, audited_cells and wrong_cells.
  explicit ReplicaAudit(Counters& counters) : m_counters(counters) {}

  /// Call when the next snapshots send a world from the beginning.
  void restart() { m_state = State::kBegins; }
  /// Call before the snapshots of `tick` are built. `newest`: number of the newest snapshot so far.
  void beginTick(std::uint32_t newest, std::uint32_t tick);
  void recordSent(const SnapshotPacket& packet);
  /// Records what the world shows the player at the end of `tick`. Call it before the tick's snapshots are
  /// sent, in the ticks to compare.
  void recordTruth(std::uint32_t tick, df::Canvas picture);
  /// Call after `sender` has processed this acknowledgement.
  void acknowledge(const AckWindow& acks, const SnapshotSender& sender);

 private:
  enum class State { kWaits, kBegins, kRuns };
  struct Sent {
    std::uint32_t number = 0;
    std::string bytes;
  };
  struct Truth {
    std::uint32_t tick = 0;
    df::Canvas picture;
  };
  static constexpr std::size_t kMaxSent = 128;
  static constexpr std::size_t kMaxTruths = 128;

  void applyAcknowledged(const AckWindow& acks);
  void apply(const std::string& bytes);

  Counters& m_counters;
  State m_state = State::kWaits;
  Replica m_shadow;
  SnapshotHeader m_header;     ///< header of the newest snapshot that the shadow has applied
  std::deque<Sent> m_sent;     ///< unacknowledged snapshots, oldest first
  std::deque<Truth> m_truths;  ///< pictures not compared yet, oldest first
};

}  // namespace naiad
