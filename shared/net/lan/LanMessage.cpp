#include "shared/net/lan/LanMessage.h"

#include <algorithm>
#include <cassert>

#include "shared/net/base/SafeText.h"
#include "shared/values/LittleEndian.h"

namespace naiad {
namespace {

constexpr std::string_view kMagic = "nlan";
constexpr char kFormat = 1;
constexpr char kQuery = 1;
constexpr char kAnswer = 2;
constexpr char kPasswordFlag = 1;
constexpr std::size_t kHead = 24;   // bytes of both messages up to the end of the nonce
constexpr std::size_t kTexts = 48;  // offset of the texts in an answer
constexpr std::size_t kLonger = 1;  // bytes of the field with a text's length

static_assert(kTexts + 2 * (kLonger + kMaxLanTextBytes) <= kLanQuerySize,
              "an answer must not be longer than a query");

/// Appends 16 bits; larger numbers become 0xffff.
void appendNumber(std::string& out, std::uint32_t number) {
  char bytes[2];
  storeLittleEndian(static_cast<std::uint16_t>(std::min(number, 0xffffU)), bytes);
  out.append(bytes, sizeof bytes);
}

template <std::size_t kSize>
void appendBytes(std::string& out, const std::array<std::uint8_t, kSize>& bytes) {
  out.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

void appendText(std::string& out, const std::string& text) {
  const std::string safe = safeText(text, kMaxLanText);
  out.push_back(static_cast<char>(safe.size()));
  out += safe;
}

bool isMessage(std::string_view bytes, char kind) {
  return bytes.size() >= kHead && bytes.starts_with(kMagic) && bytes[4] == kFormat && bytes[5] == kind;
}

template <std::size_t kSize>
std::array<std::uint8_t, kSize> bytesAt(std::string_view bytes, std::size_t at) {
  std::array<std::uint8_t, kSize> result;
  std::transform(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                 bytes.begin() + static_cast<std::ptrdiff_t>(at + kSize), result.begin(),
                 [](char byte) { return static_cast<std::uint8_t>(byte); });
  return result;
}

/// Removes a text from the front of `rest` and sanitizes it. Returns nullopt if it is too long or truncated.
std::optional<std::string> takeText(std::string_view& rest) {
  if (rest.empty()) return std::nullopt;
  const std::size_t size = static_cast<unsigned char>(rest.front());
  rest.remove_prefix(kLonger);
  if (size > kMaxLanTextBytes || size > rest.size()) return std::nullopt;
  const std::string text(rest.substr(0, size));
  rest.remove_prefix(size);
  return safeText(text, kMaxLanText);
}

}  // namespace

std::string writeLanQuery(const LanNonce& nonce) {
  std::string bytes(kMagic);
  bytes += {kFormat, kQuery, 0, 0};
  appendBytes(bytes, nonce);
  bytes.resize(kLanQuerySize, '\0');
  return bytes;
}

std::optional<LanNonce> readLanQuery(std::string_view bytes) {
  if (bytes.size() != kLanQuerySize || !isMessage(bytes, kQuery)) return std::nullopt;
  const auto is_zero = [](char byte) { return byte == '\0'; };
  if (!is_zero(bytes[6]) || !is_zero(bytes[7])) return std::nullopt;
  const std::string_view padding = bytes.substr(kHead);
  if (!std::all_of(padding.begin(), padding.end(), is_zero)) return std::nullopt;
  return bytesAt<16>(bytes, 8);
}

std::string writeLanAnswer(const LanAnswer& answer) {
  assert(answer.port != 0);
  std::string bytes(kMagic);
  bytes += {kFormat, kAnswer};
  appendNumber(bytes, answer.protocol);
  appendBytes(bytes, answer.nonce);
  appendNumber(bytes, answer.port);
  bytes += {answer.requires_password ? kPasswordFlag : '\0', '\0'};
  appendNumber(bytes, answer.players);
  appendNumber(bytes, answer.max_players);
  appendBytes(bytes, answer.key.bytes());
  appendText(bytes, answer.name);
  appendText(bytes, answer.game);
  return bytes;
}

std::optional<LanAnswer> readLanAnswer(std::string_view bytes) {
  if (bytes.size() < kTexts || bytes.size() > kLanQuerySize || !isMessage(bytes, kAnswer))
    return std::nullopt;
  LanAnswer answer;
  answer.protocol = loadLittleEndian<std::uint16_t>(&bytes[6]);
  answer.nonce = bytesAt<16>(bytes, 8);
  answer.port = loadLittleEndian<std::uint16_t>(&bytes[24]);
  const bool known_flags = (bytes[26] & ~kPasswordFlag) == 0 && bytes[27] == 0;
  if (answer.port == 0 || !known_flags) return std::nullopt;
  answer.requires_password = bytes[26] == kPasswordFlag;
  answer.players = loadLittleEndian<std::uint16_t>(&bytes[28]);
  answer.max_players = loadLittleEndian<std::uint16_t>(&bytes[30]);
  answer.key = ShortKey::ofBytes(bytesAt<16>(bytes, 32));
  std::string_view rest = bytes.substr(kTexts);
  auto name = takeText(rest);
  auto game = name ? takeText(rest) : std::nullopt;
  if (!game || !rest.empty()) return std::nullopt;
  answer.name = *std::move(name);
  answer.game = *std::move(game);
  return answer;
}

}  // namespace naiad
