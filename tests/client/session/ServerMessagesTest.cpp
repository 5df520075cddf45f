// Whatever a server sends, accepted values are in range, and accepted texts are safe for a terminal.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "client/session/ServerMessages.h"
#include "naiad.pb.h"
#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"
#include "shared/replica/Limits.h"
#include "shared/values/Canvas.h"
#include "shared/values/SplitMix64.h"
#include "tests/support/HostileTexts.h"
#include "tests/support/ServerMessageSamples.h"

namespace naiad {
namespace {

void expectSafe(const std::string& text, std::size_t most) {
  const std::u32string characters = df::decodeUtf8(text);
  EXPECT_LE(characters.size(), most);
  EXPECT_TRUE(std::all_of(characters.begin(), characters.end(), df::isDrawable)) << text;
}

void expectGoodWorld(const PlayerWorld& world) {
  EXPECT_NE(world.player, 0u);
  expectSafe(world.game, kMaxProgramLength);
  EXPECT_TRUE(world.view_width >= 1 && world.view_width <= kMaxViewWidth);
  EXPECT_TRUE(world.view_height >= 1 && world.view_height <= kMaxViewHeight);
  EXPECT_LE(world.help.size(), kMaxHelpLines);
  for (const std::string& line : world.help) expectSafe(line, kMaxHelpLength);
}

/// Expects values in range, and texts that are safe for a terminal.
struct ExpectGood {
  void operator()(const WelcomeMessage& welcome) const {
    expectGoodWorld(welcome);
    expectSafe(welcome.name, kMaxNameLength);
    expectSafe(welcome.server, kMaxProgramLength);
    EXPECT_GE(welcome.tick, std::chrono::milliseconds(1));
    EXPECT_LE(welcome.tick, std::chrono::seconds(1));
    EXPECT_LT(static_cast<unsigned>(welcome.color), 8u);
    EXPECT_LE(welcome.aead, 2u);
    EXPECT_LE(welcome.resume_token.size(), 64u);
  }
  void operator()(const PlayersMessage& message) const {
    EXPECT_LE(message.players.size(), kMaxPlayers);
    for (const PlayerLine& line : message.players) {
      EXPECT_NE(line.player, 0u);
      expectSafe(line.name, kMaxNameLength);
      EXPECT_LT(static_cast<unsigned>(line.color), 8u);
      EXPECT_LE(line.rtt_millis, 99'999u);
    }
  }
  void operator()(const ChatMessage& chat) const { expectSafe(chat.text, kMaxChatLength); }
  void operator()(const RefusedMessage& refused) const { expectSafe(refused.message, kMaxMessageLength); }
  void operator()(const GoodbyeMessage& goodbye) const { expectSafe(goodbye.message, kMaxMessageLength); }
  void operator()(const SoundsMessage& message) const {
    EXPECT_LE(message.sounds.size(), kMaxSounds);
    for (const SoundLine& sound : message.sounds) {
      expectSafe(sound.label, kMaxSoundLabel);
      EXPECT_LE(sound.action, SoundLine::Action::kStop);
    }
  }
  void operator()(const RoomEnteredMessage& entered) const {
    expectGoodWorld(entered);
    EXPECT_TRUE(isRoomName(entered.room));
    EXPECT_LE(entered.world_epoch, 3);
  }
  void operator()(const RoomsMessage& message) const {
    EXPECT_LE(message.rooms.size(), kMaxRooms);
    for (const RoomLine& room : message.rooms) {
      EXPECT_TRUE(isRoomName(room.name));
      expectSafe(room.game, kMaxProgramLength);
    }
  }
  void operator()(const PongMessage&) const {}
  void operator()(const SnapshotMessage& snapshot) const {
    EXPECT_LE(snapshot.bytes.size(), kMaxServerFrame);
  }
};

TEST(ServerMessages, InvalidRoomMessagesAreRejected) {
  const auto reads = [](const std::function<void(wire::RoomEntered&)>& change) {
    wire::ServerMessage message = test::serverMessages("Ann")[8];
    change(*message.mutable_entered());
    return readServerMessage(message.SerializeAsString()).has_value();
  };
  EXPECT_TRUE(reads([](wire::RoomEntered&) {}));
  EXPECT_FALSE(reads([](wire::RoomEntered& entered) { entered.set_player(0); }));
  EXPECT_FALSE(reads([](wire::RoomEntered& entered) { entered.set_room("a b"); }));
  EXPECT_FALSE(reads([](wire::RoomEntered& entered) { entered.set_room(""); }));
  EXPECT_FALSE(reads([](wire::RoomEntered& entered) { entered.set_world_epoch(4); }));
  EXPECT_FALSE(reads([](wire::RoomEntered& entered) { entered.set_view_width(0); }));
  EXPECT_FALSE(reads([](wire::RoomEntered& entered) { entered.set_view_height(kMaxViewHeight + 1); }));
  wire::ServerMessage rooms = test::serverMessages("Ann")[9];
  *rooms.mutable_rooms()->add_rooms() = rooms.rooms().rooms(0);
  EXPECT_FALSE(readServerMessage(rooms.SerializeAsString()));
}

TEST(ServerMessages, ValidMessagesAreRead) {
  for (const wire::ServerMessage& message : test::serverMessages("Ann")) {
    const auto value = readServerMessage(message.SerializeAsString());
    ASSERT_TRUE(value) << message.payload_case();
    if (const auto* p_sounds = std::get_if<SoundsMessage>(&*value)) {
      EXPECT_EQ(p_sounds->sounds.at(2), (SoundLine{"Ann", SoundLine::Action::kStop, true, true, 3}));
    }
  }
}

TEST(ServerMessages, MutatedMessagesAreRefusedOrValid) {
  SplitMix64 random(3);
  std::size_t taken = 0;
  for (int i = 0; i < 40'000; ++i) {
    const auto messages = test::serverMessages(test::hostileText(random));
    std::string bytes = messages[random.below(messages.size())].SerializeAsString();
    for (std::uint64_t k = 0; k < 1 + random.below(3); ++k) {
      const std::size_t at = random.below(bytes.size());
      switch (random.below(4)) {
        case 0:
          bytes[at] = static_cast<char>(random.next());
          break;
        case 1:
          bytes[at] ^= static_cast<char>(1 << random.below(8));
          break;
        case 2:
          bytes.insert(at, 1, static_cast<char>(random.next()));
          break;
        default:
          bytes.erase(at, 1);
      }
      if (bytes.empty()) bytes.push_back('\0');
    }
    const auto value = readServerMessage(bytes);
    if (!value) continue;
    ++taken;
    std::visit(ExpectGood(), *value);
    ASSERT_FALSE(HasFailure()) << "message " << i;
  }
  EXPECT_GT(taken, 1'000u) << "mutations that leave a message";
}

/// The first and last number of each range are read unchanged. Their outer neighbours are rejected or, for
/// some fields, replaced by a harmless value.
TEST(ServerMessages, NumbersOutOfRangeAreRejectedOrClamped) {
  constexpr std::uint32_t kLast = 0xFFFFFFFF;
  const auto width = static_cast<std::uint32_t>(kMaxViewWidth);
  const auto height = static_cast<std::uint32_t>(kMaxViewHeight);
  using Numbers = std::vector<std::uint32_t>;
  struct Field {
    const char* name;
    std::size_t message;
    std::function<void(wire::ServerMessage&, std::uint32_t)> set;
    std::function<std::uint32_t(const ServerMessageValue&)> get;
    Numbers good;
    Numbers bad;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> changed;  ///< pairs of sent and read number
  };
  std::vector<Field> fields;
  /// Adds a field of the welcome. `more` are pairs of sent and read number.
  const auto welcome = [&](const char* name, auto set, auto get, Numbers good, Numbers bad, auto... more) {
    fields.push_back(
        {name,
         0,
         [set](auto& m, auto n) { (m.mutable_welcome()->*set)(n); },
         [get](auto& v) { return static_cast<std::uint32_t>(std::invoke(get, std::get<WelcomeMessage>(v))); },
         std::move(good),
         std::move(bad),
         {more...}});
  };
  /// Adds a field of the fifth player in a list.
  const auto player = [&](const char* name, auto set, auto get, Numbers good, Numbers bad, auto... more) {
    fields.push_back({name,
                      2,
                      [set](auto& m, auto n) { (m.mutable_players()->mutable_players(4)->*set)(n); },
                      [get](auto& v) {
                        return static_cast<std::uint32_t>(
                            std::invoke(get, std::get<PlayersMessage>(v).players.at(4)));
                      },
                      std::move(good),
                      std::move(bad),
                      {more...}});
  };
  using W = wire::Welcome;
  using P = wire::PlayerEntry;
  const Numbers not_width{0, width + 1, 0x7FFFFFFF, 0x80000001, kLast};
  const Numbers not_height{0, height + 1, 0x7FFFFFFF, 0x80000001, kLast};
  const std::pair colours{Numbers{0, 7}, Numbers{8, 0x7FFFFFFF, kLast}};
  welcome("player", &W::set_player, &WelcomeMessage::player, {1, 2, kLast}, {0});
  welcome("tick", &W::set_tick_micros, [](auto& w) { return w.tick.count(); }, {1'000, 33'333, 1'000'000},
          {0, 1, 999, 1'000'001, 0x7FFFFFFF, kLast});
  welcome("width", &W::set_view_width, &WelcomeMessage::view_width, {1, width}, not_width);
  welcome("height", &W::set_view_height, &WelcomeMessage::view_height, {1, height}, not_height);
  welcome("colour", &W::set_color, &WelcomeMessage::color, colours.first, colours.second);
  welcome("cipher", &W::set_aead, &WelcomeMessage::aead, {0, 1, 2}, {}, std::pair{3u, 0u},
          std::pair{kLast, 0u});
  welcome(
      "grace", &W::set_grace_millis, [](auto& w) { return w.grace.count(); }, {0, 60'000, 3'600'000}, {},
      std::pair{3'600'001u, 3'600'000u}, std::pair{kLast, 3'600'000u});
  player("entry's player", &P::set_player, &PlayerLine::player, {1, kLast}, {0});
  player("entry's colour", &P::set_color, &PlayerLine::color, colours.first, colours.second);
  player("entry's round trip", &P::set_rtt_millis, &PlayerLine::rtt_millis, {0, 99'999}, {},
         std::pair{100'000u, 99'999u}, std::pair{kLast, 99'999u});
  fields.push_back({"epoch",
                    0,
                    [](auto& m, auto n) { m.mutable_welcome()->mutable_resume_state()->set_world_epoch(n); },
                    [](auto& v) { return std::get<WelcomeMessage>(v).resume_state.value().world_epoch; },
                    {0, 3},
                    {4, 256, kLast},
                    {}});
  fields.push_back(
      {"action",
       7,
       [](auto& m, auto n) {
         m.mutable_sounds()->mutable_sounds(1)->set_action(static_cast<wire::Sound::Action>(n));
       },
       [](auto& v) { return static_cast<std::uint32_t>(std::get<SoundsMessage>(v).sounds.at(1).action); },
       {0, 1, 2},
       {3, 0x7FFFFFFF, kLast},
       {}});
  const auto messages = test::serverMessages("Ann");
  for (const Field& field : fields) {
    const auto read = [&](std::uint32_t number) {
      SCOPED_TRACE(std::string(field.name) + " " + std::to_string(number));
      wire::ServerMessage message = messages[field.message];
      field.set(message, number);
      const auto value = readServerMessage(message.SerializeAsString());
      if (value) std::visit(ExpectGood(), *value);
      return value ? std::optional(field.get(*value)) : std::nullopt;
    };
    for (const std::uint32_t number : field.good) EXPECT_EQ(read(number), number) << field.name;
    for (const std::uint32_t number : field.bad)
      EXPECT_EQ(read(number), std::nullopt) << field.name << number;
    for (const auto& [from, to] : field.changed) EXPECT_EQ(read(from), to) << field.name << from;
  }
  const auto counted = [&](std::size_t which, auto add, std::size_t most, auto count) {
    wire::ServerMessage message = messages[which];
    while (count(message) < most) add(message);
    EXPECT_TRUE(readServerMessage(message.SerializeAsString())) << most;
    add(message);
    EXPECT_FALSE(readServerMessage(message.SerializeAsString())) << most + 1;
  };
  counted(
      0, [](auto& m) { m.mutable_welcome()->add_help("x"); }, kMaxHelpLines,
      [](auto& m) { return static_cast<std::size_t>(m.welcome().help_size()); });
  counted(
      2, [](auto& m) { m.mutable_players()->add_players()->set_player(1); }, kMaxPlayers,
      [](auto& m) { return static_cast<std::size_t>(m.players().players_size()); });
  counted(
      7, [](auto& m) { m.mutable_sounds()->add_sounds()->set_label("x"); }, kMaxSounds,
      [](auto& m) { return static_cast<std::size_t>(m.sounds().sounds_size()); });
  counted(
      0, [](auto& m) { m.mutable_welcome()->mutable_resume_token()->push_back('t'); }, 64,
      [](auto& m) { return m.welcome().resume_token().size(); });
}

TEST(ServerMessages, TextsOfEveryHostileClassAreMadeHarmless) {
  for (const test::HostileText& hostile : test::hostileTexts()) {
    SCOPED_TRACE(hostile.what);
    for (const wire::ServerMessage& message : test::serverMessages("x" + hostile.bytes + "y")) {
      // Bytes that are not UTF-8 make the message invalid. In other texts, bad characters are replaced.
      if (const auto value = readServerMessage(message.SerializeAsString())) std::visit(ExpectGood(), *value);
    }
  }
}

}  // namespace
}  // namespace naiad
