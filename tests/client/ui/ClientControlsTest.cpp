#include <gtest/gtest.h>

#include "client/ui/ClientControls.h"
#include "shared/net/base/Limits.h"

namespace naiad {
namespace {

using namespace df::Keyboard;
using Result = ClientControls::Result;

const KeyEvent kPrefix{RIGHTBRACKET, 0, KeyEvent::Action::kPress, kControl};
KeyEvent typed(Key key, char32_t ch) {
  return {key, ch};
}

TEST(ClientControls, OrdinaryKeysAreTheGames) {
  ClientControls controls;
  EXPECT_EQ(controls.take(typed(Q, U'q')), Result::kGame);
  EXPECT_EQ(controls.take({ESCAPE}), Result::kGame);
  EXPECT_EQ(controls.take(typed(RIGHTBRACKET, U']')), Result::kGame);
}

TEST(ClientControls, PrefixOpensCommands) {
  ClientControls controls;
  EXPECT_EQ(controls.take(kPrefix), Result::kTaken);
  EXPECT_TRUE(controls.prefixed());
  EXPECT_EQ(controls.take(typed(P, U'p')), Result::kTaken);
  EXPECT_FALSE(controls.prefixed());
  EXPECT_EQ(controls.panel(), Panel::kPlayers);
  controls.take(kPrefix);
  controls.take(typed(SLASH, U'?'));
  EXPECT_EQ(controls.panel(), Panel::kHelp);
  controls.take(kPrefix);
  controls.take(typed(H, U'h'));
  EXPECT_EQ(controls.panel(), Panel::kNone);
  controls.take(kPrefix);
  controls.take(typed(S, U's'));
  EXPECT_FALSE(controls.statusShown());
  controls.take(kPrefix);
  EXPECT_EQ(controls.take(typed(Q, U'q')), Result::kLeave);
}

TEST(ClientControls, PrefixTwiceClosesEverything) {
  ClientControls controls;
  controls.take(kPrefix);
  controls.take(typed(P, U'p'));
  controls.take(kPrefix);
  EXPECT_EQ(controls.take(kPrefix), Result::kTaken);
  EXPECT_FALSE(controls.prefixed());
  EXPECT_EQ(controls.panel(), Panel::kNone);
}

TEST(ClientControls, ModifiersAndRepeatsAreNoCommands) {
  ClientControls controls;
  controls.take(kPrefix);
  controls.take({RIGHTBRACKET, 0, KeyEvent::Action::kRepeat, kControl});
  controls.take({RIGHTBRACKET, 0, KeyEvent::Action::kRelease, kControl});
  controls.take({LEFTSHIFT, 0, KeyEvent::Action::kPress, kShift});
  EXPECT_TRUE(controls.prefixed());
  controls.take(typed(SLASH, U'?'));
  EXPECT_EQ(controls.panel(), Panel::kHelp);
}

TEST(ClientControls, ControlCLeavesAndControlZSuspendsAlways) {
  ClientControls controls;
  EXPECT_EQ(controls.take({Z, 0, KeyEvent::Action::kPress, kControl}), Result::kSuspend);
  controls.take(kPrefix);
  controls.take(typed(T, U't'));
  EXPECT_EQ(controls.take({C, 0, KeyEvent::Action::kPress, kControl}), Result::kLeave);
}

TEST(ClientControls, ChatLineTakesText) {
  ClientControls controls;
  controls.take(kPrefix);
  EXPECT_EQ(controls.take(typed(T, U't')), Result::kOpened);
  EXPECT_TRUE(controls.chatOpen());
  for (const char32_t ch : std::u32string(U"hüx")) controls.take({UNDEFINED_KEY, ch});
  controls.take({BACKSPACE});
  controls.take({UNDEFINED_KEY, U'\x202E'});
  EXPECT_EQ(controls.chatText(), "hü");
  EXPECT_EQ(controls.take({RETURN}), Result::kSay);
  EXPECT_EQ(controls.takeChat(), "hü");
  EXPECT_FALSE(controls.chatOpen());
}

TEST(ClientControls, EmptyOrEscapedChatSaysNothing) {
  ClientControls controls;
  controls.take(kPrefix);
  controls.take(typed(C, U'c'));
  EXPECT_EQ(controls.take({RETURN}), Result::kClosed);
  controls.take(kPrefix);
  controls.take(typed(C, U'c'));
  controls.take(typed(X, U'x'));
  EXPECT_EQ(controls.take({ESCAPE}), Result::kClosed);
}

TEST(ClientControls, ChatIsBounded) {
  ClientControls controls;
  controls.take(kPrefix);
  controls.take(typed(T, U't'));
  for (int i = 0; i < 1000; ++i) controls.take(typed(X, U'x'));
  EXPECT_EQ(controls.chatText().size(), kMaxChatLength);
}

}  // namespace
}  // namespace naiad
