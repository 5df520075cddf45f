// The decorator that writes turns down: what it stores is what the world gets, and before it does.
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "host/journal/JournaledWorld.h"
#include "host/world/WorldProcess.h"

namespace naiad {
namespace {

struct Nowhere : JournalSink {
  void write(std::string_view /*bytes*/) override {}
  void sync() override {}
  void setFlags(std::uint16_t /*flags*/) override {}
};

/// A world that notes what it gets, and what was stored by then.
class FakeWorld : public WorldPort {
 public:
  std::uint32_t addInput(df::InputQueue::Input input) override {
    inputs.push_back(input);
    return input.kind == df::InputQueue::kJoin ? input.player + 100 : input.player;
  }
  void setHeard(std::uint32_t player) override { heard = player; }
  void endGame() override { over = true; }
  bool isReady() const override { return true; }
  void setPictured(std::uint32_t player) override { pictured = player; }
  void setChecked(bool state) override { checked = state; }
  std::uint64_t answerHash() const override { return 0xAB00000000000000u + ticks; }
  std::optional<std::uint64_t> stateHash() const override {
    return checked ? std::optional<std::uint64_t>(ticks) : std::nullopt;
  }
  void tick(bool watched, bool truth) override {
    ++ticks;
    was_watched = watched;
    had_truth = truth;
    pictured_in_tick = pictured;
    stored_before.clear();
    if (p_journal != nullptr) p_journal->ring().peek(stored_before, 1 << 20);
    reportTick();
    inputs.clear();
  }
  std::uint32_t nextTick() const override { return first + ticks; }
  const df::WorldView& view() const override { return m_view; }
  void notePublished(const Publisher& /*publisher*/) override {}
  std::vector<std::uint32_t> takeLeavers() override { return {}; }
  std::vector<df::AddedScore> takeScores() override { return {}; }
  bool isGameOver() const override { return over; }
  df::Canvas renderPlayer(std::uint32_t player) const override {
    df::Canvas canvas(20, 10);
    canvas.put(0, 0, {static_cast<char32_t>(U'A' + player), df::RED});
    return canvas;
  }

  std::vector<df::InputQueue::Input> inputs;
  std::string stored_before;
  const Journal* p_journal = nullptr;
  std::uint32_t first = 1;
  std::uint32_t ticks = 0;
  std::uint32_t heard = 0;
  std::uint32_t pictured = 0;
  std::uint32_t pictured_in_tick = 0;
  bool checked = false;
  bool over = false;
  bool was_watched = false;
  bool had_truth = false;

 private:
  df::WorldView m_view;
};

class JournaledWorldTest : public testing::Test {
 protected:
  JournaledWorldTest() {
    auto fake = std::make_unique<FakeWorld>();
    p_fake = fake.get();
    journal = std::make_shared<Journal>(std::make_unique<Nowhere>(), DfrHeader(), DfrFacts(), 1 << 20, false);
    p_fake->p_journal = journal.get();
    JournaledWorld::Book book;
    book.writer =
        std::make_shared<JournalWriter>();  // which does not have the journal: all stays in the ring
    book.journal = journal;
    book.on_problem = [this](const std::string& problem) { problems.push_back(problem); };
    world = std::make_unique<JournaledWorld>(std::move(fake), std::move(book));
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
  static df::InputQueue::Input key(std::uint32_t player) {
    return {.kind = df::InputQueue::kKey,
            .player = player,
            .key = df::Keyboard::A,
            .key_action = df::KEY_PRESSED};
  }

  FakeWorld* p_fake = nullptr;
  std::shared_ptr<Journal> journal;
  std::unique_ptr<JournaledWorld> world;
  std::vector<std::string> problems;
};

TEST_F(JournaledWorldTest, ATurnIsStoredBeforeTheWorldGetsIt) {
  world->addInput(key(3));
  world->tick(true, false);
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

TEST_F(JournaledWorldTest, APlayerHasTheIdThatTheWorldGives) {
  EXPECT_EQ(world->addInput({.kind = df::InputQueue::kJoin, .player = 1, .name = "Ann"}), 101u);
  world->tick(true, false);
  EXPECT_EQ(std::get<WorldTurn>(records()[0]).inputs[0].player, 101u);
}

TEST_F(JournaledWorldTest, EveryThirtiethTickHasAHashOfTheState) {
  for (int i = 0; i < 65; ++i) world->tick(false, false);
  std::vector<std::uint64_t> hashes;
  for (const TurnRecord& record : records()) {
    if (const auto* p = std::get_if<TickResult>(&record); p != nullptr && p->state_hash)
      hashes.push_back(*p->state_hash);
  }
  EXPECT_EQ(hashes, (std::vector<std::uint64_t>{30, 60}));
}

TEST_F(JournaledWorldTest, NowAndThenATickHasAPictureOfThePlayerWhoHasBeenThereLongest) {
  world->addInput({.kind = df::InputQueue::kJoin, .player = 1, .name = "Ann"});
  world->addInput({.kind = df::InputQueue::kJoin, .player = 2, .name = "Bob"});
  for (std::uint32_t i = 1; i <= JournaledWorld::kFirstPicture + 1; ++i) {
    world->tick(true, false);
    EXPECT_EQ(p_fake->had_truth, i == JournaledWorld::kFirstPicture) << i;
    if (i == JournaledWorld::kFirstPicture) {
      EXPECT_EQ(p_fake->pictured_in_tick, 101u);
    }
  }
  EXPECT_EQ(p_fake->pictured, 0u) << "what the host asked for counts again";
  std::vector<RecordedPicture> pictures;
  for (const TurnRecord& record : records()) {
    if (const auto* p = std::get_if<RecordedPicture>(&record)) pictures.push_back(*p);
  }
  ASSERT_EQ(pictures.size(), 1u);
  EXPECT_EQ(pictures[0].player, 101u);
  EXPECT_EQ(pictures[0].canvas.at(0, 0).ch, static_cast<char32_t>(U'A' + 101));
}

TEST_F(JournaledWorldTest, WhatPlayersSawIsCountedByTheWorldsOwnTicks) {
  p_fake->first = 1001;  // it is not the host's first world
  world->tick(true, false);
  df::InputQueue::Input click{.kind = df::InputQueue::kMouse, .player = 1, .seen = {true, 1001, 1000}};
  click.mouse_action = df::CLICKED;
  click.button = df::Mouse::LEFT;
  world->addInput(click);
  EXPECT_EQ(p_fake->inputs[0].seen.base, 1001u);
  world->tick(true, false);
  const TurnRecord turn = records()[2];
  EXPECT_EQ(std::get<WorldTurn>(turn).inputs[0].seen.base, 1u);
  EXPECT_EQ(std::get<WorldTurn>(turn).inputs[0].seen.drawn, 0u);
}

TEST_F(JournaledWorldTest, KeysBeyondTheLimitAreInNeitherList) {
  for (std::size_t i = 0; i < WorldProcess::kMaxInputs + 10; ++i) world->addInput(key(1));
  world->addInput({.kind = df::InputQueue::kLeave, .player = 1});
  EXPECT_EQ(p_fake->inputs.size(), WorldProcess::kMaxInputs + 1);
  world->tick(true, false);
  EXPECT_EQ(std::get<WorldTurn>(records()[0]).inputs.size(), WorldProcess::kMaxInputs + 1);
}

TEST_F(JournaledWorldTest, AJournalThatStopsDoesNotStopTheGame) {
  while (journal->add(std::string(1000, 'x'))) continue;
  world->tick(true, false);
  world->tick(true, true);
  EXPECT_EQ(p_fake->ticks, 2u);
  EXPECT_TRUE(p_fake->had_truth);
  world->checkProcess(3);
  world->checkProcess(4);
  EXPECT_EQ(problems, (std::vector<std::string>{"the disk is too slow"}));
  EXPECT_EQ(world->addInput(key(7)), 7u);
  EXPECT_EQ(p_fake->inputs.size(), 1u);
}

}  // namespace
}  // namespace naiad
