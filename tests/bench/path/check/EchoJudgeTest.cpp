#include <gtest/gtest.h>

#include "tests/bench/path/judge/EchoJudge.h"

namespace bench::path {
namespace {

Nanoseconds ms(int value) {
  return Nanoseconds(static_cast<std::int64_t>(value) * 1'000'000);
}

const Nanoseconds kEver = ms(1'000'000);

TEST(EchoJudge, MeasuresFromKeyPressToFirstEcho) {
  EchoJudge judge(26);
  EXPECT_EQ(judge.press(ms(100)), 0u);
  EXPECT_EQ(judge.press(ms(300)), 1u);
  judge.look(0, ms(220));
  judge.look(0, ms(330));
  judge.look(1, ms(450));
  EXPECT_EQ(judge.latencies(ms(0), kEver), (std::vector<double>{120, 150}));
}

TEST(EchoJudge, OneEchoAnswersAllEarlierKeys) {
  EchoJudge judge(26);
  judge.press(ms(100));
  judge.press(ms(110));
  judge.look(1, ms(200));
  EXPECT_EQ(judge.latencies(ms(0), kEver), (std::vector<double>{100, 90}));
}

TEST(EchoJudge, EchoNumbersWrapAround) {
  EchoJudge judge(4);
  for (int i = 0; i < 9; ++i) {
    judge.press(ms(100 * i));
    judge.look(static_cast<std::uint32_t>(i % 4), ms(100 * i + 30 + i));
  }
  EXPECT_EQ(judge.latencies(ms(700), kEver), (std::vector<double>{37, 38}));
}

TEST(EchoJudge, OnlyKeysPressedInTheWindowCount) {
  EchoJudge judge(26);
  judge.press(ms(100));
  judge.press(ms(200));
  judge.press(ms(300));
  judge.look(0, ms(150));
  judge.look(1, ms(260));
  EXPECT_EQ(judge.latencies(ms(200), ms(300)), (std::vector<double>{60}));
  EXPECT_EQ(judge.unanswered(ms(0), ms(300)), 0u);
  EXPECT_EQ(judge.unanswered(ms(0), ms(301)), 1u);
}

TEST(EchoJudge, EchoOfAnUnpressedKeyIsIgnored) {
  EchoJudge judge(26);
  judge.press(ms(100));
  judge.look(7, ms(150));
  judge.look(std::nullopt, ms(160));
  EXPECT_TRUE(judge.latencies(ms(0), kEver).empty());
}

}  // namespace
}  // namespace bench::path
