// PROTOCOL.md and the code say the same: its worked examples are made here, its table of limits is read.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "Framing.h"
#include "Keyboard.h"
#include "Limits.h"
#include "RecordCodec.h"
#include "Vector.h"
#include "naiad.pb.h"

namespace naiad {
namespace {

std::string hex(const std::string& bytes) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (!text.empty()) text += ' ';
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

df::FixedVector at(double x, double y) {
  return *df::toFixed(df::Vector(x, y));
}

std::string exampleRecords() {
  RecordWriter out;
  out.write(WorldRecord{{at(0, 0), at(80, 24)}, 80, 24});
  out.write(ViewRecord{at(0, 0), 5, 1});
  out.write(TextRecord{0, 1, 0, df::GREEN, "Hi"});
  ObjectRecord born{5, 1, kAllGroups, {}};
  born.state.order = 7;
  born.state.motion = {100, at(10, 12), at(-0.5, 0), {}};
  born.state.look = {{{{0, 0, U'@', df::CYAN}, {256, 0, U'>', df::CYAN}}}, 2};
  born.state.body = {{at(-0.5, -0.5), at(1, 1)}, df::HARD, false};
  out.write(born);
  ObjectRecord turned{6, 2, kMotion, {}};
  turned.state.motion = {100, at(3, 4), {}, {}};
  out.write(turned);
  out.write(ObjectRecord{9, 3, 0, {}});
  return out.bytes();
}

std::string document() {
  std::ifstream file(NAIAD_SOURCE_DIR "/proto/PROTOCOL.md");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The bytes of the `nth` block of the section "Worked examples", without the comments.
std::string example(std::size_t nth) {
  const std::string text = document();
  std::istringstream lines(text.substr(std::min(text.find("## Worked examples"), text.size())));
  std::string bytes;
  std::size_t fences = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("```", 0) == 0) {
      ++fences;
      continue;
    }
    if (fences != 2 * nth + 1) continue;
    std::istringstream words(line.substr(0, line.find('#')));
    for (std::string word; words >> word;) bytes += (bytes.empty() ? "" : " ") + word;
  }
  return bytes;
}

TEST(ProtocolBytes, HelloIsAsTheDocumentSays) {
  wire::ClientMessage message;
  message.mutable_hello()->set_magic(kHelloMagic);
  message.mutable_hello()->set_protocol(kProtocolVersion);
  message.mutable_hello()->set_player_name("Ann");
  std::string frame;
  appendFrame(frame, message.SerializeAsString());
  EXPECT_EQ(hex(frame), example(0));
}

TEST(ProtocolBytes, RecordsAreAsTheDocumentSays) {
  EXPECT_EQ(hex(exampleRecords()), example(1));
}

TEST(ProtocolBytes, FrameIsAsTheDocumentSays) {
  wire::ServerMessage message;
  message.mutable_snapshot()->set_number(3);
  message.mutable_snapshot()->set_tick(100);
  message.mutable_snapshot()->set_records(std::string("\x10\x09\x03", 3));
  message.mutable_snapshot()->set_input_applied(2);
  std::string frame;
  appendFrame(frame, message.SerializeAsString());
  EXPECT_EQ(hex(frame), example(2));
}

// The same bytes once more, so that a change of document and code together is noticed as a change of
// protocol.
TEST(ProtocolBytes, Version1StaysAsItIs) {
  EXPECT_EQ(kProtocolVersion, 1u);
  EXPECT_EQ(hex(exampleRecords()),
            "01 00 00 80 80 80 80 80 0a 80 80 80 80 80 03 50 18 "
            "02 00 00 06 01 "
            "03 00 02 00 02 02 48 69 "
            "1f 05 01 07 "
            "01 80 80 80 80 c0 02 80 80 80 80 80 03 ff ff ff ff 0f 00 "
            "02 01 02 81 02 06 f8 01 "
            "00 ff ff ff ff 0f ff ff ff ff 0f 80 80 80 80 10 80 80 80 80 10 "
            "12 06 02 00 80 80 80 80 60 80 80 80 80 80 01 "
            "10 09 03");
}

TEST(ProtocolBytes, LimitsAreAsTheDocumentSays) {
  const std::map<std::string, std::uint64_t> limits = {
      {"kProtocolVersion", kProtocolVersion},
      {"kHelloMagic", kHelloMagic},
      {"kDefaultPort", kDefaultPort},
      {"kMaxServerFrame", kMaxServerFrame},
      {"kMaxClientFrame", kMaxClientFrame},
      {"kMaxHelloFrame", kMaxHelloFrame},
      {"kMaxSnapshotRecords", kMaxSnapshotRecords},
      {"kMaxNameLength", kMaxNameLength},
      {"kMaxChatLength", kMaxChatLength},
      {"kMaxSentenceLength", kMaxSentenceLength},
      {"kMaxProgramLength", kMaxProgramLength},
      {"kMaxHelpLines", kMaxHelpLines},
      {"kMaxHelpLength", kMaxHelpLength},
      {"kMaxPlayers", kMaxPlayers},
      {"kMaxSlots", kMaxSlots},
      {"kMaxGlyphs", kMaxGlyphs},
      {"kMaxLookBytes", kMaxLookBytes},
      {"kMaxTexts", kMaxTexts},
      {"kMinViewWidth", kMinViewWidth},
      {"kMinViewHeight", kMinViewHeight},
      {"kMaxViewWidth", kMaxViewWidth},
      {"kMaxViewHeight", kMaxViewHeight},
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

TEST(ProtocolBytes, LastKeyIsAsTheDocumentSays) {
  EXPECT_NE(document().find("`key`: 0 … " + std::to_string(df::Keyboard::PAGEDOWN) + ","), std::string::npos);
  EXPECT_EQ(df::Keyboard::kKeyCount, df::Keyboard::PAGEDOWN + 1);
}

TEST(ProtocolBytes, TheLargestSnapshotFitsItsFrame) {
  wire::ServerMessage message;
  message.mutable_snapshot()->set_number(0xFFFFFFFF);
  message.mutable_snapshot()->set_tick(0xFFFFFFFF);
  message.mutable_snapshot()->set_input_applied(0xFFFFFFFF);
  message.mutable_snapshot()->set_records(std::string(kMaxSnapshotRecords, 'x'));
  EXPECT_LE(message.ByteSizeLong(), kMaxServerFrame);
}

}  // namespace
}  // namespace naiad
