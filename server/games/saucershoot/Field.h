// The places on the screen that several parts of the game agree on.
#pragma once

#include <cstdint>

#include "DisplayManager.h"

/// The world is one window; nothing scrolls.
inline double fieldWidth() {
  return DM.getHorizontal();
}
inline double fieldHeight() {
  return DM.getVertical();
}

/// Ships and saucers keep their middles on the rows from here to there. The others are left to the texts.
inline double topRow() {
  return 2;
}
inline double bottomRow() {
  return fieldHeight() - 4;
}

/// The numbers of the texts that a player sees, see df::Player::setText().
enum TextId : std::uint32_t {
  STATUS_TEXT,   ///< top left: the player's points, ships and nukes
  TEAM_TEXT,     ///< top right: what flying together is worth at the moment
  MESSAGE_TEXT,  ///< second last row: the keys, and what has just happened to this player
  BEST_TEXT,     ///< at the bottom: the best pilots so far
};
