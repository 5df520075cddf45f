// Determines which ticks a screen showed, and when.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <optional>
#include <vector>

#include "../Monotonic.h"
#include "../scene/Status.h"
#include "../scene/Truth.h"
#include "tests/bench/Percentile.h"

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
  void look(const Picture& screen, Nanoseconds now) {
    const auto counter = counterIn(screen);
    if (!counter) return;  // the counter is being painted
    if (!m_shown.empty() && *counter <= m_shown.back().tick) return;
    const Truth::Moment* moment = m_truth.find(*counter);
    if (moment == nullptr) return;  // a number that is half painted
    if (m_pending && *m_pending != *counter) m_refused.push_back(now);
    if (m_pending != counter) m_best = 0;
    m_pending = counter;
    std::vector<const Picture*> around;
    for (std::uint32_t tick = *counter - kTolerance; tick != *counter + kTolerance + 1; ++tick) {
      if (const Truth::Moment* near = m_truth.find(tick)) around.push_back(&near->picture);
    }
    m_best = std::max(m_best, likeness(screen, moment->picture, around));
    if (m_best < kLikenessPercent) return;
    m_shown.push_back({now, moment->start, *counter});
    m_pending.reset();
  }
  /// Returns the ticks that counted, in ascending order.
  const std::vector<Shown>& shown() const { return m_shown; }
  /// Returns the times at which a new counter appeared before the frame of the previous counter had counted.
  const std::vector<Nanoseconds>& refused() const { return m_refused; }
  /// Returns the best likeness of the last frame that did not count, in percent.
  double lastLikeness() const { return m_best; }

 private:
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
inline Fluency fluencyOf(const std::vector<Shown>& shown, Nanoseconds from, Nanoseconds to) {
  constexpr Nanoseconds kStep{1'000'000};
  const auto after = [](Nanoseconds time, const Shown& frame) { return time < frame.at; };
  auto next = std::upper_bound(shown.begin(), shown.end(), from, after);
  if (next == shown.begin()) return {NAN, NAN, NAN, NAN};
  Fluency result;
  const auto first = next;
  Nanoseconds increased = std::prev(next)->at;
  Nanoseconds freeze{};
  std::vector<double> staleness;
  for (Nanoseconds now = from; now < to; now += kStep) {
    for (; next != shown.end() && next->at <= now; ++next) {
      freeze = std::max(freeze, next->at - increased);
      increased = next->at;
    }
    staleness.push_back(milliseconds(now - std::prev(next)->start));
  }
  result.freeze_ms = milliseconds(std::max(freeze, to - increased));
  result.frames_per_second =
      static_cast<double>(next - first) / std::chrono::duration<double>(to - from).count();
  result.staleness_p50_ms = quantile(staleness, 0.5);
  result.staleness_p99_ms = quantile(staleness, 0.99);
  return result;
}

}  // namespace bench::path
