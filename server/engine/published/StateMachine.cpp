#include "engine/published/StateMachine.h"

namespace df {

void StateMachine::Update() {
  if (m_p_global != nullptr) m_p_global->Execute(m_p_owner);
  if (m_p_state != nullptr) m_p_state->Execute(m_p_owner);
}

void StateMachine::changeState(State* p_new_state) {
  if (p_new_state == nullptr) return;
  m_p_previous = m_p_state;
  if (m_p_state != nullptr) m_p_state->Exit(m_p_owner);
  m_p_state = p_new_state;
  m_p_state->Enter(m_p_owner);
}

}  // namespace df
