// An Object that a player steers. It is derived from any class of Objects and gets only that player's input.
//
//   class Ship : public df::PlayerObject<df::Body> {
//    public:
//     explicit Ship(df::Player& player) : PlayerObject(player) { … }
//
//    private:
//     void step() override;
//     void keyboard(const df::EventKeyboard& event) override;
//   };
//
//   new df::JoinSpawner<Ship>;  // before GM.run(): each player that joins gets one
//
// The PlayerObject is the player's Object (Player::setObject). It is deleted when the player leaves.
#pragma once

#include <cstdint>

#include "EventKeyboard.h"
#include "EventMouse.h"
#include "EventPlayer.h"
#include "EventStep.h"
#include "Object.h"
#include "Player.h"
#include "WorldManager.h"

namespace df {

template <class Base = Object>
class PlayerObject : public Base {
 public:
  /// Makes the Object in the current world. `player` must be in that world.
  explicit PlayerObject(Player& player) : m_player(player.getId()), m_color(player.getColor()) {
    for (const EventType& type : {STEP_EVENT, KEYBOARD_EVENT, MSE_EVENT, LEAVE_EVENT}) {
      this->registerInterest(type);
    }
    player.setObject(this);
  }

  /// Returns the player that steers the Object; null from the tick in which they leave.
  Player* getPlayer() const { return WM.getPlayer(m_player); }
  /// Returns the player's colour.
  Color getColor() const { return m_color; }

  int eventHandler(const Event* p_e) override {
    const EventType& type = p_e->getType();
    if (type == STEP_EVENT) {
      if (getPlayer() != nullptr) step();
    } else if (type == KEYBOARD_EVENT) {
      const auto& event = *static_cast<const EventKeyboard*>(p_e);
      if (event.getPlayer() == m_player) keyboard(event);
    } else if (type == MSE_EVENT) {
      const auto& event = *static_cast<const EventMouse*>(p_e);
      if (event.getPlayer() == m_player) mouse(event);
    } else if (type == LEAVE_EVENT) {
      if (static_cast<const EventLeave*>(p_e)->getPlayer() == m_player) WM.markForDelete(this);
    } else {
      return handle(p_e);
    }
    return 1;
  }

 protected:
  /// Called in each tick while the player is there.
  virtual void step() {}
  /// Called with each key of this player.
  virtual void keyboard(const EventKeyboard& /*event*/) {}
  /// Called with each mouse event of this player.
  virtual void mouse(const EventMouse& /*event*/) {}
  /// Called with any other event, like Object::eventHandler().
  virtual int handle(const Event* p_e) { return Base::eventHandler(p_e); }

 private:
  std::uint32_t m_player;
  Color m_color;
};

/// Makes an Its(Player&) for each player that joins. A JoinSpawner is invisible and collides with nothing.
template <class Its>
class JoinSpawner : public Object {
 public:
  JoinSpawner() {
    setSolidness(SPECTRAL);
    setVisible(false);
    registerInterest(JOIN_EVENT);
  }
  int eventHandler(const Event* p_e) override {
    if (p_e->getType() != JOIN_EVENT) return 0;
    new Its(*WM.getPlayer(static_cast<const EventJoin*>(p_e)->getPlayer()));
    return 1;
  }
};
/// The name of JoinSpawner in earlier versions.
template <class Its>
using Welcome [[deprecated("say JoinSpawner")]] = JoinSpawner<Its>;

}  // namespace df
