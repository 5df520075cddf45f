// A finite state machine for an Object. The game calls Update(), for example in each step. The machine does
// not own its owner or its states.
#pragma once

#include "Object.h"
#include "State.h"

namespace df {

class StateMachine {
 public:
  StateMachine() = default;

  void setOwner(Object* p_new_owner) { m_p_owner = p_new_owner; }
  Object* getOwner() const { return m_p_owner; }
  /// Sets the state without calling Exit() or Enter().
  void setState(State* p_new_state) { m_p_state = p_new_state; }
  State* getState() const { return m_p_state; }
  void setPreviousState(State* p_new_state) { m_p_previous = p_new_state; }
  State* getPreviousState() const { return m_p_previous; }
  /// A state that Update() executes before the present state; null for none.
  void setGlobalState(State* p_new_state) { m_p_global = p_new_state; }
  State* getGlobalState() const { return m_p_global; }

  /// Executes the global and the present state.
  void Update() {
    if (m_p_global != nullptr) m_p_global->Execute(m_p_owner);
    if (m_p_state != nullptr) m_p_state->Execute(m_p_owner);
  }
  /// Leaves the present state and enters another one; null is ignored.
  void changeState(State* p_new_state) {
    if (p_new_state == nullptr) return;
    m_p_previous = m_p_state;
    if (m_p_state != nullptr) m_p_state->Exit(m_p_owner);
    m_p_state = p_new_state;
    m_p_state->Enter(m_p_owner);
  }
  /// Changes to the previous state.
  void revertToPrevious() { changeState(m_p_previous); }

 private:
  Object* m_p_owner = nullptr;
  State* m_p_state = nullptr;
  State* m_p_previous = nullptr;
  State* m_p_global = nullptr;
};

}  // namespace df
