// The messages of the local network: a packet is a valid message or is rejected, its texts are safe to draw,
// and an answer is never longer than a query.
//
//   input   a packet
#include "Target.h"
#include "shared/net/base/SafeText.h"
#include "shared/net/lan/LanMessage.h"

namespace naiad::fuzz {
namespace {

void requireSafeText(const std::string& text) {
  REQUIRE(columnsOf(text) <= kMaxLanText && text.size() <= kMaxLanTextBytes);
  REQUIRE(safeText(text, kMaxLanText) == text);
}

void checkAnswer(const LanAnswer& answer) {
  REQUIRE(answer.port != 0 && answer.protocol <= 0xffff);
  requireSafeText(answer.name);
  requireSafeText(answer.game);
  const std::string written = writeLanAnswer(answer);
  REQUIRE(written.size() <= kLanQuerySize);
  REQUIRE(readLanAnswer(written) == answer);
}

}  // namespace

void tryInput(Script script) {
  const Exactly packet(script.rest());
  const auto nonce = readLanQuery(packet.view());
  const auto answer = readLanAnswer(packet.view());
  REQUIRE(!nonce || !answer);
  if (nonce) REQUIRE(writeLanQuery(*nonce) == packet.view());
  if (answer) checkAnswer(*answer);
}

}  // namespace naiad::fuzz
