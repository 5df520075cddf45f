#include "FrameJudge.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "../scene/Status.h"
#include "Quantile.h"

namespace bench::path {

void FrameJudge::look(const Picture& screen, Nanoseconds now) {
  const auto counter = counterIn(screen);
  if (!counter) return;  // the counter is being painted
  if (!m_shown.empty() && *counter <= m_shown.back().tick) return;
  const Truth::Moment* moment = m_truth.find(*counter);
  if (moment == nullptr) return;  // a number that is half painted
  if (m_pending && *m_pending != *counter) m_refused.push_back(now);
  if (m_pending != counter) m_best = 0;
  m_pending = counter;
  if (!isRight(screen, *counter)) return;
  m_shown.push_back({now, moment->start, *counter});
  m_pending.reset();
}

bool FrameJudge::isRight(const Picture& screen, std::uint32_t tick) {
  std::vector<const Picture*> around;
  for (int distance = -kTolerance; distance <= kTolerance; ++distance) {
    const Truth::Moment* moment = m_truth.find(static_cast<std::uint32_t>(static_cast<int>(tick) + distance));
    if (moment != nullptr) around.push_back(&moment->picture);
  }
  const Truth::Moment* own = m_truth.find(tick);
  if (own != nullptr) m_best = std::max(m_best, likeness(screen, own->picture, around));
  return m_best >= kLikenessPercent;
}

Fluency fluencyOf(const std::vector<Shown>& shown, Nanoseconds from, Nanoseconds to) {
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
