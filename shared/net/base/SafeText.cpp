#include "shared/net/base/SafeText.h"

#include <algorithm>

#include "shared/net/base/Limits.h"
#include "shared/values/Canvas.h"

namespace naiad {
namespace {

bool isLetterOrDigit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

}  // namespace

bool isRoomName(std::string_view name) {
  return !name.empty() && name.size() <= kMaxRoomName && isLetterOrDigit(name.front()) && isPlainName(name);
}

bool isPlainName(std::string_view text) {
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return isLetterOrDigit(c) || c == '-' || c == '_' || c == '.'; });
}

std::string safeText(const std::string& text, std::size_t max_characters) {
  // A character has at most four bytes, so bytes beyond four per character cannot matter and are not decoded.
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
  std::string safe;
  for (const char32_t ch : df::decodeUtf8(name.substr(0, 4 * kMaxNameBytes)))
    if (df::isDrawable(ch) && (ch != U' ' || !safe.empty())) df::appendUtf8(safe, ch);
  safe = safeText(safe, kMaxNameLength);
  safe.erase(safe.find_last_not_of(' ') + 1);
  return safe.empty() ? "player" : safe;
}

std::string lowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

std::string hexText(std::string_view bytes) {
  std::string text;
  for (const char byte : bytes) {
    text += "0123456789abcdef"[static_cast<unsigned char>(byte) >> 4];
    text += "0123456789abcdef"[byte & 15];
  }
  return text;
}

std::optional<std::string> bytesOfHex(std::string_view digits) {
  if (digits.size() % 2 != 0) return std::nullopt;
  std::string bytes;
  for (; !digits.empty(); digits.remove_prefix(2)) {
    unsigned byte = 0;
    const auto [p_read, error] = std::from_chars(digits.data(), digits.data() + 2, byte, 16);
    if (error != std::errc() || p_read != digits.data() + 2) return std::nullopt;
    bytes += static_cast<char>(byte);
  }
  return bytes;
}

std::size_t columnsOf(const std::string& text) {
  return df::decodeUtf8(text).size();
}

}  // namespace naiad
