// What a way of holding keys costs in a game: scripted key patterns compared with a terminal that reports
// releases, and persons who play.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "Typist.h"

namespace naiad {

/// Of the scripted patterns, as means over them.
struct PatternFigures {
  double tap_over = 0;   ///< cells beyond where real releases end, of a tap of 90 ms
  double hold_over = 0;  ///< likewise, of longer holds and changes of direction
  double behind = 0;     ///< cells short of it, of longer holds
  double stalled = 0;    ///< milliseconds of a hold without the motion that it should give
  int missed = 0;        ///< patterns without any motion
};

/// Of a person who plays for a minute.
struct PlayFigures {
  int good = 0;  ///< flags reached, bricks hit, landings, points
  int bad = 0;   ///< falls, balls lost, crashes, ships lost
};

/// platformer, breakout, lander, saucershoot
const std::vector<std::string>& keyGames();

PatternFigures runPatterns(const std::string& game, const KeyMethod& method,
                           const TypedKeyboard::Options& keyboard);
PlayFigures playGame(const std::string& game, const KeyMethod& method,
                     const TypedKeyboard::Options& keyboard);

}  // namespace naiad
