#include "shared/net/base/JsonText.h"

#include <cstdio>

#include "shared/values/Canvas.h"

namespace naiad {
namespace {

void appendUnit(std::string& out, unsigned unit) {
  char escaped[8];
  std::snprintf(escaped, sizeof escaped, "\\u%04x", unit & 0xffff);
  out += escaped;
}

}  // namespace

std::string jsonQuoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char32_t ch : df::decodeUtf8(text)) {
    if (ch == U'"' || ch == U'\\') {
      quoted += {'\\', static_cast<char>(ch)};
    } else if (ch >= U' ' && ch < 0x7f) {
      quoted.push_back(static_cast<char>(ch));
    } else if (ch > 0xffff) {  // as a pair of surrogates
      appendUnit(quoted, 0xd800 + ((static_cast<unsigned>(ch) - 0x10000) >> 10));
      appendUnit(quoted, 0xdc00 + ((static_cast<unsigned>(ch) - 0x10000) & 0x3ff));
    } else {
      appendUnit(quoted, static_cast<unsigned>(ch));
    }
  }
  return quoted + "\"";
}

}  // namespace naiad
