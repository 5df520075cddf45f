// What a key types, and what it is called.
#pragma once

#include <string>

#include "Keyboard.h"

namespace df {

/// The character that a key types; 0 for none.
char characterOf(Keyboard::Key key, bool shift);
/// The key's name: "space", "a", "f1", …
std::string nameOfKey(Keyboard::Key key);

}  // namespace df
