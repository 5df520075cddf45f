// Checks PROTOCOL.md against the code: makes its worked examples and reads its table of limits.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "naiad.pb.h"
#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"
#include "shared/net/datagram/SealedHeader.h"
#include "shared/net/stream/Framing.h"
#include "shared/replica/Bits.h"
#include "shared/replica/Limits.h"
#include "shared/replica/Replica.h"
#include "shared/replica/UpdateCodec.h"
#include "shared/values/Keyboard.h"
#include "shared/values/Vector.h"
#include "tests/support/CellsAt.h"

namespace naiad {
namespace {

using test::cellsAt;

const Origin kConfirmed{{-10, 0}, 7, 5, 4};

std::string exampleSnapshot() {
  SnapshotWriter out;
  SnapshotHeader header;
  header.number = 3;
  header.tick = 100;
  header.has_input = true;
  header.input = 2;
  header.input_tick = 99;
  out.beginSnapshot(header, 1, kConfirmed);
  out.write(WorldRecord{{cellsAt(0, 0), cellsAt(80, 24)}, 80, 24, df::BLUE});
  out.write(ViewRecord{cellsAt(0, 0), true, 5, 1});
  out.write(OriginRecord{2, {{-30, -10}, 8, 6, 7}});
  out.write(TextRecord{0, 1, 0, df::GREEN, "Hi"});
  const auto object = [&](std::uint32_t id, std::uint8_t groups, const ObjectState& state, LookForm form) {
    BitWriter bits;
    out.encode(bits, groups, 1, state, state.motion, form);
    out.object(id, std::move(bits));
  };
  ObjectState saucer;
  saucer.order = 7;
  saucer.motion = {100, cellsAt(10, 12), cellsAt(-0.5, 0), {}};
  const Glyph head{0, 0, U'@', df::CYAN};
  saucer.look = {{{head, {256, 0, U'>', df::CYAN}}, {head}}, 2, Selector::clock(96, 3)};
  object(5, kAllGroups, saucer, {LookForm::kDefined, 9});
  ObjectState turned;
  turned.motion = {100, cellsAt(123.25, 4.75), {}, {}};
  object(6, kMotion, turned, {});
  saucer.look.altitude = 4;
  saucer.look.selector = Selector::turning(0, 1u << 29, 1 << 20);
  object(8, kLook, saucer, {LookForm::kNamed, 9});
  object(9, kDeath, {}, {});
  return out.finish();
}

ClientUpdate exampleUpdate() {
  ClientUpdate update;
  update.acks = {3, 0b10};
  Input key{3, 101, 3, false, df::KEY_RELEASED, df::Keyboard::SPACE, 0, 0, 0};
  Input click{4, 103, 3, true, df::CLICKED, 0, df::Mouse::LEFT + 1, 12, 5};
  update.inputs = {key, click};
  return update;
}

/// Returns a frame with the sounds that a client gets at the start of a round.
std::string exampleSounds() {
  wire::ServerMessage message;
  wire::Sound& theme = *message.mutable_sounds()->add_sounds();
  theme.set_label("theme");
  theme.set_music(true);
  theme.set_loop(true);
  wire::Sound& siren = *message.mutable_sounds()->add_sounds();
  siren.set_label("siren");
  siren.set_action(wire::Sound::STOP);
  siren.set_player(2);
  message.set_number(5);
  std::string frame;
  appendFrame(frame, message.SerializeAsString());
  return frame;
}

std::string document() {
  std::ifstream file(NAIAD_SOURCE_DIR "/proto/PROTOCOL.md");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// A block in the section "Worked examples".
struct Example {
  std::string bytes;  ///< hex digits without the comments
  std::string bits;   ///< bits of the lines that have them behind `#`, in writing order
};

Example example(std::size_t nth) {
  const std::string text = document();
  std::istringstream lines(text.substr(std::min(text.find("## Worked examples"), text.size())));
  Example found;
  std::size_t fences = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("```", 0) == 0) {
      ++fences;
      continue;
    }
    if (fences != 2 * nth + 1) continue;
    std::istringstream words(line.substr(0, line.find('#')));
    for (std::string word; words >> word;) found.bytes += word;
    if (line.rfind("# ", 0) == 0) found.bits += line.substr(2, line.find_first_not_of("01", 2) - 2);
  }
  return found;
}

std::string hexOfBits(const std::string& bits) {
  BitWriter out;
  for (const char bit : bits) out.flag(bit == '1');
  return hexText(out.bytes());
}

TEST(ProtocolBytes, HelloMatchesTheDocument) {
  wire::ClientMessage message;
  message.mutable_hello()->set_magic(kHelloMagic);
  message.mutable_hello()->set_protocol(kProtocolVersion);
  message.mutable_hello()->set_player_name("Ann");
  std::string frame;
  appendFrame(frame, message.SerializeAsString());
  EXPECT_EQ(hexText(frame), example(0).bytes);
}

TEST(ProtocolBytes, SnapshotMatchesTheDocument) {
  EXPECT_EQ(hexText(exampleSnapshot()), example(1).bytes);
  EXPECT_EQ(hexOfBits(example(1).bits), example(1).bytes);
}

TEST(ProtocolBytes, UpdateMatchesTheDocument) {
  EXPECT_EQ(hexText(writeUpdate(exampleUpdate())), example(2).bytes);
  EXPECT_EQ(hexOfBits(example(2).bits), example(2).bytes);
}

TEST(ProtocolBytes, FrameMatchesTheDocument) {
  SnapshotWriter out;
  SnapshotHeader header;
  header.number = 4;
  header.tick = 105;
  out.beginSnapshot(header, 0, {});
  wire::ServerMessage message;
  message.set_snapshot(out.finish());
  EXPECT_EQ(hexOfBits(example(3).bits), hexText(message.snapshot()));
  std::string frame;
  appendFrame(frame, message.SerializeAsString());
  EXPECT_EQ(hexText(frame), example(3).bytes);
}

TEST(ProtocolBytes, UpdateWithFewLossesMatchesTheDocument) {
  ClientUpdate update;
  update.acks = {70, ~std::uint64_t{1}};
  EXPECT_EQ(hexText(writeUpdate(update)), example(4).bytes);
  EXPECT_EQ(hexOfBits(example(4).bits), example(4).bytes);
}

TEST(ProtocolBytes, SoundsMatchTheDocument) {
  EXPECT_EQ(hexText(exampleSounds()), example(5).bytes);
}

// A second copy of the page's bytes. It reveals a change of the protocol if page and code change together.
TEST(ProtocolBytes, Version4BytesNeverChange) {
  EXPECT_EQ(kProtocolVersion, 4u);
  EXPECT_EQ(hexText(exampleSnapshot()),
            "030064002c0010f40a01000000000a000000000000000300"
            "00000a06868b14ffffffb7ffffff473b0000000000804250"
            "01292dc3ab01292c88ea04102902747c438056252254a802"
            "482f8213c0100b00006a");
  EXPECT_EQ(hexText(writeUpdate(exampleUpdate())), "07000a00000000000000e001803280004844625000");
}

// The frozen bytes must also decode to their original values.
TEST(ProtocolBytes, ExamplesDecodeToTheirOriginalValues) {
  SnapshotDictionary dictionary;
  dictionary.define(2, OriginRecord{1, kConfirmed});
  Snapshot snapshot;
  ASSERT_EQ(readSnapshot(exampleSnapshot(), {2, 99, 1}, dictionary, snapshot), ReadResult::kOk);
  ASSERT_EQ(snapshot.records.objects.size(), 4u);
  EXPECT_EQ(snapshot.records.objects[1].state.motion.position, cellsAt(123.25, 4.75));
  const Look& animated = snapshot.records.objects[0].state.look;
  const Look& turning = snapshot.records.objects[2].state.look;
  EXPECT_TRUE(turning.sequence.isSharedWith(animated.sequence));
  EXPECT_EQ(animated.selector, Selector::clock(96, 3));
  EXPECT_EQ(turning.selector, Selector::turning(0, 1u << 29, 1 << 20));
  const auto update = readUpdate(writeUpdate(exampleUpdate()), {3, 100, 2});
  ASSERT_TRUE(update);
  EXPECT_EQ(update->inputs, exampleUpdate().inputs);
}

TEST(ProtocolBytes, LimitsMatchTheDocument) {
  const std::map<std::string, std::uint64_t> limits = {
      {"kProtocolVersion", kProtocolVersion},
      {"kHelloMagic", kHelloMagic},
      {"kDefaultPort", kDefaultPort},
      {"kMaxServerFrame", kMaxServerFrame},
      {"kMaxClientFrame", kMaxClientFrame},
      {"kMaxHelloFrame", kMaxHelloFrame},
      {"kMaxSnapshot", kMaxSnapshot},
      {"kMaxDatagramSnapshot", kMaxDatagramSnapshot},
      {"kMaxNameLength", kMaxNameLength},
      {"kMaxChatLength", kMaxChatLength},
      {"kMaxMessageLength", kMaxMessageLength},
      {"kMaxProgramLength", kMaxProgramLength},
      {"kMaxHelpLines", kMaxHelpLines},
      {"kMaxHelpLength", kMaxHelpLength},
      {"kMaxPlayers", kMaxPlayers},
      {"kMaxSounds", kMaxSounds},
      {"kMaxSoundLabel", kMaxSoundLabel},
      {"kMaxSlots", kMaxSlots},
      {"kMaxGlyphs", kMaxGlyphs},
      {"kMaxLookBytes", kMaxLookBytes},
      {"kMaxTexts", kMaxTexts},
      {"kMinViewWidth", kMinViewWidth},
      {"kMinViewHeight", kMinViewHeight},
      {"kMaxViewWidth", kMaxViewWidth},
      {"kMaxViewHeight", kMaxViewHeight},
      {"kMaxDatagram", kMaxDatagram},
      {"kMaxControlRows", df::kMaxControlRows},
      {"kMaxControlTicks", df::kMaxControlTicks},
      {"kMaxControlTableBytes", kMaxControlTableBytes},
      {"kMaxUpdateInputs", kMaxUpdateInputs},
      {"kMaxUpdate", kMaxUpdate},
      {"kOriginSlots", kOriginSlots},
      {"kMaxAppearances", kMaxAppearances},
      {"kMaxDictionaryGlyphs", kMaxDictionaryGlyphs},
      {"kMaxFrames", kMaxFrames},
      {"kMaxTicksPerFrame", kMaxTicksPerFrame},
      {"kMaxReplicaObjects", kMaxReplicaObjects},
      {"kMaxReplicaGlyphs", kMaxReplicaGlyphs},
      {"kMaxDrawnObjects", kMaxDrawnObjects},
      {"kMaxDrawnGlyphs", kMaxDrawnGlyphs},
  };
  const std::string text = document();
  std::map<std::string, std::uint64_t> listed;
  std::istringstream lines(text.substr(std::min(text.find("## Limits"), text.size())));
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("| `k", 0) != 0) continue;
    const std::size_t end = line.find('`', 3);
    listed[line.substr(3, end - 3)] = std::stoull(line.substr(line.find('|', end) + 1));
  }
  EXPECT_EQ(listed, limits);
}

TEST(ProtocolBytes, LastKeyMatchesTheDocument) {
  EXPECT_NE(document().find("`key`: 0 … " + std::to_string(df::Keyboard::PAGEDOWN) + ","), std::string::npos);
  EXPECT_EQ(df::Keyboard::kKeyCount, df::Keyboard::PAGEDOWN + 1);
}

TEST(ProtocolBytes, LargestSnapshotFitsItsFrame) {
  wire::ServerMessage message;
  message.set_snapshot(std::string(kMaxSnapshot, 'x'));
  EXPECT_LE(message.ByteSizeLong(), kMaxServerFrame);
}

TEST(ProtocolBytes, LargestUpdateFitsItsFrame) {
  wire::ClientMessage message;
  message.set_update(std::string(kMaxUpdate, 'x'));
  EXPECT_LE(message.ByteSizeLong(), kMaxClientFrame);
}

}  // namespace
}  // namespace naiad
