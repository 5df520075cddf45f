#include <gtest/gtest.h>

#include "client/terminal/KeyHoldTracker.h"

namespace naiad {
namespace {

using namespace df::Keyboard;
using namespace std::chrono_literals;
using Actions = std::vector<KeyAction>;
using Time = KeyHoldTracker::Time;

const Time kStart = Time{} + 1h;
const KeyEvent kLeft{LEFTARROW};
KeyEvent released(Key key) {
  return {key, 0, KeyEvent::Action::kRelease};
}
KeyEvent repeated(Key key) {
  return {key, 0, KeyEvent::Action::kRepeat};
}

class KeyHoldTrackerTest : public testing::Test {
 protected:
  /// Holds the key from `from` on, on a keyboard with a delay of 250 ms and 30 repeats a second. Returns the
  /// time of the last repeat.
  Time hold(Key key, Time from = kStart) {
    keys.handleKey({key}, from);
    for (Time now = from; now < from + 80ms; now += 10ms) keys.expire(now);
    keys.expire(from + 80ms);
    Time now = from + 250ms;
    for (int i = 0; i < 6; ++i, now += 33ms) keys.handleKey({key}, now);
    return now - 33ms;
  }
  void expectToEndAHold(Key one, Key other) {
    keys = KeyHoldTracker();
    const Time last = hold(one);
    EXPECT_EQ(keys.handleKey({other}, last + 20ms),
              (Actions{{one, df::KEY_RELEASED}, {other, df::KEY_PRESSED}}));
    EXPECT_TRUE(keys.tick().empty()) << "no KEY_DOWN of the old direction goes against the new one";
  }

  KeyHoldTracker keys;
};

TEST_F(KeyHoldTrackerTest, TapIsPressedAndReleasedAfter80Milliseconds) {
  EXPECT_EQ(keys.handleKey(kLeft, kStart), (Actions{{LEFTARROW, df::KEY_PRESSED}}));
  EXPECT_TRUE(keys.tick().empty()) << "one byte is not a held key";
  EXPECT_EQ(keys.deadline(), kStart + 80ms);
  EXPECT_TRUE(keys.expire(kStart + 79ms).empty());
  EXPECT_EQ(keys.expire(kStart + 80ms), (Actions{{LEFTARROW, df::KEY_RELEASED}}));
  EXPECT_TRUE(keys.expire(kStart + 1s).empty());
}

TEST_F(KeyHoldTrackerTest, HeldKeyIsDownFromTheSecondRepeatOn) {
  keys.handleKey(kLeft, kStart);
  keys.expire(kStart + 80ms);
  // The keyboard's delay of half a second, then repeats every 33 ms.
  EXPECT_EQ(keys.handleKey(kLeft, kStart + 500ms), (Actions{{LEFTARROW, df::KEY_PRESSED}}));
  EXPECT_TRUE(keys.tick().empty());
  EXPECT_TRUE(keys.handleKey(kLeft, kStart + 533ms).empty());
  for (int i = 0; i < 3; ++i) EXPECT_EQ(keys.tick(), (Actions{{LEFTARROW, df::KEY_DOWN}}));
  EXPECT_TRUE(keys.expire(kStart + 612ms).empty());
  EXPECT_EQ(keys.expire(kStart + 613ms), (Actions{{LEFTARROW, df::KEY_RELEASED}}));
}

TEST_F(KeyHoldTrackerTest, LearnsASlowRepeatRate) {
  Time now = kStart;
  for (int i = 0; i < 60; ++i) keys.handleKey(kLeft, now += 75ms);
  EXPECT_GT(keys.releaseDelay(), 105ms);
  EXPECT_LT(keys.releaseDelay(), 115ms);
  EXPECT_TRUE(keys.expire(now + 100ms).empty());
  EXPECT_EQ(keys.expire(now + 115ms).size(), 1u);
}

TEST_F(KeyHoldTrackerTest, BunchedRepeatsDoNotShortenTheDelay) {
  for (int i = 0; i < 100; ++i) keys.handleKey(kLeft, kStart);
  EXPECT_EQ(keys.releaseDelay(), 80ms);
}

TEST_F(KeyHoldTrackerTest, KeysAreIndependent) {
  keys.handleKey({A}, kStart);
  keys.handleKey({B}, kStart + 50ms);
  EXPECT_EQ(keys.expire(kStart + 80ms), (Actions{{A, df::KEY_RELEASED}}));
  EXPECT_EQ(keys.expire(kStart + 130ms), (Actions{{B, df::KEY_RELEASED}}));
}

TEST_F(KeyHoldTrackerTest, AHeldKeyStaysDownWhileAnotherIsTapped) {
  // Keyboards repeat only the key pressed last, so from here on the arrow is silent, held or not.
  const Time last = hold(RIGHTARROW);
  EXPECT_EQ(keys.handleKey({SPACE}, last + 20ms), (Actions{{SPACE, df::KEY_PRESSED}}));
  EXPECT_EQ(keys.expire(last + 100ms), (Actions{{SPACE, df::KEY_RELEASED}}));
  EXPECT_EQ(keys.tick(), (Actions{{RIGHTARROW, df::KEY_DOWN}}));
  EXPECT_TRUE(keys.expire(last + 19ms + HoldRule::kCompanion).empty());
  EXPECT_EQ(keys.expire(last + 20ms + HoldRule::kCompanion), (Actions{{RIGHTARROW, df::KEY_RELEASED}}));
}

TEST_F(KeyHoldTrackerTest, SilentKeyIsReleasedDespiteOtherKeys) {
  const Time last = hold(RIGHTARROW);
  Time now = last;
  bool released = false;
  for (int i = 0; i < 30; ++i) {
    for (const KeyAction& action : keys.handleKey({SPACE}, now += 90ms))
      released |= action == KeyAction{RIGHTARROW, df::KEY_RELEASED};
    if (now > last + HoldRule::kCompanion + 200ms) {
      EXPECT_TRUE(released);
    }
  }
}

TEST_F(KeyHoldTrackerTest, SecondPressAfterAnotherKeyIsANewPress) {
  const Time last = hold(RIGHTARROW);
  keys.handleKey({SPACE}, last + 20ms);
  const KeyHoldTracker::Duration delay = keys.releaseDelay();
  EXPECT_EQ(
      keys.handleKey({RIGHTARROW}, last + 220ms),
      (Actions{{SPACE, df::KEY_RELEASED}, {RIGHTARROW, df::KEY_RELEASED}, {RIGHTARROW, df::KEY_PRESSED}}));
  EXPECT_EQ(keys.releaseDelay(), delay) << "that gap is no interval of the keyboard's";
  EXPECT_EQ(keys.expire(last + 300ms), (Actions{{RIGHTARROW, df::KEY_RELEASED}}));
}

TEST_F(KeyHoldTrackerTest, TheOppositeDirectionEndsAHold) {
  const std::pair<Key, Key> axes[] = {{LEFTARROW, RIGHTARROW}, {UPARROW, DOWNARROW}, {A, D}, {W, S}};
  for (const auto& [low, high] : axes) {
    expectToEndAHold(low, high);
    expectToEndAHold(high, low);
  }
}

TEST_F(KeyHoldTrackerTest, LearnsTheKeyboardsRepeatDelay) {
  EXPECT_EQ(keys.pause(), KeyHoldTracker::Duration{});
  hold(RIGHTARROW);
  EXPECT_EQ(keys.pause(), 250ms);
  // Quick taps do not count as the repeat delay.
  for (int i = 0; i < 5; ++i) keys.handleKey({LEFTARROW}, kStart + 2s + i * 120ms);
  EXPECT_EQ(keys.pause(), 250ms);
}

TEST_F(KeyHoldTrackerTest, RealReleasesPassThrough) {
  keys.setRealReleases(true);
  EXPECT_EQ(keys.handleKey({A}, kStart), (Actions{{A, df::KEY_PRESSED}}));
  EXPECT_EQ(keys.tick(), (Actions{{A, df::KEY_DOWN}}));
  EXPECT_TRUE(keys.handleKey(repeated(A), kStart + 400ms).empty());
  EXPECT_TRUE(keys.expire(kStart + 1h).empty()) << "nothing is guessed";
  EXPECT_EQ(keys.deadline(), Time::max());
  EXPECT_EQ(keys.handleKey(released(A), kStart + 2h), (Actions{{A, df::KEY_RELEASED}}));
  EXPECT_TRUE(keys.tick().empty());
}

TEST_F(KeyHoldTrackerTest, UndefinedKeysAndUnmatchedReleasesAreIgnored) {
  EXPECT_TRUE(keys.handleKey({UNDEFINED_KEY, U'é'}, kStart).empty());
  keys.setRealReleases(true);
  EXPECT_TRUE(keys.handleKey(released(T), kStart).empty());
}

TEST_F(KeyHoldTrackerTest, LeavesNoKeyDownWhenTheModeChanges) {
  keys.handleKey({A}, kStart);
  EXPECT_EQ(keys.setRealReleases(true), (Actions{{A, df::KEY_RELEASED}}));
  keys.handleKey({B}, kStart);
  EXPECT_EQ(keys.releaseAll(), (Actions{{B, df::KEY_RELEASED}}));
  EXPECT_TRUE(keys.releaseAll().empty());
}

TEST_F(KeyHoldTrackerTest, NumberOfHeldKeysIsBounded) {
  keys.setRealReleases(true);
  for (int k = A; k <= Z; ++k) keys.handleKey({static_cast<Key>(k)}, kStart);
  EXPECT_EQ(keys.tick().size(), KeyHoldTracker::kMaxHeld);
}

}  // namespace
}  // namespace naiad
