#include "host/snapshot/AckedControl.h"

#include "shared/replica/SteeredCopy.h"

namespace naiad {

void AckedControl::tell(const ControlRecord& record) {
  m_told = true;
  m_at_rest = false;
  m_coasted = 0;
  m_then = record;
}

bool AckedControl::implies(const ControlRecord& truth, const df::ControlTable& table) {
  if (!m_told) return false;
  for (; m_coasted < kMaxCoasting && !m_at_rest && m_then.tick != truth.tick; ++m_coasted) {
    SteeredCopy copy(m_then, table);
    copy.begin();
    copy.finish();
    ControlRecord next = copy.now();
    m_then.tick = next.tick;
    m_at_rest = next == m_then;
    m_then = next;
  }
  m_then.tick = truth.tick;
  return m_then == truth;
}

}  // namespace naiad
