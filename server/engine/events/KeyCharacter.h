// The characters that keys type, and the names of keys.
#pragma once

#include <string>

#include "Keyboard.h"

namespace df {

/// Returns the character that a key types, with or without Shift; 0 if it types none.
char characterOf(Keyboard::Key key, bool shift);
/// Returns the key's name, such as "space", "a" or "f1"; "undefined" for an unknown key.
std::string nameOfKey(Keyboard::Key key);

}  // namespace df
