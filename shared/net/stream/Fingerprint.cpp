#include "shared/net/stream/Fingerprint.h"

namespace naiad {
namespace {

int digitOf(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

std::optional<Fingerprint> Fingerprint::parse(std::string_view text) {
  Fingerprint result;
  if (text.size() != 2 * result.bytes_.size()) return std::nullopt;
  for (std::size_t i = 0; i < result.bytes_.size(); ++i) {
    const int high = digitOf(text[2 * i]);
    const int low = digitOf(text[2 * i + 1]);
    if (high < 0 || low < 0) return std::nullopt;
    result.bytes_[i] = static_cast<std::uint8_t>(high * 16 + low);
  }
  return result;
}

std::string Fingerprint::text() const {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : bytes_) {
    text.push_back(kDigits[byte >> 4]);
    text.push_back(kDigits[byte & 15]);
  }
  return text;
}

}  // namespace naiad
