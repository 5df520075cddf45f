// Recovery of a killed server's round: the contents of its file, and a world that resumes it.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "host/journal/DeterminismCheck.h"
#include "host/journal/JournalWriter.h"
#include "host/journal/RoundRecovery.h"
#include "host/journal/TurnRing.h"
#include "host/rounds/Round.h"
#include "tests/support/TempFolder.h"
#include "tests/support/Text.h"

namespace naiad {
namespace {

using WorldInput = df::InputQueue::Input;

WorldInput joinOf(std::uint32_t player) {
  WorldInput input{.kind = df::InputQueue::kJoin, .player = player};
  input.name = "Ann";
  input.color = df::RED;
  return input;
}

WorldInput keyOf(std::uint32_t player, df::Keyboard::Key key, df::EventKeyboardAction action) {
  WorldInput input{.kind = df::InputQueue::kKey, .player = player};
  input.key = key;
  input.key_action = action;
  return input;
}

PersistedSession sessionOf(std::uint32_t player) {
  return {.player = player,
          .muted = player == 2,
          .name = "Ann",
          .color = df::RED,
          .newest = std::string(kPersistedHashSize, static_cast<char>(player)),
          .redeemed = {}};
}

/// Answers each turn as in the recorded round.
class EchoWorld : public WorldPort {
 public:
  bool isReady() const override { return ready && !ended; }
  std::uint32_t turnsAhead() const override { return ahead; }
  void tick(const SentTurn& turn) override {
    watched.push_back(turn.turn.watched);
    turns.push_back(turn.turn.inputs);
    sent += turn.record;
    most_ahead = std::max(most_ahead, turns.size() - answered);
  }
  /// Answers the turns. A world in another process does so later, too.
  void answer() {
    while (answered < turns.size()) {
      if (answered + 1 == dies_at) {
        ended = WorldEnd{WorldEnd::kCrashed, "crashed (SIGSEGV)"};
        return;
      }
      ++answered;
      m_answer.hash = std::uint64_t{answered % 200 + 1} << 56;
      m_answer.scores = {{"arcade", {"ann", 5}, static_cast<std::uint32_t>(answered), 0}};
      reportTick();
    }
  }
  std::uint32_t nextTick() const override { return 11 + static_cast<std::uint32_t>(turns.size()); }
  const df::WorldView& view() const override { return m_view; }
  std::optional<WorldEnd> end() const override { return ended; }

  bool ready = false;
  std::uint32_t ahead = 1;
  std::size_t answered = 0;
  std::size_t most_ahead = 0;  ///< maximum of unanswered turns
  std::size_t dies_at = 0;
  std::optional<WorldEnd> ended;
  std::vector<std::vector<WorldInput>> turns;
  std::vector<bool> watched;
  std::string sent;  ///< the records of all turns

 private:
  df::WorldView m_view;
};

/// The records of a file up to the first fault.
struct Contents {
  explicit Contents(const std::string& bytes) {
    DfrReader reader(bytes);
    while (const auto record = reader.next()) {
      turns += std::holds_alternative<WorldTurn>(*record) ? 1 : 0;
      results += std::holds_alternative<TickResult>(*record) ? 1 : 0;
      if (const auto* p_turn = std::get_if<WorldTurn>(&*record)) newest_player = p_turn->input_player;
    }
    end = reader.end();
    whole_bytes = reader.bytesOfWholeRecords();
  }
  std::uint32_t turns = 0;
  std::uint32_t results = 0;
  std::uint32_t newest_player = 0;  ///< WorldTurn::input_player of the last turn
  DfrEnd end{};
  std::size_t whole_bytes = 0;
};

class RecoveryTest : public testing::Test {
 protected:
  void SetUp() override {
    path = (folder / "hello.dfr").string();
    packed = encodeDfrHeader({}) + encodeDfrMeta({{"game", "hello"}});
  }

  /// Writes a turn and EchoWorld's answer to it.
  void turn(std::vector<WorldInput> inputs, bool with_result = true) {
    WorldTurn turn;
    turn.watched = true;
    turn.inputs = std::move(inputs);
    writer.write(turn, records);
    ++count;
    if (with_result) writeResult(count);
  }
  void writeResult(std::uint32_t turn) { writeCheck(static_cast<std::uint8_t>(turn % 200 + 1)); }
  void writeCheck(std::uint8_t check) {
    TickResult result;
    result.has_check = true;
    result.check = check;
    writer.write(result, records);
  }
  void session(const PersistedSession& one) { writer.write(one, records); }
  void flush() { packed += packer.pack(std::exchange(records, {})); }
  UnfinishedRound& open() {
    flush();
    std::ofstream(path, std::ios::binary) << packed;
    return *(round = std::make_shared<UnfinishedRound>(path));
  }
  /// Writes a round of two players, the first of whom holds a key. The last turn has no result.
  void play() {
    turn({joinOf(1)});
    session(sessionOf(1));
    turn({joinOf(2), keyOf(1, df::Keyboard::A, df::KEY_PRESSED)});
    session(sessionOf(2));
    for (int i = 0; i < 50; ++i)
      turn({keyOf(2, df::Keyboard::B, i % 2 == 0 ? df::KEY_PRESSED : df::KEY_RELEASED)});
    turn({}, false);
  }
  void goOn() {
    open();
    auto echo = std::make_unique<EchoWorld>();
    p_echo = echo.get();
    Round::JournalBinding book;
    book.writer = std::make_shared<JournalWriter>();
    book.journal =
        std::make_shared<Journal>(std::make_unique<JournalFileSink>(path, round->wholeBytes()),
                                  round->header(), DfrFacts(), 1 << 20, false, round->releasePosition());
    book.recovery = std::make_unique<RoundRecovery>(round);
    book.on_recovered = [this](std::uint32_t ticks, const std::string& problem) {
      recovered = ticks;
      said = problem;
    };
    book.writer->add(book.journal);
    disk = book.writer;
    world = std::make_unique<Round>(std::move(echo), std::move(book));
    world->setOnTick([this] { ++reported; });
  }

  /// Starts the world, which then answers all turns that it gets.
  void executeAgain() {
    p_echo->ready = true;
    world->checkProcess(1);
    p_echo->answer();
  }
  /// Writes a round in whose second turn the world crashed, and replays it. The next world's recorded answer
  /// to that turn is EchoWorld's answer to turn `answered_as`.
  void crashInSecondTurn(std::uint32_t answered_as) {
    turn({joinOf(1)});
    turn({keyOf(1, df::Keyboard::A, df::KEY_PRESSED)}, false);
    writer.write(InputsDropped(), records);
    writeResult(answered_as);
    turn({});
    goOn();
    executeAgain();
  }

  const test::TempFolder folder;
  std::string path;
  std::string packed;
  std::string records;
  TurnRecordWriter writer;
  DfrTurnPacker packer;
  std::uint32_t count = 0;
  std::shared_ptr<UnfinishedRound> round;
  EchoWorld* p_echo = nullptr;
  std::shared_ptr<JournalWriter> disk;
  std::unique_ptr<Round> world;
  std::optional<std::uint32_t> recovered;
  std::string said;
  int reported = 0;
};

/// The round of play(), which a world continues.
class ContinuedRoundTest : public RecoveryTest {
 protected:
  void SetUp() override {
    RecoveryTest::SetUp();
    play();
    goOn();
  }
};

TEST_F(RecoveryTest, FileContainsPlayersSessionsAndPressedKeys) {
  play();
  session({.player = 2, .over = true});
  session(sessionOf(3));  // welcomed, but not yet known to the world
  const UnfinishedRound& found = open();
  EXPECT_FALSE(found.isOver());
  EXPECT_EQ(found.turns(), 53u);
  EXPECT_EQ(found.players(), (std::vector<std::uint32_t>{1, 2}));
  ASSERT_EQ(found.sessions().size(), 2u);
  EXPECT_EQ(found.sessions().at(1).newest, std::string(kPersistedHashSize, '\1'));
  const std::vector<WorldInput> inputs = found.closingInputs();
  ASSERT_EQ(inputs.size(), 3u);
  EXPECT_EQ(inputs[0].kind, df::InputQueue::kKey);
  EXPECT_EQ(inputs[0].player, 1u);
  EXPECT_EQ(inputs[0].key, df::Keyboard::A);
  EXPECT_EQ(inputs[0].key_action, df::KEY_RELEASED);
  EXPECT_EQ(inputs[1].kind, df::InputQueue::kLeave);
  EXPECT_EQ(inputs[1].player, 2u);
  EXPECT_EQ(inputs[2].kind, df::InputQueue::kJoin);
  EXPECT_EQ(inputs[2].player, 3u);
}

// The players of a server that was down for longer than the grace time left without a record of their
// sessions.
TEST_F(RecoveryTest, LeavingTheWorldEndsTheSession) {
  play();
  turn({{.kind = df::InputQueue::kLeave, .player = 1}});
  const UnfinishedRound& found = open();
  EXPECT_EQ(found.players(), std::vector<std::uint32_t>{2});
  ASSERT_EQ(found.sessions().size(), 1u);
  EXPECT_TRUE(found.sessions().contains(2));
}

// A file torn at any place can be opened, and its journal continues after the last complete record.
TEST_F(RecoveryTest, FileTruncatedAnywhereCanBeContinued) {
  for (int i = 0; i < 6; ++i) {
    turn({keyOf(1, df::Keyboard::A, df::KEY_PRESSED)});
    if (i % 2 == 1) packed += packer.pack(records.substr(0, records.size() - 2));  // an incomplete record
    if (i % 2 == 1) records.erase(0, records.size() - 2);
  }
  flush();
  for (std::size_t size = kDfrHeaderSize; size <= packed.size(); ++size) {
    std::ofstream(path, std::ios::binary) << packed.substr(0, size);
    UnfinishedRound torn(path);
    ASSERT_LE(torn.wholeBytes(), size);
    JournalPosition place = torn.releasePosition();
    std::string more;
    TurnRecordWriter next(torn.lastTurn());
    WorldTurn turn;
    turn.input_player = 77;
    next.write(turn, more);
    const std::string bytes = packed.substr(0, torn.wholeBytes()) + place.packer.pack(more);
    const Contents contents(bytes);
    ASSERT_EQ(contents.end, DfrEnd::kTorn) << size;
    ASSERT_EQ(contents.whole_bytes, bytes.size()) << size;
    ASSERT_EQ(contents.turns, torn.turns() + 1) << size;
    ASSERT_EQ(contents.newest_player, 77u) << size;
  }
}

TEST_F(ContinuedRoundTest, ReplayReportsAllScoresAgain) {
  EXPECT_EQ(world->name().id, uuidText(round->header().uuid));
  executeAgain();
  ASSERT_EQ(recovered, 53u);
  const std::vector<df::AddedScore> scores = world->popScores();
  ASSERT_EQ(scores.size(), 54u) << "that of the closing turn, too";
  for (std::size_t i = 0; i < scores.size(); ++i) EXPECT_EQ(scores[i].tick, i + 1);
  EXPECT_TRUE(world->popScores().empty());
}

TEST_F(ContinuedRoundTest, WorldIsReadyAfterAllTurnsAreReplayed) {
  world->checkProcess(1);
  EXPECT_EQ(world->recovering(), 0) << "the world has not begun";
  p_echo->ready = true;
  world->checkProcess(2);
  EXPECT_FALSE(world->isReady());
  EXPECT_EQ(world->popSessions(), std::nullopt);
  p_echo->answer();
  EXPECT_EQ(recovered, 53u);
  EXPECT_EQ(said, "");
  EXPECT_EQ(world->recovering(), 100) << "its sessions are not there yet";
  EXPECT_TRUE(world->isReady());
  EXPECT_EQ(reported, 0) << "its players have seen these ticks";
  ASSERT_EQ(p_echo->turns.size(), 54u);
  EXPECT_FALSE(p_echo->watched.back()) << "so that the next view has all";
  ASSERT_EQ(p_echo->turns.back().size(), 1u);
  EXPECT_EQ(p_echo->turns.back()[0].key_action, df::KEY_RELEASED);
  const auto sessions = world->popSessions();
  ASSERT_TRUE(sessions);
  ASSERT_EQ(sessions->size(), 2u);
  EXPECT_TRUE((*sessions)[1].muted);
  EXPECT_EQ(world->popSessions(), std::nullopt);
  EXPECT_EQ(world->recovering(), std::nullopt);
}

TEST_F(ContinuedRoundTest, JournalContinuesInTheSameFile) {
  executeAgain();
  world->addInput(keyOf(2, df::Keyboard::C, df::KEY_PRESSED));
  world->tick(true, false);
  p_echo->answer();
  EXPECT_EQ(reported, 1);
  TurnRecordReader sent;
  sent.add(p_echo->sent);
  for (int i = 0; i < 55; ++i) ASSERT_TRUE(sent.next()) << i;
  EXPECT_TRUE(sent.atEnd()) << "the world can read it as one stream";
  ASSERT_TRUE(disk->drain(std::chrono::seconds(60)));
  const Contents contents(test::contentOf(path));
  EXPECT_EQ(contents.end, DfrEnd::kTorn);
  EXPECT_EQ(contents.turns, 55u) << "the closing one, and the one after it";
  EXPECT_EQ(contents.results, 55u) << "also that of the tick that the server was killed in";
}

TEST_F(ContinuedRoundTest, InputsDuringReplayWaitForTheNextTick) {
  p_echo->ready = true;
  world->checkProcess(1);
  world->addInput({.kind = df::InputQueue::kLeave, .player = 2});
  p_echo->answer();
  ASSERT_EQ(recovered, 53u);
  for (const auto& inputs : p_echo->turns) {
    for (const WorldInput& input : inputs) EXPECT_NE(input.kind, df::InputQueue::kLeave);
  }
  world->tick(true, false);
  ASSERT_EQ(p_echo->turns.back().size(), 1u);
  EXPECT_EQ(p_echo->turns.back()[0].kind, df::InputQueue::kLeave);
}

// A copy of a world has read other turns before those that are replayed.
TEST_F(RecoveryTest, FirstReplayedTurnStatesAllFlags) {
  WorldTurn watched;
  watched.watched = true;
  std::string before;
  TurnRecordWriter().write(watched, before);
  TurnRecordWriter().write(WorldTurn(), records);
  RoundRecovery recovery(std::make_shared<UnfinishedRound>(DfrHeader(), records));
  const auto turn = recovery.nextTurn();
  ASSERT_TRUE(turn);
  TurnRecordReader reader;
  reader.add(before + turn->record);
  ASSERT_TRUE(reader.next());
  const auto record = reader.next();
  ASSERT_TRUE(record && std::holds_alternative<WorldTurn>(*record));
  EXPECT_FALSE(std::get<WorldTurn>(*record).watched);
}

TEST_F(RecoveryTest, TurnWithDroppedKeysHasOneResult) {
  crashInSecondTurn(2);
  EXPECT_EQ(said, "");
  ASSERT_GE(p_echo->turns.size(), 2u);
  EXPECT_TRUE(p_echo->turns[1].empty()) << "without the key that the world before died of";
  ASSERT_TRUE(disk->drain(std::chrono::seconds(60)));
  EXPECT_EQ(Contents(test::contentOf(path)).results, 4u) << "of three turns and the closing one";
}

TEST_F(RecoveryTest, TurnWithDroppedKeysIsComparedWithTheFile) {
  crashInSecondTurn(3);
  EXPECT_EQ(said, "in tick 2 the world's output is different");
}

TEST_F(ContinuedRoundTest, RecoveryFailsIfTheWorldCrashesDuringReplay) {
  p_echo->dies_at = 10;
  executeAgain();
  world->checkProcess(2);
  EXPECT_NE(said.find("crashed (SIGSEGV)"), std::string::npos) << said;
  ASSERT_TRUE(world->end());
  EXPECT_EQ(world->end()->why, WorldEnd::kNotRecovered);
}

TEST_F(ContinuedRoundTest, ReplaySendsTurnsAheadAfterTheFirstAnswer) {
  p_echo->ready = true;
  p_echo->ahead = 8;
  world->checkProcess(1);
  EXPECT_EQ(p_echo->turns.size(), 1u) << "a world has longer for its first tick";
  p_echo->answer();
  EXPECT_EQ(p_echo->most_ahead, 8u);
  EXPECT_EQ(recovered, 53u);
  EXPECT_EQ(said, "");
  ASSERT_EQ(p_echo->turns.size(), 54u);
  EXPECT_EQ(p_echo->turns.back().size(), 1u) << "the closing turn comes when all are answered";
}

TEST_F(RecoveryTest, RecoveryFailsAtTheDifferentTurnDespiteTurnsAhead) {
  turn({joinOf(1)});
  session(sessionOf(1));
  for (int i = 0; i < 9; ++i) turn({});
  turn({}, false);
  writeCheck(255);
  for (int i = 0; i < 9; ++i) turn({});
  goOn();
  p_echo->ahead = 8;
  executeAgain();
  EXPECT_NE(said.find("in tick 11 "), std::string::npos) << said;
  ASSERT_TRUE(world->end());
  EXPECT_EQ(world->end()->why, WorldEnd::kNotRecovered);
  EXPECT_TRUE(world->popSessions()) << "its players are in the next round";
}

TEST_F(RecoveryTest, JournalFileCannotBeOpenedTwice) {
  play();
  const std::size_t size = open().wholeBytes();
  const JournalFileSink first(path, size);
  EXPECT_THROW(JournalFileSink(path, size), std::system_error);
}

}  // namespace
}  // namespace naiad
