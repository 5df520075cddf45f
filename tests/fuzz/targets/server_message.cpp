// Messages of a server: for all bytes, the accepted values are in range and safe for a terminal.
//
//   input   a frame's payload
#include "Target.h"
#include "client/session/ServerMessages.h"
#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"
#include "shared/replica/Limits.h"
#include "shared/values/Canvas.h"

namespace naiad::fuzz {
namespace {

void requireText(const std::string& text, std::size_t most) {
  std::size_t count = 0;
  for (const char32_t ch : df::decodeUtf8(text)) {
    REQUIRE(df::isDrawable(ch));
    ++count;
  }
  REQUIRE(count <= most);
}

void requireColor(df::Color color) {
  REQUIRE(static_cast<unsigned>(color) < static_cast<unsigned>(df::kColorCount));
}

void requireGood(const WelcomeMessage& message) {
  using namespace std::chrono_literals;
  REQUIRE(message.player != 0);
  REQUIRE(message.tick >= 1ms && message.tick <= 1s);
  REQUIRE(message.view_width >= 1 && message.view_width <= kMaxViewWidth);
  REQUIRE(message.view_height >= 1 && message.view_height <= kMaxViewHeight);
  requireColor(message.color);
  requireText(message.name, kMaxNameLength);
  requireText(message.game, kMaxProgramLength);
  requireText(message.server, kMaxProgramLength);
  REQUIRE(message.help.size() <= kMaxHelpLines);
  for (const std::string& line : message.help) requireText(line, kMaxHelpLength);
}
void requireGood(const RefusedMessage& message) {
  requireText(message.message, kMaxMessageLength);
}
void requireGood(const GoodbyeMessage& message) {
  requireText(message.message, kMaxMessageLength);
}
void requireGood(const PlayersMessage& message) {
  REQUIRE(message.players.size() <= kMaxPlayers);
  for (const PlayerLine& line : message.players) {
    REQUIRE(line.player != 0 && line.rtt_millis < 100000);
    requireColor(line.color);
    requireText(line.name, kMaxNameLength);
  }
}
void requireGood(const ChatMessage& message) {
  requireText(message.text, kMaxChatLength);
}
void requireGood(const SoundsMessage& message) {
  REQUIRE(message.sounds.size() <= kMaxSounds);
  for (const SoundLine& sound : message.sounds) {
    REQUIRE(sound.action <= SoundLine::Action::kStop);
    requireText(sound.label, kMaxSoundLabel);
  }
}
template <class Other>
void requireGood(const Other&) {}  // other messages have no values to check, or other code reads them

}  // namespace

void tryInput(Script script) {
  const Exactly frame(script.rest());
  const auto message = readServerMessage(frame.view());
  if (message) std::visit([](const auto& value) { requireGood(value); }, *message);
}

}  // namespace naiad::fuzz
