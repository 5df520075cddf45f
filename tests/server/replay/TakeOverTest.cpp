// A world that crashes or hangs by a key: another one takes over, without that key.
#include <gtest/gtest.h>

#include <asio/io_context.hpp>
#include <chrono>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "host/program/GameModule.h"
#include "host/program/Journals.h"
#include "host/program/Worlds.h"
#include "server/replay/RecordedRound.h"
#include "server/replay/Verify.h"
#include "tests/server/replay/Recorder.h"
#include "tests/support/Sanitizers.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;
using Input = df::InputQueue::Input;

class TakeOverTest : public testing::Test {
 protected:
  void SetUp() override {
    module = (recorder.folder() / "unsteady_frail.so").string();
    fs::copy_file(NAIAD_BINARY_DIR "/../lib/unsteady.so", module);
    HostOptions options;
    options.journal = rounds.string();
    options.seed = 1;
    options.hang_time = 0.2;
    launcher = launchAgain(options, module, NAIAD_BINARY_DIR "/dfserver", recorder.folder().string(), {});
    journals = Journals::open(options, GameModule::nameOf(module), module,
                              [this](const LogEvent& event) { log += event.text + "\n"; });
    world = startWorlds(
        launcher, [](const LogEvent& /*event*/) {}, journals)(home);
    world->setOnTick([this] { ++ended; });
    serveUntil([this] { return world->isReady(); });
    world->addInput({.kind = df::InputQueue::kJoin, .player = 1, .name = "Ann", .color = df::RED});
  }
  template <class Done>
  void serveUntil(Done done) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!done() && !world->end() && std::chrono::steady_clock::now() < end) {
      home.restart();
      home.run_one_for(std::chrono::milliseconds(10));
      world->checkProcess(1);
    }
  }
  void press(df::Keyboard::Key key) {
    Input input{.kind = df::InputQueue::kKey, .player = 1};
    input.key = key;
    input.key_action = df::KEY_PRESSED;
    world->addInput(input);
  }
  /// True: it has ended.
  bool tick() {
    const int before = ended;
    world->tick(true, false);
    serveUntil([&] { return ended > before && world->isReady(); });
    return ended == before + 1;
  }
  void play(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      if (i % 3 == 0) press(df::Keyboard::A);
      ASSERT_TRUE(tick()) << log;
    }
  }
  std::string verify() {
    world.reset();
    journals.reset();  // writes what is left
    const fs::path file = fs::directory_iterator(rounds)->path();
    const RecordedRound round(file);
    const RoundStage stage(round, module);
    std::ostringstream out;
    return verifyRound(round, stage, out) ? "" : out.str();
  }

  Recorder recorder;
  fs::path rounds = recorder.folder() / "rounds";
  std::string module;
  std::string log;
  asio::io_context home;
  std::shared_ptr<const WorldLauncher> launcher;
  std::shared_ptr<Journals> journals;
  std::unique_ptr<WorldPort> world;
  int ended = 0;
};

TEST_F(TakeOverTest, AWorldThatCrashesByAKeyGoesOnWithoutIt) {
  play(100);
  const std::uint32_t next = world->nextTick();
  press(df::Keyboard::Q);
  world->addInput({.kind = df::InputQueue::kJoin, .player = 2, .name = "Bob", .color = df::BLUE});
  ASSERT_TRUE(tick()) << log;
  EXPECT_EQ(world->nextTick(), next + 1) << "its players notice nothing but a pause";
  EXPECT_EQ(world->view().players.size(), 2u) << "who joined in that tick is there";
  // A sanitizer takes the signal, and ends the process.
  const std::string how = test::kSanitized ? "ended with code" : "crashed (SIGSEGV)";
  EXPECT_NE(log.find("the game " + how), std::string::npos) << log;
  EXPECT_NE(log.find("another world takes over"), std::string::npos) << log;
  play(60);
  EXPECT_EQ(verify(), "");
}

TEST_F(TakeOverTest, WhatPlayersDoMeanwhileIsInTheNextTick) {
  play(50);
  press(df::Keyboard::Q);
  world->tick(true, false);
  serveUntil([this] { return log.find("takes over") != std::string::npos; });
  ASSERT_FALSE(world->isReady());
  EXPECT_FALSE(world->recovering()) << "and new players may join";
  EXPECT_EQ(world->addInput({.kind = df::InputQueue::kJoin, .player = 2, .name = "Bob", .color = df::BLUE}),
            2u);
  serveUntil([this] { return world->isReady(); });
  ASSERT_TRUE(tick());
  EXPECT_EQ(world->view().players.size(), 2u);
  EXPECT_EQ(verify(), "");
}

TEST_F(TakeOverTest, ASecondDeathAtTheSamePlaceEndsTheRound) {
  play(50);
  press(df::Keyboard::Q);
  ASSERT_TRUE(tick()) << log;
  play(5);
  press(df::Keyboard::Q);
  EXPECT_FALSE(tick());
  ASSERT_TRUE(world->end());
  EXPECT_EQ(world->end()->why, WorldEnd::kCrashed);
  EXPECT_NE(log.find(" again; the round is kept in "), std::string::npos) << log;
  EXPECT_EQ(verify(), "");
}

TEST_F(TakeOverTest, ALaterDeathIsAnotherOne) {
  for (int death = 0; death < 3; ++death) {
    play(static_cast<int>(JournaledWorld::kSameDeath) + 10);
    press(df::Keyboard::Q);
    ASSERT_TRUE(tick()) << death << ": " << log;
  }
  play(10);
  EXPECT_EQ(verify(), "");
}

TEST_F(TakeOverTest, AWorldThatHangsByAKeyGoesOnWithoutIt) {
  play(50);
  press(df::Keyboard::H);
  ASSERT_TRUE(tick()) << log;
  EXPECT_NE(log.find("did not answer any more"), std::string::npos) << log;
  play(20);
  EXPECT_EQ(verify(), "");
}

}  // namespace
}  // namespace naiad
