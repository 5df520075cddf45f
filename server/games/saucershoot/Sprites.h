// The pictures of the game, by the labels that Object::setSprite() takes.
#pragma once

#include <string>

#include "Color.h"

/// Load them all. Return 0, or -1 if a file is missing or wrong; the log says which.
int loadSprites();

/// Ships and bullets have the colours of their pilots, so there is one sprite of each for every colour.
inline std::string inColor(const std::string& what, df::Color color) {
  return what + "-" + std::to_string(static_cast<int>(color));
}
