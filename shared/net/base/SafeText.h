// Text from the network or the keyboard, made fit for a terminal.
#pragma once

#include <cstddef>
#include <string>

namespace naiad {

/// `text` (UTF-8, perhaps malformed) cut to `max_characters`, each of them drawable in one cell: anything
/// else (control, escape, bidi, zero-width, wide) becomes '?'. Line breaks and tabs become blanks.
std::string safeText(const std::string& text, std::size_t max_characters);

/// A player's name: as above with the limit of names, without blanks at the ends; "player" if nothing is
/// left.
std::string safeName(const std::string& name);

/// Columns that a safe text occupies.
std::size_t columnsOf(const std::string& text);

}  // namespace naiad
