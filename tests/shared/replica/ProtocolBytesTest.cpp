// The worked example of PROTOCOL.md ("A snapshot, byte by byte"), so that document and code stay one.
#include <gtest/gtest.h>

#include <string>

#include "Framing.h"
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

TEST(ProtocolBytes, RecordsAreAsTheDocumentSays) {
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

TEST(ProtocolBytes, FrameIsAsTheDocumentSays) {
  wire::ServerMessage message;
  message.mutable_snapshot()->set_number(3);
  message.mutable_snapshot()->set_tick(100);
  message.mutable_snapshot()->set_records(std::string("\x10\x09\x03", 3));
  message.mutable_snapshot()->set_input_applied(2);
  std::string frame;
  appendFrame(frame, message.SerializeAsString());
  EXPECT_EQ(hex(frame), "13 00 1a 11 0d 03 00 00 00 15 64 00 00 00 1a 03 10 09 03 20 02");
}

TEST(ProtocolBytes, HelloIsAsTheDocumentSays) {
  wire::ClientMessage message;
  message.mutable_hello()->set_magic(kHelloMagic);
  message.mutable_hello()->set_protocol(kProtocolVersion);
  message.mutable_hello()->set_player_name("Ann");
  std::string frame;
  appendFrame(frame, message.SerializeAsString());
  EXPECT_EQ(hex(frame), "0e 00 0a 0c 0d 61 69 61 6e 10 01 1a 03 41 6e 6e");
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
