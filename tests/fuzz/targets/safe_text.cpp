// Network text cleaned for a terminal: for every input, the output is drawable, within the length limit, and
// unchanged when cleaned again.
//
//   input   maximum number of characters 1 | the text
#include "Target.h"
#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"
#include "shared/values/Canvas.h"

namespace naiad::fuzz {
namespace {

void requireSafe(const std::string& text, std::size_t most) {
  const std::u32string decoded = df::decodeUtf8(text);
  REQUIRE(decoded.size() == columnsOf(text));
  REQUIRE(decoded.size() <= most);
  std::string again;
  for (const char32_t ch : decoded) {
    REQUIRE(df::isDrawable(ch));
    df::appendUtf8(again, ch);
  }
  REQUIRE(again == text);
}

}  // namespace

void tryInput(Script script) {
  const std::size_t most = script.byte();
  const std::string text = script.rest();

  const std::string safe = safeText(text, most);
  requireSafe(safe, most);
  REQUIRE(safeText(safe, most) == safe);

  const std::string name = safeName(text);
  requireSafe(name, kMaxNameLength);
  REQUIRE(!name.empty() && name.front() != ' ' && name.back() != ' ');
  REQUIRE(safeName(name) == name);

  std::string all;
  for (const char32_t ch : df::decodeUtf8(text)) df::appendUtf8(all, ch);
  REQUIRE(df::decodeUtf8(all) == df::decodeUtf8(text));

  if (isRoomName(text)) REQUIRE(isPlainName(text) && !text.empty() && text.size() <= kMaxRoomName);
  if (isPlainName(text)) REQUIRE(safeText(text, text.size()) == text);
  REQUIRE(lowerCase(lowerCase(text)) == lowerCase(text));
  REQUIRE(bytesOfHex(hexText(text)) == text);
  if (const auto bytes = bytesOfHex(text)) REQUIRE(hexText(*bytes) == lowerCase(text));
}

}  // namespace naiad::fuzz
