// A round stores exactly what it sends to its world, and stores it first.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/server/host/rooms/HostRooms.h"

namespace naiad {
namespace {

/// Records what was stored before each turn.
struct StoredWorld : test::FakeWorld {
  void tick(const SentTurn& turn) override {
    stored_before.clear();
    if (p_journal != nullptr) p_journal->ring().peek(stored_before, 1 << 20);
    const std::uint32_t number = static_cast<std::uint32_t>(turns.size()) + 1;
    next.hash = 0xAB00000000000000u + number;
    if (turn.turn.checked) next.state_hash = number;
    df::Canvas canvas(20, 10);
    canvas.put(0, 0, {static_cast<char32_t>(U'A' + turn.turn.rendered_player), df::RED});
    next.pictures.push_back({turn.turn.rendered_player, canvas});
    FakeWorld::tick(turn);
  }

  std::string stored_before;
  const Journal* p_journal = nullptr;
};

class RoundTest : public testing::Test {
 protected:
  RoundTest() {
    auto fake = std::make_unique<StoredWorld>();
    p_fake = fake.get();
    Round::JournalBinding book = test::ringJournal();
    journal = book.journal;
    p_fake->p_journal = journal.get();
    book.on_problem = [this](const std::string& problem) { problems.push_back(problem); };
    round = std::make_unique<Round>(std::move(fake), std::move(book));
  }
  std::vector<TurnRecord> records() const {
    TurnRecordReader reader;
    std::string bytes;
    journal->ring().peek(bytes, 1 << 20);
    reader.add(bytes);
    std::vector<TurnRecord> all;
    while (auto record = reader.next()) all.push_back(*std::move(record));
    EXPECT_FALSE(reader.isBad());
    EXPECT_TRUE(reader.atEnd());
    return all;
  }
  template <class Record>
  std::vector<Record> recordsOf() const {
    std::vector<Record> found;
    for (const TurnRecord& record : records()) {
      if (const auto* p_record = std::get_if<Record>(&record)) found.push_back(*p_record);
    }
    return found;
  }
  static df::InputQueue::Input key(std::uint32_t player) {
    return {.kind = df::InputQueue::kKey,
            .player = player,
            .key = df::Keyboard::A,
            .key_action = df::KEY_PRESSED};
  }

  StoredWorld* p_fake = nullptr;
  std::shared_ptr<Journal> journal;
  std::unique_ptr<Round> round;
  std::vector<std::string> problems;
};

TEST_F(RoundTest, ATurnIsStoredBeforeTheWorldGetsIt) {
  round->addInput(key(3));
  round->tick(true, false);
  TurnRecordReader reader;
  reader.add(p_fake->stored_before);
  const auto record = reader.next();
  ASSERT_TRUE(record && std::holds_alternative<WorldTurn>(*record));
  const auto& turn = std::get<WorldTurn>(*record);
  EXPECT_TRUE(turn.watched);
  ASSERT_EQ(turn.inputs.size(), 1u);
  EXPECT_EQ(turn.inputs[0].player, 3u);
  EXPECT_FALSE(reader.next()) << "and what came of it after";
  ASSERT_EQ(records().size(), 2u);
  EXPECT_EQ(std::get<TickResult>(records()[1]).check, 0xAB);
}

TEST_F(RoundTest, TheWorldGetsTheBytesThatAreStored) {
  for (int i = 0; i < 3; ++i) {
    round->addInput(key(3));
    round->tick(i > 0, false);
    const std::string& stored = p_fake->stored_before;
    const std::string& sent = p_fake->turns.back().record;
    ASSERT_FALSE(sent.empty());
    EXPECT_EQ(stored.substr(stored.size() - sent.size()), sent) << i;
  }
}

TEST_F(RoundTest, EveryThirtiethTickHasAHashOfTheState) {
  for (int i = 0; i < 65; ++i) round->tick(false, false);
  std::vector<std::uint64_t> hashes;
  for (const TickResult& result : recordsOf<TickResult>()) {
    if (result.state_hash) hashes.push_back(*result.state_hash);
  }
  EXPECT_EQ(hashes, (std::vector<std::uint64_t>{30, 60}));
}

TEST_F(RoundTest, RecordsPicturesOfTheLongestPresentPlayer) {
  round->addInput({.kind = df::InputQueue::kJoin, .player = 1, .name = "Ann"});
  round->addInput({.kind = df::InputQueue::kJoin, .player = 2, .name = "Bob"});
  for (std::uint32_t i = 1; i <= Round::kFirstPicture + 1; ++i) {
    round->tick(true, false);
    const WorldTurn& turn = p_fake->turns.back().turn;
    EXPECT_EQ(turn.wants_truth, i == Round::kFirstPicture) << i;
    EXPECT_EQ(turn.rendered_player, i == Round::kFirstPicture ? 1u : 0u) << i;
  }
  const auto pictures = recordsOf<RecordedPicture>();
  ASSERT_EQ(pictures.size(), 1u);
  EXPECT_EQ(pictures[0].player, 1u);
  EXPECT_EQ(pictures[0].canvas.at(0, 0).ch, U'B');
}

TEST_F(RoundTest, ViewedTicksAreRecordedInTheWorldsOwnTicks) {
  p_fake->picture.tick = 1000;  // not the host's first world
  round->tick(true, false);
  df::InputQueue::Input click{.kind = df::InputQueue::kMouse, .player = 1, .seen = {true, 1001, 1000}};
  click.mouse_action = df::CLICKED;
  click.button = df::Mouse::LEFT;
  round->addInput(click);
  round->tick(true, false);
  const TurnRecord turn = records()[2];
  EXPECT_EQ(std::get<WorldTurn>(turn).inputs[0].seen.base, 1u);
  EXPECT_EQ(std::get<WorldTurn>(turn).inputs[0].seen.drawn, 0u);
}

TEST_F(RoundTest, KeysBeyondTheLimitAreDropped) {
  for (std::size_t i = 0; i < Round::kMaxInputs + 10; ++i) round->addInput(key(1));
  round->addInput({.kind = df::InputQueue::kLeave, .player = 1});
  round->tick(true, false);
  EXPECT_EQ(p_fake->turns[0].turn.inputs.size(), Round::kMaxInputs + 1);
  EXPECT_EQ(std::get<WorldTurn>(records()[0]).inputs.size(), Round::kMaxInputs + 1);
}

TEST_F(RoundTest, AJournalThatStopsDoesNotStopTheGame) {
  while (journal->add(std::string(1000, 'x'))) continue;
  round->tick(true, false);
  round->tick(true, true);
  EXPECT_EQ(p_fake->turns.size(), 2u);
  EXPECT_TRUE(p_fake->turns.back().turn.wants_truth);
  round->checkProcess(3);
  round->checkProcess(4);
  EXPECT_EQ(problems, (std::vector<std::string>{"the disk is too slow"}));
  round->addInput(key(7));
  round->tick(true, false);
  EXPECT_EQ(p_fake->turns.back().turn.inputs.size(), 1u);
  TurnRecordReader reader;  // the world still gets complete records
  for (const SentTurn& turn : p_fake->turns) reader.add(turn.record);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(reader.next()) << i;
  EXPECT_TRUE(reader.atEnd());
}

}  // namespace
}  // namespace naiad
