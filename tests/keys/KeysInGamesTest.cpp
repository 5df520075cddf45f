// The effect of held keys in the games at a terminal that does not report releases, in virtual time.
#include <gtest/gtest.h>

#include <chrono>

#include "Figures.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

class KeysInGames : public testing::TestWithParam<int> {
 protected:
  TypedKeyboard::Options keyboard() const { return {std::chrono::milliseconds(GetParam()), 33ms}; }
  const KeyMethod shipped{"shipped", HoldRule{}};
};

TEST_P(KeysInGames, GuessedTapsOvershootByUnderHalfACell) {
  for (const std::string& game : keyGames())
    EXPECT_LT(runPatterns(game, shipped, keyboard()).tap_over, 0.5) << game;
}

TEST_P(KeysInGames, NothingTypedIsLost) {
  for (const std::string& game : keyGames())
    EXPECT_EQ(runPatterns(game, shipped, keyboard()).missed, 0) << game;
}

TEST_P(KeysInGames, ReportedReleasesAreExact) {
  const KeyMethod real{"releases", {}, true};
  for (const std::string& game : keyGames()) {
    const PatternFigures figures = runPatterns(game, real, keyboard());
    EXPECT_EQ(figures.tap_over + figures.hold_over + figures.behind + figures.stalled, 0) << game;
  }
}

TEST_P(KeysInGames, HoldRuleReducesStallsOfAJumpingRunner) {
  const KeyMethod silent{"as silent keys", HoldRule{HoldRule::First::kTap, 0ms, false}};
  const PatternFigures now = runPatterns("platformer", shipped, keyboard());
  const PatternFigures before = runPatterns("platformer", silent, keyboard());
  EXPECT_LT(now.behind, before.behind - 0.5) << "cells";
  EXPECT_LT(now.stalled, before.stalled) << "ms";
}

INSTANTIATE_TEST_SUITE_P(Pauses, KeysInGames, testing::Values(250, 500));

}  // namespace
}  // namespace naiad
