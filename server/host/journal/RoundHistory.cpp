#include "host/journal/RoundHistory.h"

namespace naiad {

static_assert(RoundHistory::kTicks % RoundHistory::kFewestTicks == 0, "that is when it is looked");

bool RoundHistory::add(std::string_view record) {
  if (m_records.size() + record.size() > kMaxBytes && !forgetBeginning()) {
    *this = RoundHistory();
    return false;
  }
  m_records += record;
  return true;
}

bool RoundHistory::forgetBeginning() {
  const std::size_t forgotten = m_marks.empty() ? 0 : m_marks.front().records;
  if (forgotten == 0) return false;
  for (CopyMark& mark : m_marks) mark.records -= forgotten;
  m_records.erase(0, forgotten);
  m_has_beginning = false;
  return true;
}

bool RoundHistory::isDueNow(std::uint32_t ticks, std::chrono::nanoseconds cpu_time) {
  const bool is_due = m_asked == 0 || ticks - m_asked >= kTicks || cpu_time - m_cpu_time >= kLongest;
  if (is_due) m_cpu_time = cpu_time;
  return is_due;
}

void RoundHistory::beginCopy(std::uint32_t ticks, std::vector<std::uint32_t> players, bool is_kept) {
  m_asked = ticks;
  if (is_kept) m_under_way = CopyMark{ticks, std::move(players), 0};
}

bool RoundHistory::endTick() {
  if (!m_under_way) return false;
  m_under_way->records = m_records.size();
  m_marks.push_back(*std::exchange(m_under_way, std::nullopt));
  if (m_marks.size() > kMost) m_marks.pop_front();
  if (!m_has_beginning) forgetBeginning();
  return true;
}

// The next one is due soon: what goes on has one copy fewer.
std::optional<CopyMark> RoundHistory::takeCopy(std::uint32_t ticks) {
  m_under_way.reset();
  m_asked = 0;
  while (!m_marks.empty() && m_marks.back().ticks > ticks) m_marks.pop_back();
  if (m_marks.empty() || m_marks.back().ticks != ticks) return std::nullopt;
  CopyMark mark = std::move(m_marks.back());
  m_marks.pop_back();
  return mark;
}

void RoundHistory::dropCopies() {
  m_marks.clear();
  m_under_way.reset();
  m_asked = 0;
  m_cpu_time = {};
}

}  // namespace naiad
