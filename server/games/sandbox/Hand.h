// A player in the sandbox: a pointer that grabs, throws, makes and shoots.
#pragma once

#include "EventKeyboard.h"
#include "EventMouse.h"
#include "Object.h"
#include "PhysicsManager.h"
#include "Player.h"
#include "SoftObject.h"

class Hand : public df::Object {
 public:
  explicit Hand(df::Player& player);
  ~Hand() override;

  int eventHandler(const df::Event* p_e) override;
  int draw() override;

  /// Does this player want gravity to turn?
  bool wantsTurn() const { return m_wants_turn > 0; }
  void forgetTurn() { m_wants_turn = 0; }

 private:
  void mouse(const df::EventMouse& event);
  void keyboard(const df::EventKeyboard& event);
  void grab(df::Vector where);
  void shoot(df::Vector where);
  void step();
  void letGo();
  df::SoftBody* held() const;

  std::uint32_t m_player;
  df::Color m_color;
  df::Joint m_grip;      // on what is being dragged
  df::ObjectKey m_soft;  // the same, if it is soft
  int m_since_held = 0;  // ticks since the button was last known to be down
  int m_wants_turn = 0;  // ticks that the vote still counts
};
