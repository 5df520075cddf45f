#include <gtest/gtest.h>

#include <string>

#include "client/ui/SoundIndicator.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kSelf = 3;

class SoundIndicatorTest : public testing::Test {
 protected:
  void sound(const std::string& label, std::uint32_t player = 0) {
    notes.addSound({label, SoundLine::Action::kPlay, false, false, player}, kSelf, now);
  }
  std::string note() const { return notes.shownNote(now); }

  SoundIndicator::Time now{1h};
  SoundIndicator notes{SoundMode::kBell};
};

TEST_F(SoundIndicatorTest, ANoteIsShownForAMoment) {
  EXPECT_EQ(note(), "");
  sound("fire");
  EXPECT_EQ(note(), "sound: fire");
  now += SoundIndicator::kShown - 1ms;
  EXPECT_EQ(note(), "sound: fire");
  now += 1ms;
  EXPECT_EQ(note(), "");
}

TEST_F(SoundIndicatorTest, NotesDoNotFlicker) {
  sound("fire");
  now += SoundIndicator::kMin - 1ms;
  sound("boom");
  EXPECT_EQ(note(), "sound: fire");
  now += 1ms;
  sound("boom");
  EXPECT_EQ(note(), "sound: boom");
}

TEST_F(SoundIndicatorTest, OwnSoundsReplaceSoundsOfOthers) {
  sound("theirs", 7);
  EXPECT_EQ(note(), "sound: theirs");
  sound("more of theirs", 8);
  EXPECT_EQ(note(), "sound: theirs");
  sound("mine", kSelf);
  EXPECT_EQ(note(), "sound: mine");
  sound("theirs", 7);
  EXPECT_EQ(note(), "sound: mine");
}

TEST_F(SoundIndicatorTest, TheBellRingsOnceASecondAtMost) {
  int rings = 0;
  for (int i = 0; i < 300; ++i, now += 10ms) {
    sound("fire", i % 2 == 0 ? 0 : kSelf);
    rings += notes.popBell() ? 1 : 0;
  }
  EXPECT_EQ(rings, 3);
}

TEST_F(SoundIndicatorTest, TheBellRingsNeitherForMusicNorForOthers) {
  sound("theirs", 7);
  notes.addSound({"theme", SoundLine::Action::kPlay, true, true, 0}, kSelf, now);
  notes.addSound({"fire", SoundLine::Action::kStop, false, false, 0}, kSelf, now);
  EXPECT_FALSE(notes.popBell());
  sound("mine", kSelf);
  EXPECT_TRUE(notes.popBell());
  EXPECT_FALSE(notes.popBell());
}

TEST_F(SoundIndicatorTest, StoppingASoundClearsOnlyItsOwnNote) {
  notes.addSound({"theme", SoundLine::Action::kPlay, true, true, 0}, kSelf, now);
  EXPECT_EQ(note(), "music: theme");
  notes.addSound({"fire", SoundLine::Action::kStop, false, false, 0}, kSelf, now);
  EXPECT_EQ(note(), "music: theme");
  notes.addSound({"theme", SoundLine::Action::kPause, true, false, 0}, kSelf, now);
  EXPECT_EQ(note(), "");
}

TEST(SoundMode, IsParsedByName) {
  EXPECT_EQ(soundModeFrom("bell"), SoundMode::kBell);
  EXPECT_EQ(soundModeFrom("loud"), std::nullopt);
}

}  // namespace
}  // namespace naiad
