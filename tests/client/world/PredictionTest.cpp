#include <gtest/gtest.h>

#include "client/world/DrawnPlacement.h"
#include "client/world/Prediction.h"
#include "client/world/ReplicaBarriers.h"

namespace naiad {
namespace {

using df::FixedVector;
using df::fromCells;
using df::KEY_PRESSED;
using df::kFixedOne;
using df::Keyboard::D;
using df::Keyboard::S;

constexpr std::uint32_t kFirstTick = 100;
constexpr std::uint32_t kOwnSlot = 7;

FixedVector cells(int x, int y) {
  return {fromCells(x), fromCells(y)};
}

ObjectRecord object(std::uint32_t slot, FixedVector at, FixedVector velocity = {}) {
  ObjectRecord record{slot, 1, kAllGroups, {}};
  record.state.order = slot;
  record.state.motion = {kFirstTick, at, velocity, {}};
  record.state.look.sequence = {{Glyph{0, 0, U'@', df::WHITE}}};
  record.state.body = {{{-kFixedOne / 2, -kFixedOne / 2}, {kFixedOne, kFixedOne}}, df::HARD, false};
  return record;
}

Records objects(std::vector<ObjectRecord> list) {
  Records records;
  records.objects = std::move(list);
  return records;
}

void apply(Replica& replica, std::uint32_t number, Records records) {
  Snapshot snapshot;
  snapshot.header.number = number;
  snapshot.header.tick = kFirstTick;
  snapshot.records = std::move(records);
  replica.apply(snapshot);
}

/// The player's own ship at (10,10). D steps to the right, S down.
class PredictionTest : public testing::Test {
 protected:
  PredictionTest() {
    table.rows = {{D, KEY_PRESSED, df::ControlEffect::kStep, true, true, cells(1, 0)},
                  {S, KEY_PRESSED, df::ControlEffect::kStep, true, true, cells(0, 1)}};
    prediction.setTable(table);
    applyRecords(objects({object(kOwnSlot, cells(10, 10))}));
    prediction.applyControl(state(kFirstTick, 0, cells(10, 10)));
  }
  void applyRecords(Records records) { apply(replica, ++number, std::move(records)); }
  static ControlRecord state(std::uint32_t tick, std::uint32_t newest, FixedVector at) {
    ControlRecord record;
    record.tick = tick;
    record.slot = kOwnSlot;
    record.generation = 1;
    record.newest_input = newest;
    record.position = at;
    record.state.steering = true;
    return record;
  }
  void press(std::uint32_t id, df::Keyboard::Key key, df::EventKeyboardAction action, std::uint32_t tick) {
    prediction.addInput({.id = id,
                         .tick = tick,
                         .action = static_cast<std::uint8_t>(action),
                         .key = static_cast<std::uint8_t>(key)});
  }
  /// Returns where D moves the own ship in the first tick of a world with another object.
  FixedVector afterOneStep(const ObjectRecord& own, const ObjectRecord& other) {
    replica = Replica();
    prediction = Prediction();
    apply(replica, 1, objects({own, other}));
    prediction.setTable(table);
    prediction.applyControl(state(kFirstTick, 0, cells(10, 10)));
    press(1, D, KEY_PRESSED, kFirstTick + 1);
    return at(kFirstTick + 1);
  }
  FixedVector at(std::uint32_t tick) {
    prediction.run(replica, tick);
    return prediction.position();
  }

  df::ControlTable table;
  Replica replica;
  Prediction prediction;
  std::uint32_t number = 0;
};

TEST_F(PredictionTest, NothingIsPredictedWithoutTableStateOrObject) {
  Prediction other;
  other.run(replica, kFirstTick);
  EXPECT_FALSE(other.isActive());
  other.applyControl(state(kFirstTick, 0, cells(10, 10)));
  other.run(replica, kFirstTick);
  EXPECT_FALSE(other.isActive());
  other.setTable(table);
  other.run(replica, kFirstTick);
  EXPECT_TRUE(other.isActive());
  other.run(Replica(), kFirstTick);
  EXPECT_FALSE(other.isActive());
  ControlRecord nothing = state(kFirstTick + 1, 0, {});
  nothing.generation = 0;
  other.applyControl(nothing);
  other.run(replica, kFirstTick + 1);
  EXPECT_FALSE(other.isActive());
}

TEST_F(PredictionTest, InputsTakeEffectInSendOrder) {
  press(1, D, KEY_PRESSED, kFirstTick + 5);
  press(2, S, KEY_PRESSED, kFirstTick + 3);
  prediction.applyControl(state(kFirstTick + 1, 1, cells(10, 10)));
  EXPECT_EQ(at(kFirstTick + 4), cells(10, 10));
  EXPECT_EQ(at(kFirstTick + 5), cells(10, 11));
}

TEST_F(PredictionTest, LateInputIsExpectedInTheNextTick) {
  press(1, D, KEY_PRESSED, kFirstTick + 2);
  EXPECT_EQ(at(kFirstTick + 6), cells(11, 10));
  prediction.applyControl(state(kFirstTick + 4, 0, cells(10, 10)));  // the server has not received the input
  EXPECT_EQ(prediction.counters().mispredicted, 1u);
  EXPECT_EQ(at(kFirstTick + 4), cells(10, 10));
  EXPECT_EQ(at(kFirstTick + 5), cells(11, 10));
}

TEST_F(PredictionTest, MispredictionIsCorrectedInTheNextPicture) {
  press(1, D, KEY_PRESSED, kFirstTick + 2);
  press(2, D, KEY_PRESSED, kFirstTick + 5);
  at(kFirstTick + 5);
  prediction.applyControl(state(kFirstTick + 3, 1, cells(30, 5)));  // another object carried the ship away
  EXPECT_EQ(prediction.counters().mispredicted, 1u);
  EXPECT_EQ(at(kFirstTick + 6), cells(31, 5));
}

TEST_F(PredictionTest, OlderControlStatesAreIgnored) {
  prediction.applyControl(state(kFirstTick + 3, 0, cells(12, 10)));
  prediction.applyControl(state(kFirstTick + 2, 0, cells(50, 10)));
  prediction.applyControl(state(kFirstTick + 3, 0, cells(50, 10)));
  EXPECT_EQ(at(kFirstTick + 4), cells(12, 10));
}

TEST_F(PredictionTest, TicksAndInputsMayWrapAround) {
  prediction.reset();
  prediction.setTable(table);
  prediction.applyControl(state(UINT32_MAX - 1, UINT32_MAX - 1, cells(10, 10)));
  press(UINT32_MAX, D, KEY_PRESSED, UINT32_MAX);
  press(1, D, KEY_PRESSED, 1);
  EXPECT_EQ(at(2), cells(12, 10));
  prediction.applyControl(state(3, 1, cells(12, 10)));
  EXPECT_EQ(prediction.pendingInputs(), 0u);
}

TEST_F(PredictionTest, ObjectsMoveInOrderOfCreation) {
  // The block to the right moves away, in time for the ship only if it moves first.
  table.rows[0] = {D, KEY_PRESSED, df::ControlEffect::kVelocity, true, true, cells(1, 0)};
  prediction.setTable(table);
  for (const auto& [slot, wanted] : {std::pair{kOwnSlot - 1, 11}, {kOwnSlot + 1, 10}}) {
    const auto block = object(slot, cells(12, 10), cells(1, 0));
    EXPECT_EQ(afterOneStep(object(kOwnSlot, cells(10, 10)), block), cells(wanted, 10)) << "slot " << slot;
  }
}

TEST_F(PredictionTest, InputsAndTicksAreBounded) {
  for (std::uint32_t id = 1; id <= 100; ++id) press(id, D, KEY_PRESSED, kFirstTick + 1);
  EXPECT_EQ(prediction.pendingInputs(), Prediction::kMaxInputs);
  EXPECT_EQ(prediction.counters().unpredicted, 100 - Prediction::kMaxInputs);
  EXPECT_EQ(at(kFirstTick + 1'000'000), cells(10 + static_cast<int>(Prediction::kMaxInputs), 10));
}

TEST_F(PredictionTest, ExtremeNumbersAreHarmless) {
  constexpr df::Fixed kFar = df::fromCells(2'000'000'000);
  constexpr df::Fixed kFast = df::fromCells(1 << 24);
  applyRecords(
      objects({object(8, {INT64_MAX, INT64_MIN}, {INT64_MAX, 1}), object(9, {kFar, kFar}, {kFast, -kFast})}));
  ControlRecord record = state(kFirstTick + 1, 0, {kFar, -kFar});
  record.velocity = {kFast, -kFast};
  record.acceleration = {kFast, -kFast};
  prediction.applyControl(record);
  press(1, D, KEY_PRESSED, kFirstTick + 3);
  prediction.run(replica, kFirstTick + 90);
  EXPECT_EQ(prediction.position(), (FixedVector{kFar, -kFar}));
  EXPECT_EQ(prediction.velocity(), record.velocity);
  const ExtrapolationClamp clamp(replica, kFirstTick, kFirstTick + 8);
  for (const auto& [slot, entry] : replica.entries())
    EXPECT_EQ(clamp.positionOf(entry.state), positionAt(entry.state.motion, kFirstTick + 8));
}

TEST_F(PredictionTest, PictureShowsPredictedShipAndView) {
  // A view of 30 by 12 in a world of 200 by 24 follows the ship at (10,10).
  Records records = objects({object(1, cells(40, 10))});
  records.worlds = {{{{}, cells(200, 24)}, 30, 12}};
  records.views = {{cells(0, 4), true, kOwnSlot, 1}};
  applyRecords(std::move(records));
  for (std::uint32_t i = 1; i <= 20; ++i) press(i, D, KEY_PRESSED, kFirstTick + 1);
  at(kFirstTick + 1);
  const ExtrapolationClamp clamp(replica, kFirstTick, kFirstTick);
  const DrawnPlacement placement(replica, prediction, clamp);
  EXPECT_EQ(replica.viewCorner(kFirstTick), (CellPosition{0, 4}));
  EXPECT_EQ(replica.viewCorner(kFirstTick, &placement),
            (CellPosition{10, 4}));  // 30 minus two thirds of the view
  EXPECT_EQ(replica.focus(kFirstTick, &placement), (CellPosition{20, 6}));
  const df::Canvas picture = replica.render(kFirstTick, &placement);
  EXPECT_EQ(picture.at(20, 6).ch, U'@');
  EXPECT_EQ(picture.at(10, 6).ch, U' ');
  EXPECT_EQ(replica.render(kFirstTick).at(10, 6).ch, U'@');
}

// Two thousand steps per frame (64 keys with 32 rows), all of them against a pile of objects.
TEST_F(PredictionTest, WorkIsLimitedForAnyNumberOfObstacles) {
  std::vector<ObjectRecord> pile;
  for (std::uint32_t slot = 1000; slot < 49'000; ++slot) {
    pile.push_back(object(slot, cells(12, 10)));
    pile.back().state.motion.acceleration = {1, 0};
  }
  applyRecords(objects(pile));
  const ObjectState& own = replica.find(kOwnSlot)->state;
  const df::FixedBox from = *boxAt(own.body, cells(10, 10));
  const ReplicaBarriers surroundings(replica, own, from, cells(5, 5), kFirstTick, kFirstTick + 90);
  EXPECT_LE(surroundings.work(), ReplicaBarriers::kMaxWork);
  EXPECT_TRUE(surroundings.isBlocked(cells(12, 10), kFirstTick + 1, true)) << "those in its room still block";
  for (int i = 0; i < 2'000; ++i) (void)surroundings.isBlocked(cells(10, 10), kFirstTick + 1, false);
  EXPECT_LE(surroundings.work(), ReplicaBarriers::kMaxWork + 2'100);
}

}  // namespace
}  // namespace naiad
