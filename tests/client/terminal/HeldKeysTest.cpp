#include <gtest/gtest.h>

#include "client/terminal/HeldKeys.h"

namespace naiad {
namespace {

using namespace df::Keyboard;
using namespace std::chrono_literals;
using Actions = std::vector<KeyAction>;
using Time = HeldKeys::Time;

const Time kStart = Time{} + 1h;
const KeyEvent kLeft{LEFTARROW};
KeyEvent released(Key key) {
  return {key, 0, KeyEvent::Action::kRelease};
}
KeyEvent repeated(Key key) {
  return {key, 0, KeyEvent::Action::kRepeat};
}

TEST(HeldKeys, TapIsPressedAndReleasedAfter80Milliseconds) {
  HeldKeys keys;
  EXPECT_EQ(keys.takeKey(kLeft, kStart), (Actions{{LEFTARROW, df::KEY_PRESSED}}));
  EXPECT_TRUE(keys.tick().empty()) << "one byte is not a held key";
  EXPECT_EQ(keys.deadline(), kStart + 80ms);
  EXPECT_TRUE(keys.expire(kStart + 79ms).empty());
  EXPECT_EQ(keys.expire(kStart + 80ms), (Actions{{LEFTARROW, df::KEY_RELEASED}}));
  EXPECT_TRUE(keys.expire(kStart + 1s).empty());
}

TEST(HeldKeys, HeldKeyIsDownFromTheSecondRepeatOn) {
  HeldKeys keys;
  keys.takeKey(kLeft, kStart);
  keys.expire(kStart + 80ms);
  // The keyboard's pause of half a second, then repeats every 33 ms.
  EXPECT_EQ(keys.takeKey(kLeft, kStart + 500ms), (Actions{{LEFTARROW, df::KEY_PRESSED}}));
  EXPECT_TRUE(keys.tick().empty());
  EXPECT_TRUE(keys.takeKey(kLeft, kStart + 533ms).empty());
  for (int i = 0; i < 3; ++i) EXPECT_EQ(keys.tick(), (Actions{{LEFTARROW, df::KEY_DOWN}}));
  EXPECT_TRUE(keys.expire(kStart + 612ms).empty());
  EXPECT_EQ(keys.expire(kStart + 613ms), (Actions{{LEFTARROW, df::KEY_RELEASED}}));
}

TEST(HeldKeys, LearnsASlowRepeatRate) {
  HeldKeys keys;
  Time now = kStart;
  for (int i = 0; i < 60; ++i) keys.takeKey(kLeft, now += 75ms);
  EXPECT_GT(keys.releaseDelay(), 105ms);
  EXPECT_LT(keys.releaseDelay(), 115ms);
  EXPECT_TRUE(keys.expire(now + 100ms).empty());
  EXPECT_EQ(keys.expire(now + 115ms).size(), 1u);
}

TEST(HeldKeys, BunchedRepeatsDoNotShortenTheDelay) {
  HeldKeys keys;
  for (int i = 0; i < 100; ++i) keys.takeKey(kLeft, kStart);
  EXPECT_EQ(keys.releaseDelay(), 80ms);
}

TEST(HeldKeys, KeysAreIndependent) {
  HeldKeys keys;
  keys.takeKey({A}, kStart);
  keys.takeKey({B}, kStart + 50ms);
  EXPECT_EQ(keys.expire(kStart + 80ms), (Actions{{A, df::KEY_RELEASED}}));
  EXPECT_EQ(keys.expire(kStart + 130ms), (Actions{{B, df::KEY_RELEASED}}));
}

TEST(HeldKeys, RealReleasesPassThrough) {
  HeldKeys keys;
  keys.setRealReleases(true);
  EXPECT_EQ(keys.takeKey({A}, kStart), (Actions{{A, df::KEY_PRESSED}}));
  EXPECT_EQ(keys.tick(), (Actions{{A, df::KEY_DOWN}}));
  EXPECT_TRUE(keys.takeKey(repeated(A), kStart + 400ms).empty());
  EXPECT_TRUE(keys.expire(kStart + 1h).empty()) << "nothing is guessed";
  EXPECT_EQ(keys.deadline(), Time::max());
  EXPECT_EQ(keys.takeKey(released(A), kStart + 2h), (Actions{{A, df::KEY_RELEASED}}));
  EXPECT_TRUE(keys.tick().empty());
}

TEST(HeldKeys, ReleaseOfAKeyThatWasNotDownIsIgnored) {
  HeldKeys keys;
  keys.setRealReleases(true);
  EXPECT_TRUE(keys.takeKey(released(T), kStart).empty());
}

TEST(HeldKeys, LeavesNoKeyDownWhenTheModeChanges) {
  HeldKeys keys;
  keys.takeKey({A}, kStart);
  EXPECT_EQ(keys.setRealReleases(true), (Actions{{A, df::KEY_RELEASED}}));
  keys.takeKey({B}, kStart);
  EXPECT_EQ(keys.releaseAll(), (Actions{{B, df::KEY_RELEASED}}));
  EXPECT_TRUE(keys.releaseAll().empty());
}

TEST(HeldKeys, NumberOfHeldKeysIsBounded) {
  HeldKeys keys;
  keys.setRealReleases(true);
  for (int k = A; k <= Z; ++k) keys.takeKey({static_cast<Key>(k)}, kStart);
  EXPECT_EQ(keys.tick().size(), HeldKeys::kMaxHeld);
}

TEST(HeldKeys, CharactersWithoutAKeyAreIgnored) {
  HeldKeys keys;
  EXPECT_TRUE(keys.takeKey({UNDEFINED_KEY, U'é'}, kStart).empty());
}

}  // namespace
}  // namespace naiad
