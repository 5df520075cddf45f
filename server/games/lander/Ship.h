// A player's lander: a falling Body with jets that push it.
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

  double m_fuel = 0;                     // fuel in seconds of the main engine
  std::array<int, JETS> m_burning = {};  // remaining ticks of each jet
  int m_worth = 0;                       // points of the pad on which it stands
  int m_standing = 0;                    // number of ticks for which it has stood on the pad
  int m_wait = 0;                        // ticks until the next launch
  std::string m_message;
};
