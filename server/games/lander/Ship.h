// A player's lander: a Body that falls, and jets that push it.
#pragma once

#include <array>
#include <string>

#include "Body.h"
#include "EventCollision.h"
#include "PlayerObject.h"

class Ship : public df::PlayerObject<df::Body> {
 public:
  explicit Ship(df::Player& player);

  int draw() override;

 private:
  enum Jet { MAIN, LEFT, RIGHT, JETS };

  void launch();
  void keyboard(const df::EventKeyboard& event) override;
  void step() override;
  int handle(const df::Event* p_e) override;
  void touch(const df::EventCollision& event);
  void burn(Jet jet);
  void land(int worth);
  void crash(const std::string& why);
  void showStatus(df::Player& player) const;

  double m_fuel = 0;                     // seconds of the main engine
  std::array<int, JETS> m_burning = {};  // ticks that each jet still burns
  int m_worth = 0;                       // of the pad it stands on
  int m_standing = 0;                    // ticks on the pad
  int m_wait = 0;                        // ticks until the next launch
  std::string m_message;
};
