// Counts the points, and shows the best pilots, whose list the server stores.
//
// A saucer gives its points times the number of pilots (up to four) with a hit in the last three seconds, so
// that it pays to keep friends in the game.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "HighScores.h"
#include "Object.h"

class EventShipLost;
class EventShotDown;

class Scoreboard : public df::Object {
 public:
  Scoreboard();
  int eventHandler(const df::Event* p_e) override;

 private:
  void step(int tick);
  void credit(const EventShotDown& shot_down);
  void enter(const EventShipLost& ship_lost);
  int teamFactor() const;
  std::string bestPilots() const;

  df::HighScores m_pilots{"pilots"};        // stored by the server from game to game
  std::map<std::uint32_t, int> m_last_hit;  // player -> tick of the player's last hit
  int m_show_best = 0;                      // ticks for which the best pilots are still shown
};
