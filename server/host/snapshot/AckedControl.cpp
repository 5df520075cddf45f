#include "host/snapshot/AckedControl.h"

#include "shared/replica/SteeredCopy.h"

namespace naiad {

void AckedControl::setSent(const ControlRecord& record) {
  m_has_record = true;
  m_at_rest = false;
  m_coasted = 0;
  m_model = record;
}

bool AckedControl::implies(const ControlRecord& actual, const df::ControlTable& table) {
  if (!m_has_record) return false;
  for (; m_coasted < kMaxCoasting && !m_at_rest && m_model.tick != actual.tick; ++m_coasted) {
    SteeredCopy copy(m_model, table);
    copy.beginTick();
    copy.finishTick();
    ControlRecord next = copy.now();
    m_model.tick = next.tick;
    m_at_rest = next == m_model;
    m_model = next;
  }
  m_model.tick = actual.tick;
  return m_model == actual;
}

}  // namespace naiad
