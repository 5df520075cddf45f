#include <gtest/gtest.h>

#include "shared/replica/PredictedObject.h"

namespace naiad {
namespace {

using df::ControlEffect;
using df::ControlTable;
using df::FixedVector;
using df::fromCells;
using df::KEY_DOWN;
using df::KEY_PRESSED;
using df::KEY_RELEASED;
using df::kFixedOne;
using df::Keyboard::A;
using df::Keyboard::B;
using df::Keyboard::C;

FixedVector cells(int x, int y) {
  return {fromCells(x), fromCells(y)};
}

class Wall : public Barriers {
 public:
  bool isBlocked(FixedVector to, std::uint32_t, bool) const override { return to.x >= fromCells(14); }
};

/// A ship at (10,10) and its control table.
class Steering : public testing::Test {
 protected:
  void row(df::Keyboard::Key key, ControlEffect effect, FixedVector value, int wait = 0, int group = 0) {
    table.rows.push_back({key, KEY_PRESSED, effect, true, true, value, static_cast<std::uint16_t>(wait),
                          static_cast<std::uint8_t>(group)});
  }
  void drive(df::Keyboard::Key key, FixedVector value) {
    table.rows.push_back({key, KEY_PRESSED, ControlEffect::kDrive, value.x != 0, value.y != 0, value});
  }
  PredictedObject ship(const Barriers* p_barriers = nullptr) {
    ControlRecord start;
    start.position = cells(10, 10);
    start.state.steering = steering;
    start.velocity = velocity;
    return PredictedObject(start, table, p_barriers);
  }
  static void press(PredictedObject& copy, df::Keyboard::Key key,
                    df::EventKeyboardAction action = KEY_PRESSED) {
    copy.beginTick();
    copy.applyKey(key, action);
    copy.finishTick();
  }
  static void pass(PredictedObject& copy, int ticks) {
    for (int i = 0; i < ticks; ++i) {
      copy.beginTick();
      copy.finishTick();
    }
  }

  ControlTable table;
  FixedVector velocity;
  bool steering = true;
};

TEST_F(Steering, EachStepKeyMovesOnceInItsTick) {
  row(A, ControlEffect::kStep, cells(1, 0));
  PredictedObject copy = ship();
  copy.beginTick();
  copy.applyKey(A, KEY_PRESSED);
  EXPECT_EQ(copy.position(), cells(11, 10));
  copy.applyKey(A, KEY_PRESSED);
  copy.applyKey(A, KEY_RELEASED);
  copy.applyKey(B, KEY_PRESSED);
  copy.finishTick();
  EXPECT_EQ(copy.position(), cells(12, 10));
}

TEST_F(Steering, RowsWaitOnlyForTheirOwnGroup) {
  row(A, ControlEffect::kStep, cells(1, 0), 3, 1);
  row(B, ControlEffect::kStep, cells(0, 1), 3, 1);
  row(C, ControlEffect::kStep, cells(0, 1), 3, 2);
  PredictedObject copy = ship();
  for (int tick = 0; tick < 7; ++tick) press(copy, A);  // takes effect in the first, fourth and seventh tick
  EXPECT_EQ(copy.position(), cells(13, 10));
  press(copy, B);
  EXPECT_EQ(copy.position(), cells(13, 10));
  press(copy, C);
  EXPECT_EQ(copy.position(), cells(13, 11));
}

TEST_F(Steering, BlockedStepStaysButStartsTheWait) {
  row(A, ControlEffect::kStep, cells(5, 0), 2);
  const Wall wall;
  PredictedObject copy = ship(&wall);
  press(copy, A);
  EXPECT_EQ(copy.position(), cells(10, 10));
  EXPECT_EQ(copy.now().state.wait[0], 2);
}

TEST_F(Steering, VelocityKeyPersistsAndKeepsTheOtherAxis) {
  velocity = {0, kFixedOne / 4};
  table.rows.push_back({A, KEY_PRESSED, ControlEffect::kVelocity, true, false, {kFixedOne, 0}, 0, 0});
  PredictedObject copy = ship();
  press(copy, A);
  pass(copy, 3);
  EXPECT_EQ(copy.position(), cells(14, 11));
}

TEST_F(Steering, BlockedVelocityIsRetriedEachTick) {
  velocity = {kFixedOne, 0};
  const Wall wall;
  PredictedObject copy = ship(&wall);
  pass(copy, 10);
  EXPECT_EQ(copy.position(), cells(13, 10));
  EXPECT_EQ(copy.velocity(), velocity);
}

TEST_F(Steering, ADriveLastsAsLongAsItsKey) {
  drive(A, {kFixedOne / 2, 0});
  PredictedObject copy = ship();
  press(copy, A);
  pass(copy, 4);
  press(copy, A, KEY_RELEASED);
  EXPECT_EQ(copy.position().x, fromCells(13));
  pass(copy, 5);
  EXPECT_EQ(copy.position().x, fromCells(13));
}

TEST_F(Steering, KeyTappedWithinOneTickCountsInIt) {
  drive(A, {kFixedOne / 2, 0});
  PredictedObject copy = ship();
  copy.beginTick();
  copy.applyKey(A, KEY_PRESSED);
  copy.applyKey(A, KEY_RELEASED);
  copy.finishTick();
  pass(copy, 3);
  EXPECT_EQ(copy.position().x, fromCells(10) + kFixedOne / 2);
}

TEST_F(Steering, LastPressedKeyOfAnAxisWins) {
  drive(A, {-kFixedOne, 0});
  drive(B, {kFixedOne, 0});
  PredictedObject copy = ship();
  press(copy, A);
  press(copy, B);
  press(copy, A, KEY_RELEASED);
  EXPECT_EQ(copy.position(), cells(11, 10));
  EXPECT_EQ(copy.velocity().x, kFixedOne);
}

TEST_F(Steering, ReleasedDriveStopsAtTheNextWholeCell) {
  table.whole_cells = true;
  for (const df::Fixed speed : {kFixedOne / 3, kFixedOne / 2, kFixedOne * 2 / 7, kFixedOne}) {
    for (const int sign : {1, -1}) {
      table.rows.clear();
      drive(A, {sign * speed, 0});
      PredictedObject copy = ship();
      press(copy, A);
      press(copy, A, KEY_RELEASED);
      pass(copy, 10);
      const df::Fixed gone = std::abs(copy.position().x - fromCells(10));
      EXPECT_EQ(gone & (kFixedOne - 1), 0);
      EXPECT_EQ(gone, (2 * speed + kFixedOne - 1) / kFixedOne * kFixedOne) << speed;
      EXPECT_EQ(copy.velocity(), FixedVector{});
    }
  }
}

TEST_F(Steering, KeysCannotLeaveTheBounds) {
  table.bounded = true;
  table.bounds = {cells(8, 8), cells(4, 4)};  // from 8 to 12
  drive(A, cells(1, 0));
  row(B, ControlEffect::kStep, cells(0, -1));
  row(C, ControlEffect::kVelocity, cells(-3, 1));
  PredictedObject copy = ship();
  press(copy, A);
  pass(copy, 5);
  EXPECT_EQ(copy.position(), cells(12, 10));
  for (int i = 0; i < 5; ++i) press(copy, B);
  EXPECT_EQ(copy.position(), cells(12, 8));
  table.rows.erase(table.rows.begin());  // without drives, a velocity lasts
  PredictedObject other = ship();
  press(other, C);
  pass(other, 5);
  EXPECT_EQ(other.position(), cells(10, 12));  // axes are checked separately: 3 to the left would be outside
}

TEST_F(Steering, ASilentKeyboardReleasesItsDrives) {
  table.patience = 4;
  drive(A, cells(1, 0));
  PredictedObject copy = ship();
  press(copy, A);
  pass(copy, 3);
  press(copy, B, KEY_DOWN);  // any pressed or held key shows that the player is there
  pass(copy, 3);
  EXPECT_EQ(copy.velocity(), cells(1, 0));
  press(copy, B, KEY_RELEASED);  // a release does not, and the drive ends one tick later
  EXPECT_EQ(copy.velocity(), cells(1, 0));
  pass(copy, 1);
  EXPECT_EQ(copy.velocity(), cells(0, 0));
}

TEST_F(Steering, HeldKeysAreRememberedWithoutSteering) {
  steering = false;
  drive(A, cells(1, 0));
  row(B, ControlEffect::kStep, cells(0, 1), 5);
  PredictedObject copy = ship();
  press(copy, A);
  press(copy, B);
  EXPECT_EQ(copy.position(), cells(10, 10));
  EXPECT_EQ(copy.now().state.wait[0], 0);
  ControlRecord known = copy.now();
  known.state.steering = true;
  EXPECT_EQ(deadReckon(known, table, known.tick + 3).position, cells(13, 10));
}

TEST_F(Steering, KeysWithoutARowAreNotHandled) {
  row(A, ControlEffect::kStep, cells(1, 0));
  drive(B, cells(1, 0));
  df::ControlState state;
  PredictedObject copy = ship();
  EXPECT_FALSE(applyControlKey(table, state, A, KEY_PRESSED, copy));  // steers no object
  state.steering = true;
  EXPECT_TRUE(applyControlKey(table, state, A, KEY_PRESSED, copy));
  EXPECT_FALSE(applyControlKey(table, state, A, KEY_RELEASED, copy));
  EXPECT_TRUE(applyControlKey(table, state, B, KEY_RELEASED, copy));
  EXPECT_FALSE(applyControlKey(table, state, C, KEY_PRESSED, copy));
}

}  // namespace
}  // namespace naiad
