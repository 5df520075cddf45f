// The checksums that a client's replica has after each of the last snapshots, to be compared with the
// client's own.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "host/snapshot/Flight.h"
#include "shared/replica/Acks.h"

namespace naiad {

class SentChecksums {
 public:
  /// `first`: number of the first snapshot to come.
  explicit SentChecksums(std::uint32_t first = 1) : m_clean_from(first) {}

  /// A replica that has all snapshots up to `number` has this checksum.
  void recordSent(std::uint32_t number, std::uint64_t checksum) { at(number) = {number, checksum}; }
  /// The newest snapshot carries all that was pending.
  void recordComplete(std::uint32_t number) {
    if (!m_repairing) return;
    m_clean_from = number;
    m_repairing = false;
  }
  /// The snapshot was not sent after all.
  void removeNewest(std::uint32_t number) { at(number) = {}; }
  /// The snapshot was lost. `pending`: what it carried is pending again, or still. `newest`: number of the
  /// newest snapshot.
  void recordLost(const Flight::Snapshot& snapshot, bool pending, std::uint32_t newest) {
    m_repairing = m_repairing || pending;
    // Where nothing is missing, newer snapshots have carried the same.
    if (!snapshot.empty && isNewer(newest, m_clean_from)) m_clean_from = newest;
    Moment& moment = at(snapshot.number);
    if (moment.number == snapshot.number)
      moment.fate = snapshot.empty ? Moment::kNotMissed : Moment::kRepaired;
  }

  /// Is this the checksum of a replica that has the snapshots in `acks`, all of which are settled? Nothing if
  /// too little is known of that moment.
  std::optional<bool> matches(const AckWindow& acks, std::uint64_t checksum) const {
    const std::uint32_t number = acks.newest;
    if (m_repairing || isNewer(m_clean_from, number)) return std::nullopt;
    // Every snapshot that is missing must be known to be lost, and its contents sent again since. Those older
    // than the window are.
    const Moment* acknowledged = nullptr;
    for (const Moment& moment : m_moments) {
      const std::uint32_t behind = number - moment.number;
      if (behind == 0 && moment.number != 0) acknowledged = &moment;
      if (moment.number == 0 || behind == 0 || behind > Flight::kMaxSnapshots || acks.has(moment.number))
        continue;
      if (moment.fate == Moment::kNotMissed) continue;
      if (moment.fate != Moment::kRepaired || !isNewer(m_clean_from, moment.number)) return std::nullopt;
    }
    if (acknowledged == nullptr) return std::nullopt;
    return acknowledged->checksum == checksum;
  }

 private:
  static constexpr std::size_t kMaxMoments = 2 * Flight::kMaxSnapshots;
  /// The replica after a snapshot.
  struct Moment {
    std::uint32_t number = 0;
    std::uint64_t checksum = 0;
    enum : std::uint8_t { kUnknown, kNotMissed, kRepaired } fate = kUnknown;  ///< of a lost snapshot
  };
  Moment& at(std::uint32_t number) { return m_moments[number % kMaxMoments]; }

  std::array<Moment, kMaxMoments> m_moments;  ///< by number, modulo their count
  std::uint32_t m_clean_from;                 ///< from here on, all that was lost before has been sent again
  bool m_repairing = false;                   ///< what was lost is pending
};

}  // namespace naiad
