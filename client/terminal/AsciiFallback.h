// The glyph set for terminals that show only ASCII.
#pragma once

namespace naiad {

/// Returns the ASCII character that looks most like `ch`; '?' if none does.
char asciiFor(char32_t ch);

}  // namespace naiad
