#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "shared/net/base/Limits.h"
#include "shared/net/stream/Framing.h"

namespace naiad {
namespace {

using namespace std::string_literals;

std::string framed(std::string_view payload) {
  std::string out;
  appendFrame(out, payload);
  return out;
}

/// Feeds a copy, so that a sanitizer detects views that outlive it, and collects the frames.
void feed(FrameReader& reader, std::string_view bytes, std::vector<std::string>& frames) {
  const std::vector<char> piece(bytes.begin(), bytes.end());
  reader.feed({piece.data(), piece.size()});
  while (const auto frame = reader.next()) frames.emplace_back(*frame);
}

TEST(Framing, PrefixIsTwoBytesLittleEndian) {
  EXPECT_EQ(framed("abc"), "\x03\x00"s + "abc");
  EXPECT_EQ(framed(std::string(0x1234, 'x')).substr(0, 2), "\x34\x12");
}

TEST(Framing, WriterRefusesWrongSizesAndLeavesTheOutputAlone) {
  std::string out = "before";
  EXPECT_THROW(appendFrame(out, ""), std::length_error);
  EXPECT_THROW(appendFrame(out, std::string(kMaxFramePayload + 1, 'x')), std::length_error);
  EXPECT_EQ(out, "before");
}

TEST(Framing, TruncatedFrameIsNotYielded) {
  const std::string whole = framed("hello");
  for (std::size_t length = 1; length < whole.size(); ++length) {
    FrameReader reader(kMaxHelloFrame);
    std::vector<std::string> frames;
    feed(reader, whole.substr(0, length), frames);
    EXPECT_TRUE(frames.empty());
    EXPECT_TRUE(reader.midFrame());
    EXPECT_EQ(reader.error(), FrameError::kNone);
    FrameReader behind(kMaxHelloFrame);
    feed(behind, framed("one") + framed("two") + whole.substr(0, length), frames);
    EXPECT_EQ(frames, (std::vector{"one"s, "two"s}));
    EXPECT_TRUE(behind.midFrame());
  }
}

TEST(Framing, OversizedFrameFailsBeforeItsPayload) {
  for (const std::size_t first : {1u, 2u, 7u}) {  // number of bytes that arrive before the others
    FrameReader reader(4);
    std::vector<std::string> frames;
    feed(reader, framed("four"), frames);
    feed(reader, framed("fives").substr(0, first), frames);
    EXPECT_EQ(reader.buffered(), first == 1 ? 1u : 0u);
    feed(reader, framed("fives").substr(first, first == 1 ? 6 : 0), frames);
    EXPECT_EQ(frames, std::vector{"four"s});
    EXPECT_EQ(reader.error(), FrameError::kTooLarge);
    EXPECT_EQ(reader.buffered(), 0u);
    feed(reader, framed("x"), frames);
    EXPECT_EQ(frames.size(), 1u);
  }
}

TEST(Framing, LoweredLimitHoldsForAnIncompleteFrame) {
  FrameReader reader(100);
  std::vector<std::string> frames;
  feed(reader, framed("a longer one").substr(0, 5), frames);
  reader.setLimit(4);
  feed(reader, "x", frames);
  EXPECT_EQ(reader.error(), FrameError::kTooLarge);
}

TEST(Framing, BuffersOnlyReceivedBytes) {
  FrameReader reader(kMaxFramePayload);
  std::vector<std::string> frames;
  feed(reader, "\xff\xff", frames);  // announces 64 KiB
  EXPECT_EQ(reader.buffered(), 2u);
  feed(reader, std::string(10, 'x'), frames);
  EXPECT_EQ(reader.buffered(), 12u);
}

TEST(Framing, FeedingBeforeDrainingThrows) {
  FrameReader reader(kMaxHelloFrame);
  const std::string piece = framed("a");
  reader.feed(piece);
  EXPECT_THROW(reader.feed(piece), std::logic_error);
}

}  // namespace
}  // namespace naiad
