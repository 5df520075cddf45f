#include "server/gateway/Newcomers.h"

namespace naiad {

Newcomers::Place::~Place() {
  if (!m_owner) return;
  m_owner->m_limit.release(m_id);
  m_owner->m_hang_ups.erase(m_id);
}

bool Newcomers::Place::setBusy() {
  return m_owner->m_limit.noteHello(m_id);
}

void Newcomers::Place::setSilent() {
  HangUp hang_up = std::move(m_owner->m_hang_ups.at(m_id));
  m_owner->m_hang_ups.erase(m_id);
  m_owner->m_limit.release(m_id);
  m_id = m_owner->admit(m_prefix, std::move(hang_up));
}

Newcomers::Place Newcomers::take(const AddressPrefix& prefix, HangUp hang_up) {
  using Kind = HalfOpenLimit::Verdict::Kind;
  for (auto verdict = m_limit.judge(prefix); verdict.kind != Kind::kFits; verdict = m_limit.judge(prefix)) {
    if (verdict.kind != Kind::kEndFirst) return {};
    ++m_ended;
    const HangUp end = m_hang_ups.at(verdict.id);  // a copy: it is erased meanwhile
    end();
  }
  return {*this, admit(prefix, std::move(hang_up)), prefix};
}

HalfOpenLimit::Id Newcomers::admit(const AddressPrefix& prefix, HangUp hang_up) {
  m_limit.admit(++m_newest, prefix);
  m_hang_ups[m_newest] = std::move(hang_up);
  return m_newest;
}

}  // namespace naiad
