#include "host/journal/CopyMarks.h"

#include <utility>

namespace naiad {

bool CopyMarks::isDue(std::uint32_t ticks) const {
  if (m_asked == 0) return ticks >= kFirst;
  const std::uint32_t since = ticks - m_asked;
  return since >= kTicks || (since >= kFewestTicks && m_time >= kLongest);
}

void CopyMarks::beginTick(std::uint32_t ticks, std::vector<std::uint32_t> players, bool is_kept) {
  m_asked = ticks;
  m_time = {};
  if (is_kept) m_under_way = CopyMark{ticks, std::move(players), 0};
}

bool CopyMarks::endTick(std::size_t records, std::chrono::nanoseconds time) {
  m_time += time;
  if (!m_under_way) return false;
  m_under_way->records = records;
  m_marks.push_back(*std::exchange(m_under_way, std::nullopt));
  if (m_marks.size() > kMost) m_marks.pop_front();
  return true;
}

// The next one is due soon: what goes on has one copy fewer.
std::optional<CopyMark> CopyMarks::take(std::uint32_t ticks) {
  m_under_way.reset();
  m_asked = 0;
  while (!m_marks.empty() && m_marks.back().ticks > ticks) m_marks.pop_back();
  if (m_marks.empty() || m_marks.back().ticks != ticks) return std::nullopt;
  CopyMark mark = std::move(m_marks.back());
  m_marks.pop_back();
  return mark;
}

void CopyMarks::clear() {
  *this = CopyMarks();
}

}  // namespace naiad
