// Replayed rounds: all shipped games replay identically. For games that do not, the first tick that differs
// is found.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "host/rounds/RoundJournals.h"
#include "host/settings/GameModule.h"
#include "host/world/FixedAddresses.h"
#include "server/replay/Replay.h"
#include "server/replay/RoundPlayer.h"
#include "server/replay/Verify.h"
#include "tests/server/replay/Recorder.h"
#include "tests/support/Sanitizers.h"
#include "tests/support/Text.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;

/// Copies the module unsteady.so to a name with `way`, which selects how it differs in each run.
std::string unsteady(const fs::path& folder, const std::string& way) {
  const fs::path module = folder / ("unsteady_" + way + ".so");
  if (!fs::exists(module)) fs::copy_file(NAIAD_BINARY_DIR "/../lib/unsteady.so", module);
  return module.string();
}

/// Returns whether the round replays identically, and what is said about it.
std::pair<bool, std::string> verify(const fs::path& file, const std::string& game) {
  std::ostringstream out;
  const RecordedRound round(file);
  const ReplayEnvironment stage(round, game);
  const bool same = verifyRound(round, stage, out);
  return {same, out.str()};
}

class ShippedGameTest : public testing::TestWithParam<std::string> {};

TEST_P(ShippedGameTest, ThreeRoundsReplayIdentically) {
  if (test::kSanitized) GTEST_SKIP() << "what is promised is of the product";
  Recorder recorder;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const fs::path file = recorder.record({.game = GetParam(), .seed = seed, .ticks = 700});
    const auto [same, text] = verify(file, "");
    EXPECT_TRUE(same) << "seed " << seed << ": " << text;
    EXPECT_TRUE(test::has(text, "verified ticks="));
    EXPECT_FALSE(test::has(text, "is not the recorded one"));
  }
}

INSTANTIATE_TEST_SUITE_P(Games, ShippedGameTest, testing::ValuesIn(GameModule::available()),
                         [](const auto& test) { return test.param; });

class UnsteadyGameTest : public testing::TestWithParam<std::string> {};

TEST_P(UnsteadyGameTest, DifferenceIsFoundAtItsTick) {
  Recorder recorder;
  const std::string module = unsteady(recorder.folder(), GetParam());
  const fs::path file_for_it = module + ".txt";
  std::ofstream(file_for_it) << 1;
  const fs::path file = recorder.record({.game = module, .ticks = 400, .players = 1});
  std::ofstream(file_for_it) << 2;
  const RecordedRound round(file);
  const ReplayEnvironment stage(round, module);
  Replay replay(round, stage);
  while (replay.firstDifference() == 0 && replay.step()) continue;
  // The check of a tick has eight bits, so it misses one of 256 differences.
  EXPECT_GE(replay.firstDifference(), 47u);
  EXPECT_LE(replay.firstDifference(), 49u);
  std::ostringstream out;
  EXPECT_FALSE(verifyRound(round, stage, out));
  EXPECT_TRUE(test::has(out.str(), "tick 4"));
  EXPECT_TRUE(test::has(out.str(), "row  1"));
  EXPECT_TRUE(test::has(out.str(), "recorded |"));
  EXPECT_TRUE(test::has(out.str(), "replayed |"));
}

INSTANTIATE_TEST_SUITE_P(Ways, UnsteadyGameTest,
                         testing::Values("instruction", "entropy", "clock", "thread", "file"),
                         [](const auto& test) { return test.param; });

class CuredGameTest : public testing::TestWithParam<std::string> {};

TEST_P(CuredGameTest, ReplaysIdentically) {
  if (GetParam() == "pointers" && !canDisableAslr()) GTEST_SKIP() << "addresses cannot be fixed here";
  Recorder recorder;
  const std::string module = unsteady(recorder.folder(), GetParam());
  const fs::path file = recorder.record({.game = module, .ticks = 100, .players = 1});
  const auto [same, text] = verify(file, module);
  EXPECT_TRUE(same) << text;
}

INSTANTIATE_TEST_SUITE_P(Ways, CuredGameTest, testing::Values("time", "device", "pointers"),
                         [](const auto& test) { return test.param; });

TEST(VerifyTest, RoundsOfOneSeedHaveDifferentClocks) {
  Recorder recorder;
  const std::string module = unsteady(recorder.folder(), "time");
  const auto state = [](const fs::path& file) {
    const RecordedRound round(file);
    const auto reader = round.read();
    std::optional<std::uint64_t> hash;
    while (const auto record = reader->next()) {
      if (const auto* p_result = std::get_if<TickResult>(&*record);
          p_result != nullptr && p_result->state_hash)
        hash = p_result->state_hash;
    }
    return hash;
  };
  const auto first = state(recorder.record({.game = module, .ticks = 60, .players = 1}));
  fs::remove_all(recorder.folder() / "seed-1");
  const auto second = state(recorder.record({.game = module, .ticks = 60, .players = 1}));
  ASSERT_TRUE(first && second);
  EXPECT_NE(*first, *second);
}

class RoundTest : public testing::Test {
 protected:
  Recorder recorder;
  fs::path file = recorder.record({.game = "saucershoot", .ticks = 400});
};

TEST_F(RoundTest, InputsArePrinted) {
  std::ostringstream out;
  printInputs(RecordedRound(file), out);
  EXPECT_EQ(out.str().find("tick=1 player=1 joins name=\"bot1\""), 0u) << out.str().substr(0, 200);
  EXPECT_TRUE(test::has(out.str(), "key="));
  EXPECT_TRUE(test::has(out.str(), "ticks=400 read to its end: the game stopped"));
}

TEST_F(RoundTest, FactsNameTheGameAndNoLocalPath) {
  const RecordedRound round(file);
  EXPECT_EQ(round.fact(kFactGame), "saucershoot");
  EXPECT_EQ(round.fact(kFactModule).size(), 64u);
  bool has_sprite = false;
  for (const auto& [name, value] : round.facts()) {
    EXPECT_FALSE(test::has(name, recorder.folder().string()));
    EXPECT_FALSE(test::has(value, recorder.folder().string()));
    has_sprite = has_sprite || name.starts_with("file sprites/");
  }
  EXPECT_TRUE(has_sprite) << "files that it read are noted";
}

TEST_F(RoundTest, TruncatedFileStillVerifies) {
  fs::resize_file(file, fs::file_size(file) - 100);
  const auto [same, text] = verify(file, "");
  EXPECT_TRUE(same) << text;
  EXPECT_TRUE(test::has(text, "a truncated file"));
}

TEST_F(RoundTest, AnotherGameOfThatNameIsRefused) {
  const std::string bytes = test::contentOf(file);
  // The facts appear again with another hash; later facts replace earlier ones.
  const fs::path other = recorder.folder() / "other.dfr";
  DfrFacts facts = RecordedRound(file).facts();
  facts[kFactModule] = std::string(64, '0');
  std::ofstream(other, std::ios::binary) << bytes.substr(0, kDfrHeaderSize) << encodeDfrMeta(facts);
  const RecordedRound round(other);
  try {
    const ReplayEnvironment stage(round, "");
    FAIL() << "it was taken";
  } catch (const RoundError& error) {
    EXPECT_TRUE(test::has(std::string(error.what()), "differs from the recorded version"));
  }
}

TEST_F(RoundTest, AFileThatNamesAPathLoadsNothing) {
  const std::string path = unsteady(recorder.folder(), "time");
  for (const std::string& name :
       {path, std::string("../games/hello"), std::string("."), std::string("a/b")}) {
    const fs::path other = recorder.folder() / "other.dfr";
    std::ofstream(other, std::ios::binary)
        << encodeDfrHeader({}) << encodeDfrMeta({{kFactGame, name}, {kFactModule, hashOfModule(path)}});
    const RecordedRound round(other);
    EXPECT_THROW(ReplayEnvironment(round, ""), RoundError) << name;
  }
}

TEST_F(RoundTest, ReplaySeeksForwardAndBackward) {
  const RecordedRound round(file);
  const ReplayEnvironment stage(round, "");
  FrameHistory reel(round, stage);
  EXPECT_EQ(reel.count(), 400u);
  const auto textAt = [&reel](std::uint32_t tick) {
    EXPECT_EQ(reel.seek(tick), tick);
    return reel.pictures().empty() ? std::string() : reel.pictures()[0].canvas.text();
  };
  const std::string at_50 = textAt(50);
  const std::string at_390 = textAt(390);
  EXPECT_NE(at_50, at_390);
  EXPECT_NE(at_50, "");
  EXPECT_EQ(textAt(300), textAt(300));
  EXPECT_EQ(textAt(50), at_50) << "far back, by executing it again";
  EXPECT_EQ(textAt(390), at_390);
  EXPECT_EQ(reel.seek(5000), 400u) << "to its end";
  EXPECT_EQ(reel.firstDifference(), 0u);
}

TEST_F(RoundTest, KeysControlThePlayback) {
  using Time = RoundControls::Time;
  using std::chrono::milliseconds;
  const RecordedRound round(file);
  const ReplayEnvironment stage(round, "");
  FrameHistory reel(round, stage);
  Time now{};
  RoundControls controls(reel, round.header().frame_nanos, 0, now);
  const auto press = [&](df::Keyboard::Key key, char32_t ch = 0) {
    return controls.handleKey({.key = key, .ch = ch}, now);
  };
  const auto at = [&](milliseconds later) {
    now += later;
    controls.update(now);
    return reel.tick();
  };
  EXPECT_EQ(reel.tick(), 1u);
  EXPECT_NEAR(at(milliseconds(1000)), 31, 1);
  EXPECT_TRUE(press(df::Keyboard::SPACE, U' '));
  const std::uint32_t paused = reel.tick();
  EXPECT_EQ(at(milliseconds(1000)), paused);
  press(df::Keyboard::UNDEFINED_KEY, U'.');
  EXPECT_EQ(reel.tick(), paused + 1) << "one tick";
  press(df::Keyboard::RIGHTARROW);
  EXPECT_EQ(reel.tick(), paused + 1 + 150) << "five seconds";
  press(df::Keyboard::LEFTARROW);
  EXPECT_EQ(reel.tick(), paused + 1);
  press(df::Keyboard::SPACE, U' ');
  for (int i = 0; i < 10; ++i) press(df::Keyboard::UNDEFINED_KEY, U'-');
  EXPECT_EQ(controls.speed(), RoundControls::kMinSpeed);
  const std::uint32_t slow = reel.tick();
  EXPECT_NEAR(at(milliseconds(2000)), slow + 15, 1) << "a quarter";
  for (int i = 0; i < 20; ++i) press(df::Keyboard::UNDEFINED_KEY, U'+');
  EXPECT_EQ(controls.speed(), RoundControls::kMaxSpeed);
  EXPECT_EQ(at(milliseconds(1000)), 400u) << "64 times: to the end";
  EXPECT_TRUE(controls.isPaused());
  const ScreenBuffer picture = controls.compose(80, 25);
  EXPECT_TRUE(test::has(picture.rowText(24), "paused  0:13  tick 400 of 400  x64  player "));
  const std::uint32_t eyes = controls.player();
  press(df::Keyboard::TAB);
  EXPECT_NE(controls.player(), eyes);
  EXPECT_FALSE(press(df::Keyboard::Q, U'q'));
  RoundControls middle(reel, round.header().frame_nanos, 0, now, 100);
  EXPECT_EQ(reel.tick(), 100u);
  middle.update(now + milliseconds(1000));
  EXPECT_NEAR(reel.tick(), 131, 1);
  const RoundControls late(reel, round.header().frame_nanos, 0, now, 5000);
  EXPECT_EQ(reel.tick(), 400u) << "its last";
}

}  // namespace
}  // namespace naiad
