// A player's ship. It lives as long as its player stays: a lost ship is out of sight for a moment and then
// launched anew.
#pragma once

#include <cstdint>
#include <string>

#include "Color.h"
#include "Object.h"
#include "Player.h"
#include "Trigger.h"

namespace df {
class EventKeyboard;
class EventMouse;
}  // namespace df

class Hero : public df::Object {
 public:
  explicit Hero(df::Player& player);

  int eventHandler(const df::Event* p_e) override;
  int draw() override;

 private:
  void step();
  void keyboard(const df::EventKeyboard& event);
  void mouse(const df::EventMouse& event);

  void launch();
  void lose();
  df::Vector freePlace();
  void fire(df::Vector direction);
  void fireNuke();
  df::Vector aimAhead() const;

  void showStatus(df::Player& player) const;
  void showMessage(df::Player& player) const;

  std::uint32_t m_player;  // id: the Player itself is gone some day
  std::string m_name;
  df::Color m_color;
  Trigger m_trigger;
  bool m_lost = false;
  int m_wait = 0;       // ticks: of the shield while flying, to the next launch while lost
  int m_gun_wait = 0;   // ticks until the gun is ready
  int m_hint_wait = 0;  // ticks for which the keys are still shown
  int m_nukes = 0;
  int m_hits = 0;         // since the last nuke was earned
  int m_first_score = 0;  // the player's points when this life began
  int m_life_score = 0;   // points of the last life
};
