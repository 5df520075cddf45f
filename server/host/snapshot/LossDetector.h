// Decides from acknowledgements which snapshots are lost.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "host/snapshot/Flight.h"
#include "shared/replica/Acks.h"

namespace naiad {

/// The loss and reordering of one client's snapshots.
class LossEstimator {
 public:
  /// A snapshot arrived, or is taken for lost.
  void addOutcome(bool was_lost) {
    const double outcome = was_lost ? 1.0 : 0.0;
    m_loss += (outcome - m_loss) / kShort;
    m_count = std::min(m_count + 1, kLong);
    m_usual_loss += (outcome - m_usual_loss) / std::max(m_count, kShort);
    m_patience_left = std::max(m_patience_left - 1, 0);
  }
  /// One that was taken for lost has arrived after all.
  void addLateArrival() { m_patience_left = kRemembered; }

  /// Share of the last 64 or so snapshots that was lost, 0 … 1.
  double loss() const { return m_loss; }
  /// The same over some 512, once there were so many: the loss to be expected.
  double usualLoss() const { return m_usual_loss; }
  /// A snapshot counts as lost when so many newer ones were sent and the newest of them arrived. Most lines
  /// keep the order, so that the first gap means a loss; after a late arrival the estimator waits longer for
  /// a while (as RFC 8985 does for TCP).
  int patience() const { return m_patience_left > 0 ? kPatience : 1; }

  static constexpr int kPatience = 3;
  static constexpr int kRemembered = 1024;  ///< snapshots

 private:
  static constexpr int kShort = 64;
  static constexpr int kLong = 512;

  double m_loss = 0;
  double m_usual_loss = 0;
  int m_count = 0;
  int m_patience_left = 0;
};

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
