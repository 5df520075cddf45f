// Measures the cost of a method of holding keys in a game, with scripted key patterns, compared with a
// terminal that reports releases, and with simulated players.
#pragma once

#include <string>
#include <vector>

#include "Typist.h"

namespace naiad {

/// Mean values over the scripted patterns; `missed` is a sum.
struct PatternFigures {
  double tap_over = 0;   ///< cells beyond the end with real releases, after a tap of 90 ms
  double hold_over = 0;  ///< cells beyond that end, after longer holds and changes of direction
  double behind = 0;     ///< cells short of that end, after longer holds
  double stalled = 0;    ///< milliseconds of a hold without the expected motion
  int missed = 0;        ///< patterns without any motion
};

/// Results of a simulated player in a minute.
struct PlayFigures {
  int good = 0;  ///< flags reached, bricks hit, landings, points
  int bad = 0;   ///< falls, balls lost, crashes, ships lost
};

/// Returns the games' names: platformer, breakout, lander, saucershoot.
const std::vector<std::string>& keyGames();

PatternFigures runPatterns(const std::string& game, const KeyMethod& method,
                           const TypedKeyboard::Options& keyboard);
PlayFigures playGame(const std::string& game, const KeyMethod& method,
                     const TypedKeyboard::Options& keyboard);

}  // namespace naiad
