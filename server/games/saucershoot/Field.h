// The layout of the screen, which several parts of the game use.
#pragma once

#include <cstdint>

#include "DisplayManager.h"

/// Width of the world, which is one window; nothing scrolls.
inline double fieldWidth() {
  return DM.getHorizontal();
}
inline double fieldHeight() {
  return DM.getVertical();
}

/// Upper and lower limit of the rows for the centres of ships and saucers. The other rows are for texts.
inline double topRow() {
  return 2;
}
inline double bottomRow() {
  return fieldHeight() - 4;
}

/// Ids of a player's texts for df::Player::setText().
enum TextId : std::uint32_t {
  STATUS_TEXT,   ///< top left: the player's points, ships and nukes
  TEAM_TEXT,     ///< top right: the present bonus for flying together
  MESSAGE_TEXT,  ///< second last row: the keys, and the latest event of this player
  BEST_TEXT,     ///< bottom: the best pilots so far
};
