// Tables that find the key of a character, a control byte, an escape sequence's number, a kitty code or a
// virtual key of Windows.
#pragma once

#include "client/terminal/InputDecoder.h"

namespace naiad {

/// Returns the key that types `ch` on a US keyboard, with kShift if that needs shift ('A' is key A with
/// shift). Undefined beyond ASCII.
KeyEvent keyOfCharacter(char32_t ch);

/// Returns the key of a byte below 0x20 or of 0x7F: Return, Tab, Backspace, Escape, or Control with another
/// key.
KeyEvent keyOfControl(unsigned char byte);

/// Returns the key of `CSI … letter` and `SS3 letter`: cursor keys, Home, End, F1 to F4; Tab with shift
/// (CSI); the keypad (SS3).
df::Keyboard::Key keyOfFinal(char final, bool ss3);

/// Returns the key of `CSI number ~`: editing and function keys, with the numbers of xterm and rxvt.
df::Keyboard::Key keyOfTilde(int number);

/// Returns the key of a kitty code: a Unicode character, or a functional key in the private use area.
df::Keyboard::Key keyOfKitty(int code);

/// Returns the key of a virtual key of Windows (VK_…), by its position on a US keyboard.
df::Keyboard::Key keyOfWindows(int virtual_key, int scan_code, bool enhanced);

/// Returns the character that the keypad key with this kitty code types; 0 for all other codes.
char32_t characterOfKeypad(int code);

}  // namespace naiad
