// Which ticks a screen showed, and when.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "../Monotonic.h"
#include "../scene/Picture.h"
#include "../scene/Truth.h"

namespace bench::path {

/// A tick that came onto the screen.
struct Shown {
  Nanoseconds at{};     ///< when
  Nanoseconds start{};  ///< when the tick began where it was simulated
  std::uint32_t tick = 0;
};

class FrameJudge {
 public:
  /// So much of the cells that are not blank, on the screen or in the truth, must equal the truth …
  static constexpr double kLikenessPercent = 97;
  /// … of some tick at most so far from the counter, each cell for itself: a client may draw what moves where
  /// it is by now, and what has a new character when it hears of it.
  static constexpr int kTolerance = 2;

  explicit FrameJudge(const Truth& truth) : m_truth(truth) {}

  /// This is the screen now. A frame counts from the moment on at which it is right.
  void look(const Picture& screen, Nanoseconds now);
  /// In order; counters only increase.
  const std::vector<Shown>& shown() const { return m_shown; }
  /// Moments at which a counter vanished from the screen (another one came) without its frame having counted.
  const std::vector<Nanoseconds>& refused() const { return m_refused; }
  /// Per cent of the last frame that did not count: its best likeness so far.
  double lastLikeness() const { return m_best; }

 private:
  bool isRight(const Picture& screen, std::uint32_t tick);

  const Truth& m_truth;
  std::vector<Shown> m_shown;
  std::vector<Nanoseconds> m_refused;
  std::optional<std::uint32_t> m_pending;  // the counter on the screen, until its frame counts
  double m_best = 0;
};

/// What people would feel in [from, to).
struct Fluency {
  double frames_per_second = 0;
  double staleness_p50_ms = 0;  ///< of samples of t - start of the tick on screen, taken every millisecond
  double staleness_p99_ms = 0;
  double freeze_ms = 0;  ///< longest time between two increases of the counter
};
/// All figures are NaN if nothing was shown before `from`.
Fluency fluencyOf(const std::vector<Shown>& shown, Nanoseconds from, Nanoseconds to);

}  // namespace bench::path
