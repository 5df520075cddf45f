#include "engine/events/EventStep.h"
#include "engine/managers/ResourceManager.h"
#include "engine/world/Music.h"
#include "engine/world/Sound.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

// Any existing file will do: sound files are not parsed.
const std::string kFile = std::string(NAIAD_SOURCE_DIR) + "/tests/server/engine/sprites/simple.txt";

class SoundTest : public WorldTest {
 protected:
  SoundTest() {
    EXPECT_EQ(RM.loadSound(kFile, "fire"), 0);
    EXPECT_EQ(RM.loadMusic(kFile, "theme"), 0);
    world.store().setWatched(true);
  }
  const WorldView& view() const { return world.picture().view(); }

  Probe probe;
};

TEST_F(SoundTest, ExistingFilesAreLoadedAndMissingOnesAreLogged) {
  EXPECT_EQ(RM.getSound("fire")->getLabel(), "fire");
  EXPECT_EQ(RM.getMusic("theme")->getLabel(), "theme");
  EXPECT_EQ(RM.loadSound("sounds/ghost.wav", "ghost"), -1);
  EXPECT_EQ(RM.loadMusic("sounds/ghost.ogg", "ghost"), -1);
  EXPECT_NE(RM.getSound("ghost"), nullptr) << "one that is silent";
  EXPECT_NE(RM.getMusic("ghost"), nullptr);
  world.setCompat();
  EXPECT_EQ(RM.getSound("ghost"), nullptr);
  EXPECT_EQ(RM.getMusic("ghost"), nullptr);
  world.setCompat(false);
  EXPECT_EQ(logged("sounds/ghost.wav: cannot be read"), 1);
  EXPECT_EQ(logged("sounds/ghost.ogg: cannot be read"), 1);
  EXPECT_EQ(RM.unloadSound("fire"), 0);
  EXPECT_EQ(RM.unloadSound("fire"), -1);
  EXPECT_EQ(RM.unloadMusic("theme"), 0);
}

TEST_F(SoundTest, WithCompatMissingFilesAreSilent) {
  world.setCompat();
  EXPECT_EQ(RM.loadSound("sounds/ghost.wav", "ghost"), -1);
  EXPECT_EQ(RM.loadMusic("sounds/ghost.ogg", "ghost"), -1);
  ASSERT_NE(RM.getSound("ghost"), nullptr);
  ASSERT_NE(RM.getMusic("ghost"), nullptr);
  EXPECT_EQ(RM.getSound("ghost")->getLabel(), "ghost");
  probe.hear(STEP_EVENT, [](Probe&, const Event&) {
    RM.getSound("ghost")->play();
    RM.getMusic("ghost")->play();
    RM.getMusic("ghost")->stop();
  });
  world.tick();
  EXPECT_TRUE(view().sounds.empty());
  EXPECT_EQ(logged("Sound: sounds/ghost.wav: cannot be read"), 1);
  EXPECT_EQ(logged("Music: sounds/ghost.ogg: cannot be read"), 1);
  EXPECT_EQ(lines.size(), 2u);
  EXPECT_EQ(RM.getSound("never loaded"), nullptr) << "games test for it";
  EXPECT_EQ(RM.loadSound(kFile, "ghost"), 0) << "a second path that a game tries";
  EXPECT_EQ(RM.loadSound("sounds/ghost.wav", "ghost"), 0) << "the first sound is kept";
  world.tick();
  EXPECT_EQ(view().sounds.size(), 1u);
  probe.on_event = nullptr;
  EXPECT_EQ(RM.unloadSound("ghost"), 0);
  EXPECT_EQ(RM.unloadMusic("ghost"), 0);
  EXPECT_EQ(RM.getSound("ghost"), nullptr);
}

TEST_F(SoundTest, SoundsPlayedInATickAreInItsView) {
  probe.hear(STEP_EVENT, [](Probe&, const Event&) {
    RM.getSound("fire")->play();
    RM.getMusic("theme")->play();
    RM.getMusic("theme")->pause();
  });
  world.tick();
  const std::vector<SoundPlayed> expected{{"fire", SoundPlayed::kPlay, false, false, 0},
                                          {"theme", SoundPlayed::kPlay, true, true, 0},
                                          {"theme", SoundPlayed::kPause, true, false, 0}};
  EXPECT_EQ(view().sounds, expected);
  probe.on_event = nullptr;
  world.tick();
  EXPECT_TRUE(view().sounds.empty());
}

TEST_F(SoundTest, SoundPlayedByAKeyNamesItsPlayer) {
  const std::uint32_t player = joined("ann");
  probe.hear("df-keyboard", [](Probe&, const Event&) { RM.getSound("fire")->play(true); });
  pressedBy({player}, Keyboard::SPACE);
  ASSERT_EQ(view().sounds.size(), 1u);
  EXPECT_EQ(view().sounds[0].player, player);
  EXPECT_TRUE(view().sounds[0].loop);
}

TEST_F(SoundTest, LoopingSoundsStayInEveryViewUntilStopped) {
  RM.loadSound(kFile, "engine");
  RM.loadMusic(kFile, "engine");  // music and sounds have separate labels
  RM.getMusic("theme")->play();   // before the first tick, as games do
  RM.getSound("engine")->play();
  world.tick();
  const SoundPlayed theme{"theme", SoundPlayed::kPlay, true, true, 0};
  EXPECT_EQ(view().playing, std::vector{theme}) << "once is not again and again";
  RM.getSound("engine")->play(true);
  RM.getMusic("theme")->play();
  world.tick();
  const SoundPlayed engine{"engine", SoundPlayed::kPlay, false, true, 0};
  EXPECT_EQ(view().playing, (std::vector{engine, theme})) << "each once, from when it began";
  RM.getMusic("engine")->stop();
  world.tick();
  EXPECT_EQ(view().playing.size(), 2u);
  RM.getMusic("theme")->pause();
  RM.getSound("engine")->play(false);
  world.tick();
  EXPECT_TRUE(view().playing.empty());
}

TEST_F(SoundTest, UnloadedSoundsStop) {
  probe.hear(STEP_EVENT, [](Probe&, const Event&) {
    RM.getMusic("theme")->play();
    RM.unloadMusic("theme");
    RM.unloadSound("fire");
  });
  world.tick();
  EXPECT_TRUE(view().playing.empty());
  ASSERT_EQ(view().sounds.size(), 2u);
  EXPECT_EQ(view().sounds[1], (SoundPlayed{"theme", SoundPlayed::kStop, true, false, 0}));
}

TEST_F(SoundTest, SoundsBeyondTheLimitAreCounted) {
  probe.hear(STEP_EVENT, [](Probe&, const Event&) {
    for (int i = 0; i < 300; ++i) RM.getSound("fire")->play();
    for (int i = 0; i < 20; ++i) {
      Sound sound;
      sound.setLabel(std::to_string(i));
      sound.play(true);
    }
  });
  world.tick();
  EXPECT_EQ(view().sounds.size(), 256u);
  EXPECT_EQ(view().sounds_lost, 64u);
  ASSERT_EQ(view().playing.size(), 16u);
  EXPECT_EQ(view().playing.front().label, "4") << "the oldest made room";
  probe.on_event = nullptr;
  world.tick();
  EXPECT_EQ(view().sounds_lost, 0u);
}

}  // namespace
}  // namespace df::test
