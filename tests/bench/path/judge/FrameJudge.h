// Determines which ticks a screen showed, and when.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "../Monotonic.h"
#include "../scene/Picture.h"
#include "../scene/Truth.h"

namespace bench::path {

/// A tick that appeared on the screen.
struct Shown {
  Nanoseconds at{};     ///< when the tick appeared on the screen
  Nanoseconds start{};  ///< start of the tick in the simulation
  std::uint32_t tick = 0;
};

class FrameJudge {
 public:
  /// Minimum percentage of right cells, among the cells that are not blank on the screen or not blank in the
  /// truth.
  static constexpr double kLikenessPercent = 97;
  /// A cell is right if it equals the truth of any tick at most this far from the counter's, because clients
  /// may draw moving objects where they are now, but new characters only when they have received them.
  static constexpr int kTolerance = 2;

  explicit FrameJudge(const Truth& truth) : m_truth(truth) {}

  /// Records the present screen. A frame counts when enough of its cells are right.
  void look(const Picture& screen, Nanoseconds now);
  /// Returns the ticks that counted, in ascending order.
  const std::vector<Shown>& shown() const { return m_shown; }
  /// Returns the times at which a new counter appeared before the frame of the previous counter had counted.
  const std::vector<Nanoseconds>& refused() const { return m_refused; }
  /// Returns the best likeness of the last frame that did not count, in percent.
  double lastLikeness() const { return m_best; }

 private:
  bool isRight(const Picture& screen, std::uint32_t tick);

  const Truth& m_truth;
  std::vector<Shown> m_shown;
  std::vector<Nanoseconds> m_refused;
  std::optional<std::uint32_t> m_pending;  // counter of the present frame, until the frame counts
  double m_best = 0;
};

/// Measures of how fluent the game looks to people in [from, to).
struct Fluency {
  double frames_per_second = 0;
  double staleness_p50_ms = 0;  ///< age of the tick on the screen, sampled every millisecond
  double staleness_p99_ms = 0;
  double freeze_ms = 0;  ///< longest time between two increases of the counter
};
/// Computes the fluency. All figures are NaN if nothing was shown before `from`.
Fluency fluencyOf(const std::vector<Shown>& shown, Nanoseconds from, Nanoseconds to);

}  // namespace bench::path
