#include <gtest/gtest.h>

#include "engine/events/EventKeyboard.h"
#include "engine/world/InputQueue.h"
#include "tests/server/engine/Probe.h"
#include "tests/server/engine/world/Parts.h"

namespace df::test {
namespace {

TEST(InputQueue, PlayerIsThereOnceTheJoinIsHandled) {
  Parts parts;
  const std::uint32_t ann = parts.input.join("ann", RED);
  EXPECT_EQ(parts.input.join("bob", BLUE, 7), 7u);
  EXPECT_EQ(parts.views.player(ann), nullptr);
  parts.input.drain();
  ASSERT_NE(parts.views.player(ann), nullptr);
  parts.input.leave(ann);
  parts.input.drain();
  EXPECT_EQ(parts.views.player(ann), nullptr);
  EXPECT_EQ(parts.input.join("cid", RED), 8u);
}

TEST(InputQueue, HandlerKnowsWhoseInputItIs) {
  Parts parts;
  Probe probe;
  probe.registerInterest(KEYBOARD_EVENT);
  std::vector<std::uint32_t> players;
  probe.on_event = [&](Probe&, const Event&) { players.push_back(parts.input.player()); };
  const std::uint32_t ann = parts.input.join("ann", RED);
  parts.input.key(ann, Keyboard::A, KEY_PRESSED);
  parts.input.key(ann, static_cast<Keyboard::Key>(-1), KEY_PRESSED);
  parts.input.key(ann + 1, Keyboard::A, KEY_PRESSED);
  parts.input.drain();
  EXPECT_EQ(players, std::vector{ann});
  EXPECT_EQ(parts.input.player(), 0u);
}

TEST(InputQueue, GameOverOfOnePlayerIsTakenWhenAsked) {
  Parts parts;
  Probe probe;
  probe.registerInterest(KEYBOARD_EVENT);
  bool taken = false;
  probe.on_event = [&](Probe&, const Event&) { taken = parts.input.takeGameOver(); };
  const std::uint32_t ann = parts.input.join("ann", RED);
  const auto press = [&] {
    parts.input.key(ann, Keyboard::Q, KEY_PRESSED);
    parts.input.drain();
    return taken;
  };
  EXPECT_FALSE(press());
  parts.input.setGameOverLeaves(true);
  EXPECT_FALSE(parts.input.takeGameOver()) << "no input is being handled";
  EXPECT_TRUE(press());
  EXPECT_EQ(parts.input.takeLeavers(), std::vector{ann});
  EXPECT_TRUE(parts.input.takeLeavers().empty());
}

}  // namespace
}  // namespace df::test
