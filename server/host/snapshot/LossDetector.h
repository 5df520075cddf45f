// Decides from acknowledgements which snapshots are lost.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "host/snapshot/InFlightSnapshots.h"
#include "shared/replica/Acks.h"

namespace naiad {

/// Estimates the loss and reordering of one client's snapshots.
class LossEstimator {
 public:
  /// Call when a snapshot arrived or counts as lost.
  void addOutcome(bool was_lost) {
    const double outcome = was_lost ? 1.0 : 0.0;
    m_loss += (outcome - m_loss) / kShort;
    m_count = std::min(m_count + 1, kLong);
    m_usual_loss += (outcome - m_usual_loss) / std::max(m_count, kShort);
    m_reorder_remaining = std::max(m_reorder_remaining - 1, 0);
  }
  /// Call when a snapshot that counted as lost has arrived after all.
  void addLateArrival() { m_reorder_remaining = kReorderMemory; }

  /// Mean loss over about the last 64 snapshots, 0 … 1.
  double loss() const { return m_loss; }
  /// Mean loss over about 512 snapshots, once there were this many, 0 … 1.
  double usualLoss() const { return m_usual_loss; }
  /// A snapshot counts as lost when this many newer ones were sent and the newest of them arrived. Most
  /// connections keep the order, so the first gap means a loss. After a late arrival, reorderThreshold() is
  /// higher for kReorderMemory snapshots (as RFC 8985 does for TCP).
  int reorderThreshold() const { return m_reorder_remaining > 0 ? kReorderThreshold : 1; }

  static constexpr int kReorderThreshold = 3;
  static constexpr int kReorderMemory = 1024;  ///< number of snapshots

 private:
  static constexpr int kShort = 64;
  static constexpr int kLong = 512;

  double m_loss = 0;
  double m_usual_loss = 0;
  int m_count = 0;
  int m_reorder_remaining = 0;
};

class LossDetector {
 public:
  /// True if the snapshot, which `acks` does not confirm, counts as lost. On a stream it may just be late, so
  /// it counts as lost only after kMaxSnapshots newer ones.
  bool isLost(const InFlightSnapshots::Snapshot& snapshot, const AckWindow& acks) const {
    const auto behind = static_cast<std::int32_t>(acks.newest - snapshot.number);
    const int reorderThreshold =
        snapshot.large ? static_cast<int>(InFlightSnapshots::kMaxSnapshots) : m_estimator.reorderThreshold();
    return behind >= reorderThreshold;
  }
  /// Call when the snapshot arrived or counts as lost. Probes do not count in estimator().
  void recordOutcome(const InFlightSnapshots::Snapshot& snapshot, bool lost) {
    if (lost) m_missing[snapshot.number % m_missing.size()] = snapshot.number;
    if (!snapshot.probe) m_estimator.addOutcome(lost);
  }
  /// Call for each acknowledgement: it may confirm snapshots that counted as lost.
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
  std::array<std::uint32_t, 16> m_missing{};  ///< numbers of the last snapshots that counted as lost
};

}  // namespace naiad
