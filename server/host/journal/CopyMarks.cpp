#include "host/journal/CopyMarks.h"

#include <utility>

namespace naiad {

static_assert(CopyMarks::kTicks % CopyMarks::kFewestTicks == 0, "that is when it is looked");

bool CopyMarks::isDueNow(std::uint32_t ticks, std::chrono::nanoseconds cpu_time) {
  const bool is_due = m_asked == 0 || ticks - m_asked >= kTicks || cpu_time - m_cpu_time >= kLongest;
  if (is_due) m_cpu_time = cpu_time;
  return is_due;
}

void CopyMarks::beginTick(std::uint32_t ticks, std::vector<std::uint32_t> players, bool is_kept) {
  m_asked = ticks;
  if (is_kept) m_under_way = CopyMark{ticks, std::move(players), 0};
}

bool CopyMarks::endTick(std::size_t records) {
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
