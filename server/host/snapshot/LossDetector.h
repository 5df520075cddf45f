// Decides from acknowledgements which snapshots are lost.
#pragma once

#include <array>
#include <cstdint>

#include "host/snapshot/Flight.h"
#include "host/snapshot/LossEstimator.h"
#include "shared/replica/Acks.h"

namespace naiad {

class LossDetector {
 public:
  /// Is the snapshot, which `acks` leaves out, lost? A stream loses nothing, but it may be late.
  bool isLost(const Flight::Snapshot& snapshot, const AckWindow& acks) const {
    const auto behind = static_cast<std::int32_t>(acks.newest - snapshot.number);
    const int patience = snapshot.large ? static_cast<int>(Flight::kMaxSnapshots) : m_estimator.patience();
    return behind >= patience;
  }
  /// The snapshot is settled. The loss of a probe says nothing of the line.
  void recordOutcome(const Flight::Snapshot& snapshot, bool lost) {
    if (lost) m_missing[snapshot.number % m_missing.size()] = snapshot.number;
    if (!snapshot.probe) m_estimator.addOutcome(lost);
  }
  /// Snapshots that counted as lost and are among `acks` were late.
  void recordLateArrivals(const AckWindow& acks) {
    for (std::uint32_t& number : m_missing) {
      if (number == 0 || !acks.has(number)) continue;
      m_estimator.addLateArrival();
      number = 0;
    }
  }
  const LossEstimator& estimator() const { return m_estimator; }

 private:
  LossEstimator m_estimator;
  std::array<std::uint32_t, 16> m_missing{};  ///< the last that counted as lost, by number
};

}  // namespace naiad
