// Finds the key of a character, control byte, escape sequence number, kitty code or Windows virtual key.
#pragma once

#include "client/terminal/InputDecoder.h"

namespace naiad {

/// Returns the key that types `ch` on a US keyboard, with kShift if needed ('A': key A, shift). For a
/// Cyrillic or Greek letter: the key that types it in the standard layouts (Russian, Ukrainian, Belarusian,
/// Greek), by position.
KeyEvent keyOfCharacter(char32_t ch);

/// Returns the key of a byte below 0x20 or 0x7F: Return, Tab, Backspace, Escape, or Control with a key.
KeyEvent keyOfControl(unsigned char byte);

/// Returns the key of `CSI … letter`, `SS3 letter`: cursor, Home, End, F1-F4; shift-Tab (CSI), keypad (SS3).
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
