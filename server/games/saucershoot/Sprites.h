// The sprites of the game, by the labels for Object::setSprite().
#pragma once

#include <string>

#include "Color.h"

/// Loads all sprites. Returns 0, or -1 if a file is missing or invalid; the log names the file.
int loadSprites();

/// Returns the label of a sprite in a colour: ships and bullets have a sprite for each pilot's colour.
inline std::string inColor(const std::string& what, df::Color color) {
  return what + "-" + std::to_string(static_cast<int>(color));
}
