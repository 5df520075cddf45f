// The glyph set for terminals that show ASCII alone.
#pragma once

namespace naiad {

/// The ASCII character that looks most like `ch`; '?' if none does.
char asciiFor(char32_t ch);

}  // namespace naiad
