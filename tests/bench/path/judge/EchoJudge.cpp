#include "EchoJudge.h"

#include <algorithm>

namespace bench::path {

std::uint32_t EchoJudge::press(Nanoseconds now) {
  m_keys.push_back({now, std::nullopt});
  return static_cast<std::uint32_t>(m_keys.size() - 1);
}

void EchoJudge::look(std::optional<std::uint32_t> number, Nanoseconds now) {
  if (!number || (m_next > 0 && (m_next - 1) % m_period == *number)) return;
  // Two keys may have arrived between two frames. Then the frame shows only the later key, and the earlier
  // one has arrived, too.
  const std::size_t end = std::min(m_keys.size(), m_next + m_period - 1);
  for (std::size_t i = m_next; i < end; ++i) {
    if (i % m_period != *number) continue;
    for (; m_next <= i; ++m_next) m_keys[m_next].seen = now;
    return;
  }
}

std::vector<double> EchoJudge::latencies(Nanoseconds from, Nanoseconds to) const {
  std::vector<double> result;
  for (const Key& key : m_keys) {
    if (key.seen && key.pressed >= from && key.pressed < to) {
      result.push_back(milliseconds(*key.seen - key.pressed));
    }
  }
  return result;
}

std::size_t EchoJudge::unanswered(Nanoseconds from, Nanoseconds to) const {
  const auto missing = [&](const Key& key) { return !key.seen && key.pressed >= from && key.pressed < to; };
  return static_cast<std::size_t>(std::count_if(m_keys.begin(), m_keys.end(), missing));
}

}  // namespace bench::path
