#include "shared/net/base/SafeText.h"

#include "shared/net/base/Limits.h"
#include "shared/values/Canvas.h"

namespace naiad {

std::string safeText(const std::string& text, std::size_t max_characters) {
  // No character takes more than four bytes, so what lies beyond cannot matter; do not decode it.
  const std::u32string decoded = df::decodeUtf8(text.substr(0, max_characters * 4));
  std::string safe;
  std::size_t count = 0;
  for (const char32_t ch : decoded) {
    if (count++ == max_characters) break;
    if (ch == U'\n' || ch == U'\r' || ch == U'\t') {
      safe.push_back(' ');
    } else {
      df::appendUtf8(safe, df::isDrawable(ch) ? ch : U'?');
    }
  }
  return safe;
}

std::string safeName(const std::string& name) {
  std::string safe = safeText(name, kMaxNameLength);
  safe.erase(0, safe.find_first_not_of(' '));
  safe.erase(safe.find_last_not_of(' ') + 1);
  return safe.empty() ? "player" : safe;
}

std::size_t columnsOf(const std::string& text) {
  return df::decodeUtf8(text).size();
}

}  // namespace naiad
