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
  void recordComplete(std::uint32_t number);
  /// The snapshot was not sent after all.
  void removeNewest(std::uint32_t number) { at(number) = {}; }
  /// The snapshot was lost. `pending`: what it carried is pending again, or still. `newest`: number of the
  /// newest snapshot.
  void recordLost(const Flight::Snapshot& snapshot, bool pending, std::uint32_t newest);

  /// Is this the checksum of a replica that has the snapshots in `acks`, all of which are settled? Nothing if
  /// too little is known of that moment.
  std::optional<bool> matches(const AckWindow& acks, std::uint64_t checksum) const;

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
