#include "shared/net/stream/Fingerprint.h"

#include <algorithm>

#include "shared/net/base/SafeText.h"

namespace naiad {
namespace {

constexpr std::string_view kDigits = "abcdefghijklmnopqrstuvwxyz234567";
constexpr std::size_t kBitsPerDigit = 5;
constexpr std::size_t kLength = 26;  // digits for 128 bits and two unused ones

int base32DigitOf(char c) {
  if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  const std::size_t digit = kDigits.find(c);
  return digit == std::string_view::npos ? -1 : static_cast<int>(digit);
}

}  // namespace

ShortKey ShortKey::of(const Fingerprint& key) {
  ShortKey result;
  std::copy_n(key.bytes().begin(), result.bytes_.size(), result.bytes_.begin());
  return result;
}

std::optional<ShortKey> ShortKey::parse(std::string_view text) {
  if (text.size() != kLength) return std::nullopt;
  ShortKey result;
  std::size_t filled = 0;
  unsigned bits = 0;
  std::size_t count = 0;
  for (const char c : text) {
    const int digit = base32DigitOf(c);
    if (digit < 0) return std::nullopt;
    bits = bits << kBitsPerDigit | static_cast<unsigned>(digit);
    count += kBitsPerDigit;
    if (count < 8) continue;
    count -= 8;
    result.bytes_[filled++] = static_cast<std::uint8_t>(bits >> count);
    bits &= (1u << count) - 1;
  }
  if (bits != 0) return std::nullopt;
  return result;
}

std::string ShortKey::text() const {
  std::string text;
  unsigned bits = 0;
  std::size_t count = 0;
  for (const std::uint8_t byte : bytes_) {
    bits = bits << 8 | byte;
    for (count += 8; count >= kBitsPerDigit;) {
      count -= kBitsPerDigit;
      text.push_back(kDigits[bits >> count & 31]);
    }
    bits &= (1u << count) - 1;
  }
  text.push_back(kDigits[bits << (kBitsPerDigit - count) & 31]);
  return text;
}

std::optional<Fingerprint> Fingerprint::parse(std::string_view text) {
  Fingerprint result;
  const auto bytes = text.size() == 2 * result.bytes_.size() ? bytesOfHex(text) : std::nullopt;
  if (!bytes) return std::nullopt;
  std::copy(bytes->begin(), bytes->end(), result.bytes_.begin());
  return result;
}

std::string Fingerprint::text() const {
  return hexText(bytes_);
}

}  // namespace naiad
