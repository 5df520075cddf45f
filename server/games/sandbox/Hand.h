// A player's pointer in the sandbox: grabs, throws, makes and shoots things.
#pragma once

#include "Grip.h"
#include "PlayerObject.h"

class Hand : public df::PlayerObject<> {
 public:
  explicit Hand(df::Player& player);

  int draw() override;
  /// True if this player has voted to rotate gravity.
  bool wantsTurn() const { return m_wants_turn > 0; }
  void forgetTurn() { m_wants_turn = 0; }

 private:
  void step() override;
  void mouse(const df::EventMouse& event) override;
  void keyboard(const df::EventKeyboard& event) override;
  void shoot();

  df::Grip m_grip;       // holds the dragged thing
  int m_since_held = 0;  // ticks since the button was last known to be down
  int m_wants_turn = 0;  // ticks for which the player's vote still counts
};
