#include <gtest/gtest.h>

#include "client/ui/ClientControls.h"
#include "shared/net/base/Limits.h"
#include "shared/values/Canvas.h"

namespace naiad {
namespace {

using namespace df::Keyboard;
using Result = ClientControls::Result;

const KeyEvent kPrefix{RIGHTBRACKET, 0, KeyEvent::Action::kPress, kControl};
KeyEvent typed(Key key, char32_t ch) {
  return {key, ch};
}

class ClientControlsTest : public testing::Test {
 protected:
  /// Types the prefix key and this key.
  Result command(Key key, char32_t ch) {
    controls.handleKey(kPrefix);
    return controls.handleKey(typed(key, ch));
  }

  ClientControls controls;
};

TEST_F(ClientControlsTest, OrdinaryKeysGoToTheGame) {
  EXPECT_EQ(controls.handleKey(typed(Q, U'q')), Result::kGame);
  EXPECT_EQ(controls.handleKey({ESCAPE}), Result::kGame);
  EXPECT_EQ(controls.handleKey(typed(RIGHTBRACKET, U']')), Result::kGame);
}

TEST_F(ClientControlsTest, PrefixOpensCommands) {
  EXPECT_EQ(controls.handleKey(kPrefix), Result::kHandled);
  EXPECT_TRUE(controls.prefixed());
  EXPECT_EQ(controls.handleKey(typed(P, U'p')), Result::kHandled);
  EXPECT_FALSE(controls.prefixed());
  EXPECT_EQ(controls.panel(), Panel::kPlayers);
  command(SLASH, U'?');
  EXPECT_EQ(controls.panel(), Panel::kHelp);
  command(H, U'h');
  EXPECT_EQ(controls.panel(), Panel::kNone);
  command(S, U's');
  EXPECT_EQ(controls.status(), StatusMode::kNever);
  EXPECT_EQ(command(Q, U'q'), Result::kLeave);
}

TEST_F(ClientControlsTest, MenuLetterReplacesControlG) {
  const auto opens = [this](char letter, Key key, std::uint8_t modifiers) {
    controls = ClientControls();
    controls.setMenuLetter(letter);
    controls.handleKey({key, 0, KeyEvent::Action::kPress, modifiers});
    return controls.prefixed();
  };
  EXPECT_TRUE(opens('G', G, kControl));
  EXPECT_FALSE(opens('X', G, kControl));
  EXPECT_TRUE(opens('X', X, kControl));
  EXPECT_TRUE(opens('X', RIGHTBRACKET, kControl));
  EXPECT_FALSE(opens('X', X, 0));
}

TEST_F(ClientControlsTest, StatusKeyTogglesTheStatusLine) {
  const auto press = [this] {
    command(S, U's');
    return controls.status();
  };
  EXPECT_EQ(controls.status(), StatusMode::kAuto);
  controls.onShown({.status = false});  // the status line has no space, and its time is over
  EXPECT_EQ(press(), StatusMode::kAlways);
  controls.onShown({.status = true});
  EXPECT_EQ(press(), StatusMode::kNever);
}

TEST_F(ClientControlsTest, KeysScrollAPanelThatDoesNotFit) {
  EXPECT_EQ(controls.handleKey({DOWNARROW}), Result::kGame);
  command(H, U'h');
  controls.onShown({.status = true, .max_scroll = 0, .page = 20});
  EXPECT_EQ(controls.handleKey({DOWNARROW}), Result::kGame) << "all of it is seen";
  controls.onShown({.status = true, .max_scroll = 30, .page = 20});
  EXPECT_EQ(controls.handleKey({UPARROW}), Result::kHandled);
  EXPECT_EQ(controls.scroll(), 0);
  EXPECT_EQ(controls.handleKey({DOWNARROW}), Result::kHandled);
  EXPECT_EQ(controls.scroll(), 1);
  controls.handleKey({PAGEDOWN});
  EXPECT_EQ(controls.scroll(), 20);
  controls.handleKey({PAGEDOWN});
  EXPECT_EQ(controls.scroll(), 30);
  controls.handleKey({PAGEUP});
  EXPECT_EQ(controls.scroll(), 11);
  controls.handleKey({END});
  EXPECT_EQ(controls.scroll(), 30);
  controls.handleKey({HOME});
  EXPECT_EQ(controls.scroll(), 0);
  EXPECT_EQ(controls.handleKey(typed(A, U'a')), Result::kGame);
  EXPECT_EQ(controls.handleKey({ESCAPE}), Result::kHandled);
  EXPECT_EQ(controls.handleKey({DOWNARROW}), Result::kGame);
}

TEST_F(ClientControlsTest, ArrowsChooseARoomAndReturnEntersIt) {
  EXPECT_EQ(command(R, U'r'), Result::kHandled);
  EXPECT_EQ(controls.panel(), Panel::kRooms);
  controls.onShown({.rooms = 3});
  EXPECT_EQ(controls.handleKey({UPARROW}), Result::kHandled);
  EXPECT_EQ(controls.roomChoice(), 0);
  for (int i = 0; i < 5; ++i) controls.handleKey({DOWNARROW});
  EXPECT_EQ(controls.roomChoice(), 2);
  EXPECT_EQ(controls.handleKey(typed(A, U'a')), Result::kGame);
  EXPECT_EQ(controls.handleKey({RETURN}), Result::kEnterRoom);
  EXPECT_EQ(controls.panel(), Panel::kNone);
  EXPECT_EQ(controls.handleKey({RETURN}), Result::kGame);
}

TEST_F(ClientControlsTest, ReturnClosesAnEmptyRoomList) {
  command(R, U'r');
  controls.onShown({.rooms = 0});
  EXPECT_EQ(controls.handleKey({RETURN}), Result::kHandled);
  EXPECT_EQ(controls.panel(), Panel::kNone);
}

TEST_F(ClientControlsTest, PastedTextGoesIntoAnOpenChatLineOnly) {
  EXPECT_FALSE(controls.insertPasted(U"secret"));
  command(T, U't');
  EXPECT_EQ(controls.chatText(), "");
  controls.handleKey(typed(X, U'x'));
  EXPECT_TRUE(controls.insertPasted(U"y\x202Ez ü"));
  EXPECT_EQ(controls.chatText(), "xyz ü");
  controls.insertPasted(std::u32string(1000, U'n'));
  controls.handleKey(typed(X, U'x'));
  EXPECT_EQ(df::decodeUtf8(controls.chatText()).size(), kMaxChatLength);
  EXPECT_TRUE(controls.isChatOpen()) << "it sends nothing";
}

TEST_F(ClientControlsTest, ChatLineTellsWhenItOmitsCharacters) {
  command(T, U't');
  for (const char32_t ch : std::u32string(U"aäжλ")) controls.handleKey({UNDEFINED_KEY, ch});
  EXPECT_FALSE(controls.hasOmittedText());
  controls.handleKey({UNDEFINED_KEY, U'李'});
  EXPECT_TRUE(controls.hasOmittedText());
  controls.handleKey({ESCAPE});
  EXPECT_FALSE(controls.hasOmittedText());
  command(T, U't');
  EXPECT_FALSE(controls.hasOmittedText());
  controls.insertPasted(U"سلام");
  EXPECT_TRUE(controls.hasOmittedText());
  controls.setChatText("gone");
  EXPECT_FALSE(controls.hasOmittedText());
  EXPECT_EQ(controls.chatText(), "gone");
}

TEST_F(ClientControlsTest, PrefixTwiceClosesEverything) {
  command(P, U'p');
  controls.handleKey(kPrefix);
  EXPECT_EQ(controls.handleKey(kPrefix), Result::kHandled);
  EXPECT_FALSE(controls.prefixed());
  EXPECT_EQ(controls.panel(), Panel::kNone);
}

TEST_F(ClientControlsTest, ModifiersAndRepeatsDoNotEndThePrefix) {
  controls.handleKey(kPrefix);
  controls.handleKey({RIGHTBRACKET, 0, KeyEvent::Action::kRepeat, kControl});
  controls.handleKey({RIGHTBRACKET, 0, KeyEvent::Action::kRelease, kControl});
  controls.handleKey({LEFTSHIFT, 0, KeyEvent::Action::kPress, kShift});
  EXPECT_TRUE(controls.prefixed());
  controls.handleKey(typed(SLASH, U'?'));
  EXPECT_EQ(controls.panel(), Panel::kHelp);
}

TEST_F(ClientControlsTest, ControlCLeavesAndControlZSuspendsAlways) {
  EXPECT_EQ(controls.handleKey({Z, 0, KeyEvent::Action::kPress, kControl}), Result::kSuspend);
  command(T, U't');
  EXPECT_EQ(controls.handleKey({C, 0, KeyEvent::Action::kPress, kControl}), Result::kLeave);
}

TEST_F(ClientControlsTest, ChatLineTakesText) {
  EXPECT_EQ(command(T, U't'), Result::kOpened);
  EXPECT_TRUE(controls.isChatOpen());
  for (const char32_t ch : std::u32string(U"hüx")) controls.handleKey({UNDEFINED_KEY, ch});
  controls.handleKey({BACKSPACE});
  controls.handleKey({UNDEFINED_KEY, U'\x202E'});
  EXPECT_EQ(controls.chatText(), "hü");
  EXPECT_EQ(controls.handleKey({RETURN}), Result::kSendChat);
  EXPECT_EQ(controls.popChat(), "hü");
  EXPECT_FALSE(controls.isChatOpen());
}

TEST_F(ClientControlsTest, EmptyOrCancelledChatSendsNothing) {
  command(C, U'c');
  EXPECT_EQ(controls.handleKey({RETURN}), Result::kClosed);
  command(C, U'c');
  controls.handleKey(typed(X, U'x'));
  EXPECT_EQ(controls.handleKey({ESCAPE}), Result::kClosed);
}

TEST_F(ClientControlsTest, KeysScrollTheChatWhileItsLineIsOpen) {
  controls.onShown({.max_chat_scroll = 20, .chat_page = 6});
  EXPECT_EQ(controls.handleKey({UPARROW}), Result::kGame);
  command(T, U't');
  EXPECT_EQ(controls.handleKey({UPARROW}), Result::kHandled);
  EXPECT_EQ(controls.chatScroll(), 1);
  controls.handleKey({PAGEUP});
  EXPECT_EQ(controls.chatScroll(), 6);
  for (int i = 0; i < 9; ++i) controls.handleKey({PAGEUP});
  EXPECT_EQ(controls.chatScroll(), 20);
  controls.handleKey({DOWNARROW});
  EXPECT_EQ(controls.chatScroll(), 19);
  for (int i = 0; i < 9; ++i) controls.handleKey({PAGEDOWN});
  EXPECT_EQ(controls.chatScroll(), 0);
  controls.handleKey({UPARROW});
  controls.handleKey({ESCAPE});
  EXPECT_EQ(controls.chatScroll(), 0) << "the newest again";
}

}  // namespace
}  // namespace naiad
