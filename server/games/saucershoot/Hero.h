// A player's ships, one after another. After a loss, the next ship is launched after a moment. After the loss
// of the last one, the pilot watches until the round is over.
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

  /// True if the pilot has lost the last ship.
  bool isSpent() const { return m_ships == 0; }

  int eventHandler(const df::Event* p_e) override;
  int draw() override;

 private:
  void step();
  void keyboard(const df::EventKeyboard& event);
  void mouse(const df::EventMouse& event);

  void launch();
  void lose();
  void retire();
  df::Vector freePlace();
  void fire(df::Vector direction);
  void fireNuke();
  df::Vector nose() const;
  df::Vector aimAhead() const;

  void showStatus(df::Player& player) const;
  void showMessage(df::Player& player) const;

  std::uint32_t m_player;  // an id instead of a pointer, because the Player may leave
  std::string m_name;
  df::Color m_color;
  Trigger m_trigger;
  bool m_lost = false;
  int m_ships = 3;      // remaining ships, including this one
  int m_wait = 0;       // ticks: remaining shield while flying, or time until the next launch
  int m_gun_wait = 0;   // ticks until the gun is ready
  int m_hint_wait = 0;  // ticks for which the keys are still shown
  int m_nukes = 0;
  int m_hits = 0;  // hits since the last nuke was earned
};
