// Copies of a world's process (WorldCheckpoints.h): if the world crashes or hangs, a copy continues the
// round. No copy outlives the round.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "host/journal/RoundHistory.h"
#include "host/world/WorldCheckpoints.h"
#include "tests/server/replay/FrailRound.h"
#include "tests/support/Processes.h"
#include "tests/support/Sanitizers.h"
#include "tests/support/Text.h"
#include "tests/support/WaitUntil.h"

namespace naiad {
namespace {

constexpr const char* kCopy = "df-copy";
constexpr const char* kSupervisor = "df-supervisor";
constexpr const char* kWorld = "dfserver";
constexpr const char* kByCopy = "game recovered: a copy of its world replayed ";
constexpr const char* kByAnother = "game recovered: a new world replayed ";

bool isAlive(pid_t process) {
  return kill(process, 0) == 0;
}

/// Rounds shorter than DeterminismCheck::kDelay ticks have one world; longer rounds have a second world,
/// which is compared with the first.
class CopiesTest : public FrailRound {
 protected:
  void SetUp() override {
    if (test::kThreadSanitized) GTEST_SKIP() << "its runtime has a thread";
    FrailRound::SetUp();
  }
  /// Returns this process's descendants of this name, by process id, which is their starting order.
  static std::vector<pid_t> find(const std::string& name) { return test::processesBelow(getpid(), name); }
  /// Plays, and then waits until new copies have their name and sleep, which takes time on a busy machine.
  void play(int ticks) {
    FrailRound::play(ticks);
    EXPECT_TRUE(test::waitUntil(isSettled));
  }
  // A new copy has a world's name until it sets its own name. Each supervisor has one world. Worlds are
  // listed first, so that each copy is found under one of its two names.
  static bool isSettled() {
    std::set<pid_t> supervisors;
    for (const pid_t one : find(kWorld)) {
      const auto facts = test::factsOf(one);
      if (!facts || !supervisors.insert(facts->parent).second) return false;
    }
    return std::ranges::all_of(find(kCopy), [](pid_t copy) { return test::stateOf(copy) == 'S'; });
  }
  /// Plays until there is a copy. After a failover, that is not before the supervisor has ended the other
  /// processes.
  void playToACopy() {
    for (int i = 0; i < 1000 && find(kCopy).empty(); ++i) play(1);
    EXPECT_FALSE(find(kCopy).empty());
  }
  static void waitUntilGone(const std::vector<pid_t>& processes) {
    for (const pid_t one : processes)
      EXPECT_TRUE(test::waitUntil([one] { return !isAlive(one); })) << test::factsOf(one)->name;
  }
  /// Returns the processes of worlds, supervisors and copies.
  static std::vector<pid_t> findAll() {
    std::vector<pid_t> all;
    for (const char* name : {kCopy, kWorld, kSupervisor}) {
      const std::vector<pid_t> found = find(name);
      all.insert(all.end(), found.begin(), found.end());
    }
    return all;
  }
  bool logs(const std::string& text) const { return log.find(text) != std::string::npos; }
  std::size_t count(const std::string& text) const {
    return static_cast<std::size_t>(test::countIn(log, text));
  }
  /// Presses the key and checks that the world continues after a failover.
  void survive(df::Keyboard::Key key) {
    const std::uint32_t next = world->nextTick();
    press(key);
    ASSERT_TRUE(tick()) << log;
    EXPECT_EQ(world->nextTick(), next + 1);
    const auto done = world->popFailover();
    ASSERT_TRUE(done);
    EXPECT_EQ(world->popFailover().has_value(), false);
  }
};

TEST_F(CopiesTest, CheckpointReplaysTheTicksSinceItWasMade) {
  play(85);  // after 90 ticks, a slow machine makes a second copy
  EXPECT_EQ(find(kCopy).size(), 1u);
  const std::vector<pid_t> copy = find(kCopy);
  survive(df::Keyboard::Q);
  EXPECT_TRUE(logs(std::string(kByCopy) + "56 ticks in ")) << log << "31 to 86";
  EXPECT_EQ(find(kWorld), copy) << "that is the world now";
  play(60);
  EXPECT_EQ(verify(), "") << "byte for byte what it answered before";
}

TEST_F(CopiesTest, CrashInDrawIsRecoveredToo) {
  play(60);
  survive(df::Keyboard::D);
  EXPECT_TRUE(logs(kByCopy)) << log;
  play(20);
  EXPECT_EQ(verify(), "");
}

// The server waits longer at the second hang, because the game may only be slow. That hang does not end, so
// at the third one it does not wait.
TEST_F(CopiesTest, FirstHangOfARoundIsRecoveredAtOnce) {
  constexpr const char* kAtOnce = "the game did not answer within ";
  constexpr const char* kLate = "did not answer in time in tick";
  constexpr std::size_t kWaitedFor[] = {0, 1, 1};
  for (std::size_t i = 0; i < std::size(kWaitedFor); ++i) {
    play(50);
    playToACopy();
    const std::vector<pid_t> hangs = find(kWorld);
    survive(df::Keyboard::H);
    for (const pid_t one : hangs)
      EXPECT_TRUE(i > 0 || !isAlive(one)) << "two of one game would write the same files";
    EXPECT_EQ(count(kLate), kWaitedFor[i]) << log;
    EXPECT_EQ(count(kAtOnce), i + 1 - kWaitedFor[i]) << log;
  }
  EXPECT_EQ(count(kByCopy), 3u) << log;
  EXPECT_EQ(verify(), "");
}

/// With the key S, ticks take longer than the hang time, but end if the server waits.
class SlowGameTest : public CopiesTest {
 protected:
  SlowGameTest() { hang_time = 0.3; }
};

TEST_F(SlowGameTest, LosesOneKeyAndContinues) {
  play(50);
  survive(df::Keyboard::S);
  for (int i = 0; i < 2; ++i) {
    play(50);
    press(df::Keyboard::S);
    ASSERT_TRUE(tick()) << log;
    EXPECT_FALSE(world->popFailover()) << log;
  }
  EXPECT_EQ(count("; recovering it without"), 1u) << log;
  EXPECT_EQ(count("finished: from now on"), 1u) << log;
  EXPECT_EQ(verify(), "");
}

TEST_F(CopiesTest, EachCrashIsRecoveredFromANewerCheckpoint) {
  for (int death = 0; death < 3; ++death) {
    playToACopy();
    play(static_cast<int>(Round::kSameFailureTicks));
    survive(df::Keyboard::Q);
  }
  EXPECT_EQ(count(kByCopy), 3u) << log;
  play(10);
  EXPECT_EQ(verify(), "");
}

TEST_F(CopiesTest, SlowSupervisorEndsNoCheckpointOfTheNewWorld) {
  const std::vector<pid_t> supervisor = find(kSupervisor);
  ASSERT_EQ(supervisor.size(), 1u);
  constexpr std::size_t kDeaths = 8;
  for (std::size_t death = 0; death < kDeaths; ++death) {
    playToACopy();
    press(df::Keyboard::Q);
    world->tick(true, false);
    serveUntil([&] { return count("; recovering it") > death; });
    kill(supervisor.front(), SIGSTOP);
    serveUntil([this] { return world->isReady(); });
    FrailRound::play(static_cast<int>(Round::kSameFailureTicks));
    kill(supervisor.front(), SIGCONT);
  }
  EXPECT_EQ(count(kByCopy), kDeaths) << log;
  EXPECT_EQ(verify(), "");
}

TEST_F(CopiesTest, SecondCrashAtTheSamePlaceEndsAllProcesses) {
  play(60);
  survive(df::Keyboard::Q);
  play(5);
  const std::vector<pid_t> all = findAll();
  press(df::Keyboard::Q);
  EXPECT_FALSE(tick());
  ASSERT_TRUE(world->end());
  EXPECT_EQ(world->end()->why, WorldEnd::kCrashed);
  EXPECT_TRUE(test::has(log, " again; to see where: dfreplay "));
  EXPECT_EQ(verify(), "");
  waitUntilGone(all);
}

TEST_F(CopiesTest, RoundIsReplayedFromTheStartWithoutCheckpoints) {
  play(60);
  const std::vector<pid_t> copies = find(kCopy);
  EXPECT_EQ(copies.size(), 1u);
  for (const pid_t copy : copies) EXPECT_EQ(kill(copy, SIGKILL), 0);
  survive(df::Keyboard::Q);
  EXPECT_TRUE(logs(std::string(kByAnother) + "61 ticks in ")) << log;
  play(20);
  EXPECT_EQ(verify(), "");
}

// Kills the world and then the copy that takes over, while it replays its turns.
TEST_F(CopiesTest, CheckpointDyingDuringReplayIsReplacedByTheNext) {
  play(static_cast<int>(RoundHistory::kCheckpointInterval + RoundHistory::kFirstCheckpoint) + 50);
  const std::vector<pid_t> copies = find(kCopy);
  ASSERT_EQ(copies.size(), WorldCheckpoints::kMaxCheckpoints);
  kill(copies.back(), SIGSTOP);
  press(df::Keyboard::Q);
  world->tick(true, false);
  serveUntil([this] { return logs("; recovering it"); });
  kill(copies.back(), SIGKILL);
  serveUntil([this] { return world->isReady(); });
  EXPECT_TRUE(logs("a copy of the game's world crashed (SIGKILL) before")) << log;
  EXPECT_TRUE(logs(kByCopy)) << log;
  EXPECT_EQ(find(kWorld), std::vector<pid_t>{copies.front()});
  play(20);
  EXPECT_EQ(verify(), "");
}

// The copy differs in its process id, which the key P makes visible.
TEST_F(CopiesTest, CheckpointWithDifferentAnswersEndsTheRound) {
  play(50);
  press(df::Keyboard::P);
  ASSERT_TRUE(tick());
  const std::vector<pid_t> all = findAll();
  press(df::Keyboard::Q);
  EXPECT_FALSE(tick());
  EXPECT_TRUE(logs("a copy of the game's world differs in tick 51 before")) << log;
  ASSERT_TRUE(world->end());
  EXPECT_TRUE(test::has(world->end()->text, "its replay gave a different result"));
  waitUntilGone(all);
}

TEST_F(CopiesTest, PausedWorldHasNoCheckpointUntilItsNextTick) {
  play(400);
  const std::vector<pid_t> copies = find(kCopy);
  ASSERT_EQ(copies.size(), 2u);
  world->dropCheckpoints();
  waitUntilGone(copies);
  play(2);  // the world forks after an answer, so after its next answer the copy exists
  EXPECT_EQ(find(kCopy).size(), 1u);
  survive(df::Keyboard::Q);
  EXPECT_EQ(count(kByCopy), 1u) << log;
  EXPECT_EQ(verify(), "");
}

TEST_F(CopiesTest, GameWithThreadsHasNoCheckpoints) {
  play(60);
  EXPECT_EQ(find(kCopy).size(), 1u);
  press(df::Keyboard::T);
  play(static_cast<int>(RoundHistory::kCheckpointInterval));
  EXPECT_TRUE(find(kCopy).empty());
  EXPECT_EQ(count("no copies of this game's world are kept: the game has threads"), 1u) << log;
}

TEST_F(CopiesTest, NoProcessIsLeftWhenTheRoundEnds) {
  play(50);
  const std::vector<pid_t> all = findAll();
  EXPECT_EQ(all.size(), 3u);
  world.reset();
  waitUntilGone(all);
}

TEST_F(CopiesTest, NoProcessIsLeftWhenTheSupervisorIsKilled) {
  play(50);
  const std::vector<pid_t> all = findAll();
  for (const pid_t supervisor : find(kSupervisor)) kill(supervisor, SIGKILL);
  waitUntilGone(all);
  ASSERT_TRUE(tick()) << log;
  EXPECT_TRUE(logs(kByAnother)) << log;
}

TEST_F(CopiesTest, RoundSurvivesAKillOfTheWorldsProcessGroup) {
  play(50);
  for (const pid_t one : find(kWorld)) kill(-one, SIGKILL);
  serveUntil([this] { return logs("game recovered: "); });
  EXPECT_TRUE(logs("game recovered: ")) << log;
  play(10);
  EXPECT_EQ(verify(), "");
}

TEST_F(CopiesTest, PrivateWorldsHaveNoCheckpoints) {
  HostOptions options;
  options.journal = (recorder.folder() / "others").string();
  const auto order = [&] {
    return RoundJournals::open(options, "frail", module, [](const LogEvent&) {})->makeStartOptions();
  };
  EXPECT_TRUE(order().copies);
  options.players = "private";
  EXPECT_FALSE(order().copies);
}

// Also runs with the thread sanitizer, without copies.
using TakeOverTest = FrailRound;

TEST_F(TakeOverTest, CrashByAKeyIsRecoveredWithoutTheKey) {
  play(100);
  const std::uint32_t next = world->nextTick();
  press(df::Keyboard::Q);
  world->addInput({.kind = df::InputQueue::kJoin, .player = 2, .name = "Bob", .color = df::BLUE});
  ASSERT_TRUE(tick()) << log;
  EXPECT_EQ(world->nextTick(), next + 1) << "its players notice nothing but a pause";
  EXPECT_EQ(world->view().players.size(), 2u) << "who joined in that tick is there";
  // In sanitized builds, the sanitizer catches the signal and ends the process with a code.
  const std::string how = test::kSanitized ? "ended with code" : "crashed (SIGSEGV)";
  EXPECT_TRUE(test::has(log, "the game " + how));
  EXPECT_TRUE(test::has(log, "recovering it without the input of that tick"));
  play(60);
  EXPECT_EQ(verify(), "");
}

TEST_F(TakeOverTest, InputsDuringFailoverAreInTheNextTick) {
  play(50);
  press(df::Keyboard::Q);
  world->tick(true, false);
  serveUntil([this] { return log.find("; recovering it") != std::string::npos; });
  ASSERT_FALSE(world->isReady());
  EXPECT_FALSE(world->recovering()) << "and new players may join";
  world->addInput({.kind = df::InputQueue::kJoin, .player = 2, .name = "Bob", .color = df::BLUE});
  serveUntil([this] { return world->isReady(); });
  ASSERT_TRUE(tick());
  EXPECT_EQ(world->view().players.size(), 2u);
  EXPECT_EQ(verify(), "");
}

}  // namespace
}  // namespace naiad
