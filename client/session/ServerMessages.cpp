#include "client/session/ServerMessages.h"

#include <algorithm>

#include "naiad.pb.h"
#include "proto/ParseErrors.h"
#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"
#include "shared/net/datagram/DatagramKeys.h"
#include "shared/replica/Limits.h"

namespace naiad {
namespace {

constexpr std::uint32_t kMaxRttMillis = 99999;
constexpr std::size_t kMaxTokenLength = 64;
constexpr std::uint32_t kMaxGraceMillis = 3'600'000;
constexpr std::uint32_t kMaxReconnectSeconds = 600;
constexpr std::size_t kMaxRedirect = 512;  // maximum bytes of a redirect's link

bool isViewSize(std::uint32_t width, std::uint32_t height) {
  return width >= 1 && width <= static_cast<unsigned>(kMaxViewWidth) && height >= 1 &&
         height <= static_cast<unsigned>(kMaxViewHeight);
}

bool isColor(std::uint32_t color) {
  return color < static_cast<std::uint32_t>(df::kColorCount);
}

/// Returns the player's world from a Welcome or RoomEntered message; nullopt if a number is out of range.
template <class Message>
std::optional<PlayerWorld> checkWorld(const Message& wire) {
  const bool good = wire.player() != 0 && isViewSize(wire.view_width(), wire.view_height()) &&
                    wire.help_size() <= static_cast<int>(kMaxHelpLines);
  if (!good) return std::nullopt;
  PlayerWorld world{.player = wire.player(),
                    .room = safeText(wire.room(), kMaxRoomName),
                    .game = safeText(wire.game(), kMaxProgramLength),
                    .view_width = static_cast<int>(wire.view_width()),
                    .view_height = static_cast<int>(wire.view_height())};
  for (const std::string& line : wire.help()) world.help.push_back(safeText(line, kMaxHelpLength));
  return world;
}

std::optional<ServerMessageValue> check(const wire::Welcome& wire) {
  const auto world = checkWorld(wire);
  if (!world || wire.tick_micros() < 1000 || wire.tick_micros() > 1000000 || !isColor(wire.color()))
    return std::nullopt;
  WelcomeMessage message;
  static_cast<PlayerWorld&>(message) = *world;
  message.name = safeName(wire.name());
  message.server = safeText(wire.server(), kMaxProgramLength);
  message.tick_now = wire.tick();
  message.connection_id = wire.connection_id();
  message.aead = aeadFromWire(wire.aead()) ? wire.aead() : 0;
  message.epoch = wire.epoch();
  if (wire.resume_token().size() > kMaxTokenLength) return std::nullopt;
  message.resume_token = wire.resume_token();
  message.resumed = wire.resumed();
  message.grace = std::chrono::milliseconds(std::min(wire.grace_millis(), kMaxGraceMillis));
  message.last_frame = wire.last_frame();
  message.second_stream = wire.second_stream();
  if (wire.has_resume_state()) {
    const wire::ResumeState& from = wire.resume_state();
    if (from.world_epoch() > 3) return std::nullopt;
    message.resume_state = {from.snapshot(), static_cast<std::uint8_t>(from.world_epoch()), from.input()};
  }
  message.tick = std::chrono::microseconds(wire.tick_micros());
  message.color = static_cast<df::Color>(wire.color());
  return message;
}

std::optional<ServerMessageValue> check(const wire::Refused& wire) {
  RefusedMessage message{wire.reason() == wire::Refused::BUSY, wire.reason() == wire::Refused::PASSWORD,
                         safeText(wire.message(), kMaxMessageLength)};
  const bool may_redirect = wire.reason() == wire::Refused::FULL || wire.reason() == wire::Refused::REDIRECT;
  if (may_redirect && wire.redirect().size() <= kMaxRedirect) message.redirect = wire.redirect();
  if (isRoomName(wire.redirect_room())) message.redirect_room = wire.redirect_room();
  message.full = wire.reason() == wire::Refused::FULL;
  return message;
}

std::optional<ServerMessageValue> check(const wire::RoomEntered& wire) {
  const auto world = checkWorld(wire);
  if (!world || wire.world_epoch() > 3 || !isRoomName(wire.room())) return std::nullopt;
  return RoomEnteredMessage{*world, wire.tick(), static_cast<std::uint8_t>(wire.world_epoch())};
}

std::optional<ServerMessageValue> check(const wire::RoomList& wire) {
  if (wire.rooms_size() > static_cast<int>(kMaxRooms)) return std::nullopt;
  RoomsMessage message;
  for (const wire::RoomEntry& entry : wire.rooms()) {
    if (!isRoomName(entry.name())) return std::nullopt;
    message.rooms.push_back({entry.name(), safeText(entry.game(), kMaxProgramLength), entry.players(),
                             entry.max_players(), entry.asleep()});
  }
  return message;
}

std::optional<ServerMessageValue> check(const wire::PlayerList& wire, std::uint32_t number) {
  if (wire.players_size() > static_cast<int>(kMaxPlayers)) return std::nullopt;
  PlayersMessage message;
  message.number = number;
  for (const wire::PlayerEntry& entry : wire.players()) {
    if (entry.player() == 0 || !isColor(entry.color())) return std::nullopt;
    message.players.push_back({entry.player(), safeName(entry.name()), static_cast<df::Color>(entry.color()),
                               entry.score(), std::min(entry.rtt_millis(), kMaxRttMillis)});
  }
  return message;
}

std::optional<ServerMessageValue> check(const wire::Sounds& wire, std::uint32_t number) {
  if (wire.sounds_size() > static_cast<int>(kMaxSounds)) return std::nullopt;
  SoundsMessage message;
  message.number = number;
  for (const wire::Sound& sound : wire.sounds()) {
    if (!wire::Sound::Action_IsValid(sound.action())) return std::nullopt;
    message.sounds.push_back({safeText(sound.label(), kMaxSoundLabel),
                              static_cast<SoundLine::Action>(sound.action()), sound.music(), sound.loop(),
                              sound.player()});
  }
  return message;
}

}  // namespace

std::optional<ServerMessageValue> readServerMessage(std::string_view frame) {
  silenceParseErrors();  // error messages would let a server write on the player's screen
  if (frame.size() > kMaxServerFrame) return std::nullopt;
  wire::ServerMessage wire;
  if (!wire.ParseFromArray(frame.data(), static_cast<int>(frame.size()))) return std::nullopt;
  switch (wire.payload_case()) {
    case wire::ServerMessage::kWelcome:
      return check(wire.welcome());
    case wire::ServerMessage::kSnapshot:
      return SnapshotMessage{std::move(*wire.mutable_snapshot())};
    case wire::ServerMessage::kPlayers:
      return check(wire.players(), wire.number());
    case wire::ServerMessage::kRefused:
      return check(wire.refused());
    case wire::ServerMessage::kGoodbye:
      return GoodbyeMessage{
          safeText(wire.goodbye().message(), kMaxMessageLength),
          std::chrono::seconds(std::min(wire.goodbye().reconnect_seconds(), kMaxReconnectSeconds))};
    case wire::ServerMessage::kChat:
      return ChatMessage{wire.chat().player(), safeText(wire.chat().text(), kMaxChatLength), wire.number()};
    case wire::ServerMessage::kSounds:
      return check(wire.sounds(), wire.number());
    case wire::ServerMessage::kPong:
      return PongMessage{wire.pong().token(), wire.pong().last_frame()};
    case wire::ServerMessage::kEntered:
      return check(wire.entered());
    case wire::ServerMessage::kRooms:
      return check(wire.rooms());
    case wire::ServerMessage::PAYLOAD_NOT_SET:
      return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace naiad
