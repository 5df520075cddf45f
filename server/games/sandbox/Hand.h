// A player in the sandbox: a pointer that grabs, throws, makes and shoots.
#pragma once

#include "Grip.h"
#include "PlayerObject.h"

class Hand : public df::PlayerObject<> {
 public:
  explicit Hand(df::Player& player);

  int draw() override;
  /// Does this player want gravity to turn?
  bool wantsTurn() const { return m_wants_turn > 0; }
  void forgetTurn() { m_wants_turn = 0; }

 private:
  void step() override;
  void mouse(const df::EventMouse& event) override;
  void keyboard(const df::EventKeyboard& event) override;
  void shoot();

  df::Grip m_grip;       // on what is being dragged
  int m_since_held = 0;  // ticks since the button was last known to be down
  int m_wants_turn = 0;  // ticks that the vote still counts
};
