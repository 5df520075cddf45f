// The layout of the screen, shared by several parts of the game.
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

/// Ships and saucers keep their centres within these rows. The other rows are for texts.
inline double topRow() {
  return 2;
}
inline double bottomRow() {
  return fieldHeight() - 4;
}

/// Numbers of a player's texts, see df::Player::setText().
enum TextId : std::uint32_t {
  STATUS_TEXT,   ///< top left: the player's points, ships and nukes
  TEAM_TEXT,     ///< top right: the present bonus for flying together
  MESSAGE_TEXT,  ///< second last row: the keys, and this player's latest event
  BEST_TEXT,     ///< bottom: the best pilots so far
};
