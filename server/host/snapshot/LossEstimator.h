// What a line does to one client's snapshots: how many it loses, and whether they overtake each other on it.
#pragma once

#include <algorithm>
#include <cstdint>

namespace naiad {

class LossEstimator {
 public:
  /// A snapshot arrived, or is taken for lost.
  void note(bool was_lost) {
    const double hit = was_lost ? 1.0 : 0.0;
    m_loss += (hit - m_loss) / kShort;
    m_seen = std::min(m_seen + 1, kLong);
    m_usual_loss += (hit - m_usual_loss) / std::max(m_seen, kShort);
    m_patient = std::max(m_patient - 1, 0);
  }
  /// One that was taken for lost has arrived after all.
  void noteLate() { m_patient = kRemembered; }

  /// Share that was lost lately, 0 … 1: over some 64 snapshots.
  double loss() const { return m_loss; }
  /// The same over some 512, once there were so many: what is to be expected.
  double usualLoss() const { return m_usual_loss; }
  /// A snapshot counts as lost when so many newer ones were sent and the newest of them arrived. Most lines
  /// keep the order, so that the first gap tells; where something came late, there is patience for a while
  /// (as RFC 8985 has it for TCP).
  int patience() const { return m_patient > 0 ? kPatience : 1; }

  static constexpr int kPatience = 3;
  static constexpr int kRemembered = 1024;  ///< snapshots

 private:
  static constexpr int kShort = 64;
  static constexpr int kLong = 512;

  double m_loss = 0;
  double m_usual_loss = 0;
  int m_seen = 0;
  int m_patient = 0;
};

}  // namespace naiad
