// A round, as dfserver plays it, of a game that crashes by the key Q and hangs by H: a world in a process of
// its own, with a journal.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <sstream>
#include <string>

#include "host/rounds/RoundJournals.h"
#include "host/rounds/WorldFactory.h"
#include "host/settings/GameModule.h"
#include "server/replay/RecordedRound.h"
#include "server/replay/Verify.h"
#include "tests/server/replay/Recorder.h"
#include "tests/support/Sanitizers.h"

namespace naiad {

class FrailRound : public testing::Test {
 protected:
  void SetUp() override {
    module = (recorder.folder() / "unsteady_frail.so").string();
    std::filesystem::copy_file(NAIAD_BINARY_DIR "/../lib/unsteady.so", module);
    HostOptions options;
    options.journal = rounds.string();
    options.seed = 1;
    options.hang_time = hang_time;
    launcher = launchReplay(options, module, NAIAD_BINARY_DIR "/dfserver", recorder.folder().string(), {});
    journals = RoundJournals::open(options, GameModule::nameOf(module), module,
                                   [this](const LogEvent& event) { log += event.text + "\n"; });
    world = startWorlds(
        launcher, [](const LogEvent& /*event*/) {}, journals)(home);
    world->setOnTick([this] { ++ended; });
    serveUntil([this] { return world->isReady(); });
    world->addInput({.kind = df::InputQueue::kJoin, .player = 1, .name = "Ann", .color = df::RED});
  }
  template <class Done>
  void serveUntil(Done done) {
    serveRound(home, *world, done);
  }
  void press(df::Keyboard::Key key) {
    df::InputQueue::Input input{.kind = df::InputQueue::kKey, .player = 1};
    input.key = key;
    input.key_action = df::KEY_PRESSED;
    world->addInput(input);
  }
  /// Plays a tick. Returns true if the tick has ended.
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
  /// Ends the round. Returns its file.
  std::filesystem::path endRound() {
    world.reset();
    journals.reset();  // writes the remaining records
    return std::filesystem::directory_iterator(rounds)->path();
  }
  std::string verify() {
    const std::filesystem::path file = endRound();
    const RecordedRound round(file);
    const ReplayEnvironment stage(round, module);
    std::ostringstream out;
    return verifyRound(round, stage, out) ? "" : out.str();
  }

  /// Seconds without an answer after which the world counts as hung. Longer in sanitized builds, because
  /// their crash reports take time.
  double hang_time = 0.2 * test::kSlowness;
  Recorder recorder;
  std::filesystem::path rounds = recorder.folder() / "rounds";
  std::string module;
  std::string log;
  asio::io_context home;
  std::shared_ptr<const WorldLauncher> launcher;
  std::shared_ptr<RoundJournals> journals;
  std::unique_ptr<Round> world;
  int ended = 0;
};

}  // namespace naiad
