// The pictures of the game, by the labels for Object::setSprite().
#pragma once

#include <string>

#include "Color.h"

/// Loads them all. Returns 0, or -1 if a file is missing or invalid; the log says which.
int loadSprites();

/// Ships and bullets have the colours of their pilots, so there is one sprite of each per colour.
inline std::string inColor(const std::string& what, df::Color color) {
  return what + "-" + std::to_string(static_cast<int>(color));
}
