#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "EventStep.h"
#include "Music.h"
#include "Probe.h"
#include "ResourceManager.h"
#include "Sound.h"

namespace df::test {
namespace {

using SoundTest = WorldTest;

// What a sound file holds is not looked at.
const std::string kFile = std::string(NAIAD_SOURCE_DIR) + "/tests/server/engine/sprites/simple.txt";

TEST_F(SoundTest, ExistingFilesAreLoadedAndMissingOnesAreLogged) {
  EXPECT_EQ(RM.loadSound(kFile, "fire"), 0);
  EXPECT_EQ(RM.loadMusic(kFile, "theme"), 0);
  EXPECT_EQ(RM.getSound("fire")->getLabel(), "fire");
  EXPECT_EQ(RM.getMusic("theme")->getLabel(), "theme");
  EXPECT_EQ(RM.loadSound("sounds/ghost.wav", "ghost"), -1);
  EXPECT_EQ(RM.loadMusic("sounds/ghost.ogg", "ghost"), -1);
  EXPECT_EQ(RM.getSound("ghost"), nullptr);
  EXPECT_EQ(RM.getMusic("ghost"), nullptr);
  EXPECT_EQ(logged("sounds/ghost.wav: cannot be read"), 1);
  EXPECT_EQ(logged("sounds/ghost.ogg: cannot be read"), 1);
  EXPECT_EQ(RM.unloadSound("fire"), 0);
  EXPECT_EQ(RM.unloadSound("fire"), -1);
  EXPECT_EQ(RM.unloadMusic("theme"), 0);
}

TEST_F(SoundTest, WhatIsPlayedInATickIsInItsView) {
  RM.loadSound(kFile, "fire");
  RM.loadMusic(kFile, "theme");
  world.setWatched(true);
  Probe probe;
  probe.registerInterest(STEP_EVENT);
  probe.on_event = [](Probe&, const Event&) {
    RM.getSound("fire")->play();
    RM.getMusic("theme")->play();
    RM.getMusic("theme")->pause();
  };
  world.tick();
  const std::vector<SoundPlayed> expected{{"fire", SoundPlayed::kPlay, false, false, 0},
                                          {"theme", SoundPlayed::kPlay, true, true, 0},
                                          {"theme", SoundPlayed::kPause, true, false, 0}};
  EXPECT_EQ(world.view().sounds, expected);
  probe.on_event = nullptr;
  world.tick();
  EXPECT_TRUE(world.view().sounds.empty());
}

TEST_F(SoundTest, AKeysSoundNamesItsPlayer) {
  RM.loadSound(kFile, "fire");
  world.setWatched(true);
  const std::uint32_t player = world.join("ann", RED);
  world.tick();
  Probe probe;
  probe.registerInterest("df-keyboard");
  probe.on_event = [](Probe&, const Event&) { RM.getSound("fire")->play(true); };
  world.key(player, Keyboard::SPACE, KEY_PRESSED);
  world.tick();
  ASSERT_EQ(world.view().sounds.size(), 1u);
  EXPECT_EQ(world.view().sounds[0].player, player);
  EXPECT_TRUE(world.view().sounds[0].loop);
}

}  // namespace
}  // namespace df::test
