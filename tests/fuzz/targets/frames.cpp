// The stream deframer: however a stream is split, its frames equal those of the whole stream, and never more
// than one frame is buffered.
//
//   input   limit 2 | limit after the first frame 2 | how it is split 1 | the stream
#include <algorithm>
#include <optional>
#include <stdexcept>
#include <vector>

#include "Target.h"
#include "shared/net/stream/Framing.h"

namespace naiad::fuzz {
namespace {

struct Outcome {
  std::vector<std::string> frames;
  FrameError error = FrameError::kNone;
  bool mid_frame = false;
  friend bool operator==(const Outcome&, const Outcome&) = default;
};

/// Returns the frames of a complete stream by the rules of PROTOCOL.md.
Outcome expected(std::string_view stream, std::size_t limit, std::size_t later) {
  Outcome outcome;
  while (stream.size() >= kFrameHeaderSize) {
    const auto low = static_cast<unsigned char>(stream[0]);
    const auto high = static_cast<unsigned char>(stream[1]);
    const std::size_t length = low + 256u * high;
    if (length == 0) outcome.error = FrameError::kEmpty;
    if (length > limit) outcome.error = FrameError::kTooLarge;
    if (outcome.error != FrameError::kNone) return outcome;
    if (stream.size() - kFrameHeaderSize < length) break;
    outcome.frames.emplace_back(stream.substr(kFrameHeaderSize, length));
    stream.remove_prefix(kFrameHeaderSize + length);
    limit = later;
  }
  outcome.mid_frame = !stream.empty();
  return outcome;
}

Outcome cut(std::string_view stream, std::size_t limit, std::size_t later, std::uint8_t how) {
  FrameReader reader(limit);
  Outcome outcome;
  const std::size_t most = std::max(limit, later) + kFrameHeaderSize;
  forEachPiece(stream, how, [&](std::string_view piece) {
    reader.feed(piece);
    while (const auto frame = reader.next()) {
      outcome.frames.emplace_back(*frame);
      reader.setLimit(later);
      REQUIRE(reader.buffered() <= most);
    }
    REQUIRE(reader.buffered() <= most);
  });
  outcome.error = reader.error();
  outcome.mid_frame = reader.midFrame();
  return outcome;
}

}  // namespace

void tryInput(Script script) {
  const std::size_t limit = script.number<std::uint16_t>();
  const std::size_t later = script.number<std::uint16_t>();
  const std::uint8_t how = script.byte();
  const std::string stream = script.rest();
  const Outcome outcome = cut(stream, limit, later, how);
  REQUIRE(outcome == expected(stream, limit, later));

  std::string written;
  for (const std::string& frame : outcome.frames) appendFrame(written, frame);
  REQUIRE(std::string_view(stream).starts_with(written));
  try {
    appendFrame(written, std::string(stream.size() < 64 ? stream.size() : kMaxFramePayload + 1, 'x'));
    REQUIRE(!stream.empty() && stream.size() < 64);
  } catch (const std::length_error&) {
    REQUIRE(stream.empty() || stream.size() >= 64);
  }
}

}  // namespace naiad::fuzz
