// Does a client see what the world shows its player? An audit in production, of one session at a time.
//
// A replica of the server's own, the shadow, is fed with the very snapshots that were sent to the client and
// that the client has acknowledged, so it holds what the client's replica holds. When the newest of them
// carried all that was pending, and nothing that was lost is missing, the shadow must draw what the engine
// drew in that tick for the player, cell by cell.
//
// The shadow needs the snapshots from the beginning of a world, so the audit of a session begins with its
// first snapshot, or when its world is sent again: for a reset, a round, another process of the client.
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "host/session/Counters.h"
#include "host/snapshot/SnapshotSender.h"
#include "shared/replica/Replica.h"
#include "shared/values/Canvas.h"

namespace naiad {

/// Memory: the shadow, at most 128 snapshots that are not acknowledged, at most 128 pictures.
/// Thread: the session's.
class PictureAudit {
 public:
  /// Counts in audited_pictures, audited_cells and wrong_cells.
  explicit PictureAudit(Counters& counters) : m_counters(counters) {}

  /// The client is sent a world from the beginning, with the next snapshots.
  void restart() { m_state = State::kBegins; }
  /// Snapshots of this tick are about to be written; `newest`: the number of the newest one before.
  void beginTick(std::uint32_t newest, std::uint32_t tick);
  void recordSent(const SnapshotPacket& packet);
  /// What the world shows the player at the end of this tick. Call it before the tick's snapshots are sent,
  /// in those ticks that are to be compared.
  void recordTruth(std::uint32_t tick, df::Canvas picture);
  /// The client has acknowledged, and `sender` knows.
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
  SnapshotHeader m_header;     ///< of the newest snapshot that the shadow has
  std::deque<Sent> m_sent;     ///< and not acknowledged, oldest first
  std::deque<Truth> m_truths;  ///< that were not compared, oldest first
};

}  // namespace naiad
