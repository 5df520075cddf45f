// One state of a StateMachine, with the actions of the machine's owner in that state. States store nothing
// about an Object, so several machines may share them.
#pragma once

#include <string>
#include <utility>

#include "Object.h"

namespace df {

const std::string UNDEFINED_STATE = "__undefined state__";

class State {
 public:
  State() = default;
  State(const State&) = default;
  State& operator=(const State&) = default;
  virtual ~State() = default;

  void setType(std::string new_type) { m_type = std::move(new_type); }
  const std::string& getType() const { return m_type; }

  /// Enter() is called when the Object enters the state, Execute() in each StateMachine::Update(), Exit()
  /// when the Object leaves the state.
  virtual void Enter(Object* /*p_obj*/) {}
  virtual void Execute(Object* p_obj) = 0;
  virtual void Exit(Object* /*p_obj*/) {}

 private:
  std::string m_type = UNDEFINED_STATE;
};

}  // namespace df
