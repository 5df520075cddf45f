// Texts as JSON has them (RFC 8259 7).
#pragma once

#include <string>

namespace naiad {

/// A safe text (SafeText.h) in double quotes. Everything but printable ASCII is escaped, so that it means the
/// same in any encoding, in any terminal.
std::string jsonQuoted(const std::string& text);

}  // namespace naiad
