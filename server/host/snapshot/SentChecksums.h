// The checksums of a client's replica after its last snapshots, to compare with the client's own.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "host/snapshot/InFlightSnapshots.h"
#include "shared/replica/Acks.h"

namespace naiad {

class SentChecksums {
 public:
  /// `first`: number of the next snapshot.
  explicit SentChecksums(std::uint32_t first = 1) : m_clean_from(first) {}

  /// Records the checksum of a replica that has all snapshots up to `number`.
  void recordSent(std::uint32_t number, std::uint64_t checksum) { at(number) = {number, checksum}; }
  /// Call when snapshot `number`, the newest, carries everything pending.
  void recordComplete(std::uint32_t number) {
    if (!m_repairing) return;
    m_clean_from = number;
    m_repairing = false;
  }
  /// Call when snapshot `number`, the newest, is not sent after all.
  void removeNewest(std::uint32_t number) { at(number) = {}; }
  /// Call when the snapshot was lost. `pending`: true if its contents, or newer ones in their place, are
  /// pending. `newest`: number of the newest snapshot.
  void recordLost(const InFlightSnapshots::Snapshot& snapshot, bool pending, std::uint32_t newest) {
    m_repairing = m_repairing || pending;
    // If nothing is pending, newer snapshots have already carried the contents.
    if (!snapshot.empty && isNewer(newest, m_clean_from)) m_clean_from = newest;
    Moment& moment = at(snapshot.number);
    if (moment.number == snapshot.number)
      moment.fate = snapshot.empty ? Moment::kNotMissed : Moment::kRepaired;
  }

  /// True if this is the checksum of a replica that has the snapshots in `acks`; nullopt if too little is
  /// known about that moment. Call after SnapshotSender::acknowledge().
  std::optional<bool> matches(const AckWindow& acks, std::uint64_t checksum) const {
    const std::uint32_t number = acks.newest;
    if (m_repairing || isNewer(m_clean_from, number)) return std::nullopt;
    // Each missing snapshot must be known to be lost, and its contents must have been sent again. For
    // snapshots older than the window this is known already.
    const Moment* acknowledged = nullptr;
    for (const Moment& moment : m_moments) {
      const std::uint32_t behind = number - moment.number;
      if (behind == 0 && moment.number != 0) acknowledged = &moment;
      if (moment.number == 0 || behind == 0 || behind > InFlightSnapshots::kMaxSnapshots ||
          acks.has(moment.number))
        continue;
      if (moment.fate == Moment::kNotMissed) continue;
      if (moment.fate != Moment::kRepaired || !isNewer(m_clean_from, moment.number)) return std::nullopt;
    }
    if (acknowledged == nullptr) return std::nullopt;
    return acknowledged->checksum == checksum;
  }

 private:
  static constexpr std::size_t kMaxMoments = 2 * InFlightSnapshots::kMaxSnapshots;
  /// The state of the replica after a snapshot.
  struct Moment {
    std::uint32_t number = 0;
    std::uint64_t checksum = 0;
    enum : std::uint8_t { kUnknown, kNotMissed, kRepaired } fate = kUnknown;  ///< set for lost snapshots
  };
  Moment& at(std::uint32_t number) { return m_moments[number % kMaxMoments]; }

  std::array<Moment, kMaxMoments> m_moments;  ///< indexed by number modulo kMaxMoments
  std::uint32_t m_clean_from;  ///< from this snapshot on, everything lost before it has been sent again
  bool m_repairing = false;    ///< true while lost contents are pending
};

}  // namespace naiad
