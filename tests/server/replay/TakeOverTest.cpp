// If a key makes the world crash or hang, another world takes over, without that key.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "tests/server/replay/FrailRound.h"
#include "tests/support/Sanitizers.h"
#include "tests/support/Text.h"

namespace naiad {
namespace {

class TakeOverTest : public FrailRound {};

TEST_F(TakeOverTest, CrashByAKeyIsRecoveredWithoutTheKey) {
  play(100);
  const std::uint32_t next = world->nextTick();
  press(df::Keyboard::Q);
  world->addInput({.kind = df::InputQueue::kJoin, .player = 2, .name = "Bob", .color = df::BLUE});
  ASSERT_TRUE(tick()) << log;
  EXPECT_EQ(world->nextTick(), next + 1) << "its players notice nothing but a pause";
  EXPECT_EQ(world->view().players.size(), 2u) << "who joined in that tick is there";
  // In sanitized builds, the sanitizer catches the signal and ends the process with a code.
  const std::string how = test::kSanitized ? "ended with code" : "crashed (SIGSEGV)";
  EXPECT_TRUE(test::has(log, "the game " + how));
  EXPECT_TRUE(test::has(log, "recovering it without the input of that tick"));
  play(60);
  EXPECT_EQ(verify(), "");
}

TEST_F(TakeOverTest, InputsDuringFailoverAreInTheNextTick) {
  play(50);
  press(df::Keyboard::Q);
  world->tick(true, false);
  serveUntil([this] { return log.find("; recovering it") != std::string::npos; });
  ASSERT_FALSE(world->isReady());
  EXPECT_FALSE(world->recovering()) << "and new players may join";
  world->addInput({.kind = df::InputQueue::kJoin, .player = 2, .name = "Bob", .color = df::BLUE});
  serveUntil([this] { return world->isReady(); });
  ASSERT_TRUE(tick());
  EXPECT_EQ(world->view().players.size(), 2u);
  EXPECT_EQ(verify(), "");
}

TEST_F(TakeOverTest, SecondCrashAtTheSamePlaceEndsTheRound) {
  play(50);
  press(df::Keyboard::Q);
  ASSERT_TRUE(tick()) << log;
  play(5);
  press(df::Keyboard::Q);
  EXPECT_FALSE(tick());
  ASSERT_TRUE(world->end());
  EXPECT_EQ(world->end()->why, WorldEnd::kCrashed);
  EXPECT_TRUE(test::has(log, " again; to see where: dfreplay "));
  EXPECT_EQ(verify(), "");
}

TEST_F(TakeOverTest, LaterCrashIsRecoveredAgain) {
  for (int death = 0; death < 3; ++death) {
    play(static_cast<int>(Round::kSameFailureTicks) + 10);
    press(df::Keyboard::Q);
    ASSERT_TRUE(tick()) << death << ": " << log;
  }
  play(10);
  EXPECT_EQ(verify(), "");
}

TEST_F(TakeOverTest, HangByAKeyIsRecoveredWithoutTheKey) {
  play(50);
  press(df::Keyboard::H);
  ASSERT_TRUE(tick()) << log;
  EXPECT_TRUE(test::has(log, "did not answer "));
  play(20);
  EXPECT_EQ(verify(), "");
}

}  // namespace
}  // namespace naiad
