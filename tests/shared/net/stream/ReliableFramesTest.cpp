#include <gtest/gtest.h>

#include <vector>

#include "shared/net/stream/ReliableFrames.h"

namespace naiad {
namespace {

std::vector<std::string> all(const ReliableFrameSender& frames) {
  std::vector<std::string> found;
  frames.forEach([&found](const std::string& frame) { found.push_back(frame); });
  return found;
}

TEST(ReliableFrameSender, AreKeptUntilAcknowledgedInOrder) {
  ReliableFrameSender frames;
  EXPECT_EQ(frames.next(), 1u);
  for (const char* text : {"a", "b", "c"}) ASSERT_TRUE(frames.add(text));
  EXPECT_EQ(frames.next(), 4u);
  EXPECT_EQ(all(frames), (std::vector<std::string>{"a", "b", "c"}));
  frames.acknowledge(2);
  EXPECT_EQ(all(frames), std::vector<std::string>{"c"});
  frames.acknowledge(1);
  frames.acknowledge(0);
  EXPECT_EQ(all(frames), std::vector<std::string>{"c"}) << "an old acknowledgement says nothing";
  frames.acknowledge(4);
  EXPECT_EQ(all(frames), std::vector<std::string>{"c"}) << "nor one of what was never sent";
  frames.acknowledge(3);
  EXPECT_TRUE(all(frames).empty());
  EXPECT_EQ(frames.bytes(), 0u);
}

TEST(ReliableFrameSender, KeepAtMost64KiB) {
  ReliableFrameSender frames;
  const std::string frame(1022, 'x');
  for (int i = 0; i < 64; ++i) ASSERT_TRUE(frames.add(frame));
  EXPECT_EQ(frames.bytes(), ReliableFrameSender::kMax);
  EXPECT_FALSE(frames.add("y"));
  EXPECT_EQ(frames.next(), 65u) << "it has no number";
  EXPECT_EQ(all(frames).size(), 64u);
  frames.acknowledge(1);
  EXPECT_TRUE(frames.add("y"));
}

TEST(ReliableFrameSender, AreAcceptedOnce) {
  ReliableFrameReceiver heard;
  EXPECT_TRUE(heard.accept(0)) << "it is not kept";
  EXPECT_EQ(heard.newest(), 0u);
  EXPECT_TRUE(heard.accept(7)) << "the first may be any";
  EXPECT_FALSE(heard.accept(7));
  EXPECT_FALSE(heard.accept(6));
  EXPECT_TRUE(heard.accept(9)) << "one that was replaced leaves a gap";
  EXPECT_FALSE(heard.accept(8));
  EXPECT_EQ(heard.newest(), 9u);
  ReliableFrameReceiver late;
  EXPECT_TRUE(late.accept(0xFFFFFFFF));
  EXPECT_TRUE(late.accept(1)) << "after the last number comes 1";
  EXPECT_FALSE(late.accept(0xFFFFFFFF));
}

}  // namespace
}  // namespace naiad
