// A check for UTF-8.
#pragma once

#include <string_view>

namespace naiad::small {

/// True if `text` is well-formed UTF-8 (RFC 3629): no overlong form, no surrogate, nothing above U+10FFFF.
bool isUtf8(std::string_view text);

}  // namespace naiad::small
