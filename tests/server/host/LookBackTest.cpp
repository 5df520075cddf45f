#include <gtest/gtest.h>

#include <map>

#include "LookBack.h"
#include "SimulatedWorld.h"

namespace naiad {
namespace {

/// A random world, what is published of it, and the memory under test.
class LookBackTest : public testing::Test {
 protected:
  void tick() {
    world.tick();
    publisher.update(world.view());
    memory.note(publisher);
    auto& models = published[world.tickNumber()];
    publisher.forEach([&](std::uint32_t slot, const Publisher::Model& model) { models[slot] = model; });
  }
  df::Seen seen(std::uint32_t base_age, std::uint32_t drawn_age) const {
    return {true, world.tickNumber() - base_age, world.tickNumber() - drawn_age};
  }

  test::SimulatedWorld world{{}, 5};
  Publisher publisher;
  LookBack memory;
  std::map<std::uint32_t, std::map<std::uint32_t, Publisher::Model>> published;  // by tick, by slot
};

TEST_F(LookBackTest, SaysWhereAClientThatKnewTheBaseDrewIt) {
  SplitMix64 rng(1);
  int there = 0;
  int not_born = 0;
  int moved_since = 0;
  for (int i = 0; i < 1000; ++i) {
    tick();
    if (i < 40) continue;
    for (const auto& [slot, model] : published[world.tickNumber()]) {
      if (slot == kLooseSlot) continue;
      const df::Seen picture = seen(static_cast<std::uint32_t>(rng.below(LookBack::kTicks)),
                                    static_cast<std::uint32_t>(rng.below(LookBack::kMostBehind + 1)));
      const auto where = memory.positionOf({slot, model.generation}, picture);
      const auto& known = published[picture.base];
      const auto then = known.find(slot);
      if (then == known.end() || then->second.generation != model.generation) {
        EXPECT_FALSE(where) << "slot " << slot << " was not born";
        ++not_born;
        continue;
      }
      ++there;
      ASSERT_TRUE(where);
      EXPECT_EQ(*where, positionAt(then->second.state.motion, picture.drawn));
      moved_since += *where != positionAt(model.state.motion, world.tickNumber()) ? 1 : 0;
    }
  }
  EXPECT_GT(there, 10000);
  EXPECT_GT(moved_since, 10000);
  EXPECT_GT(not_born, 1000);
}

TEST_F(LookBackTest, WhatIsTooLongAgoOrYetToComeDoesNotCount) {
  for (int i = 0; i < 200; ++i) tick();
  int objects = 0;
  publisher.forEach([&](std::uint32_t slot, const Publisher::Model& model) {
    if (slot == kLooseSlot) return;
    const df::ObjectKey key{slot, model.generation};
    const auto same = [&](const df::Seen& a, const df::Seen& b) {
      EXPECT_EQ(memory.positionOf(key, a), memory.positionOf(key, b));
    };
    same(seen(0, 0), seen(0, static_cast<std::uint32_t>(-5)));  // drawn ahead of the server
    same(seen(0, LookBack::kMostBehind), seen(0, LookBack::kMostBehind + 20));
    same(seen(LookBack::kTicks, 3), seen(LookBack::kTicks + 100, 3));  // as old a base as is remembered
    ++objects;
  });
  EXPECT_GT(objects, 10);
}

TEST_F(LookBackTest, WhoSaysNothingAndWhoIsGoneWasNotSeen) {
  tick();
  tick();
  std::map<std::uint32_t, Publisher::Model> before = published[world.tickNumber()];
  for (int i = 0; i < 300; ++i) tick();
  int gone = 0;
  for (const auto& [slot, model] : before) {
    if (slot == kLooseSlot) continue;
    const Publisher::Model* p_now = publisher.find(slot);
    if (p_now != nullptr && p_now->generation == model.generation) {
      EXPECT_FALSE(memory.positionOf({slot, model.generation}, {}));
      continue;
    }
    EXPECT_FALSE(memory.positionOf({slot, model.generation}, seen(0, 0)));
    ++gone;
  }
  EXPECT_GT(gone, 5);
  EXPECT_FALSE(memory.positionOf({5000, 1}, seen(0, 0)));
}

TEST_F(LookBackTest, ALeftOutTickEmptiesTheMemory) {
  for (int i = 0; i < 50; ++i) tick();
  world.tick();
  publisher.update(world.view());
  tick();
  publisher.forEach([&](std::uint32_t slot, const Publisher::Model& model) {
    if (slot == kLooseSlot) return;
    EXPECT_EQ(memory.positionOf({slot, model.generation}, seen(0, 0)),
              positionAt(model.state.motion, world.tickNumber()));
    EXPECT_FALSE(memory.positionOf({slot, model.generation}, seen(1, 0)));
  });
}

TEST(SnapshotTicksTest, KnowsTheLastSnapshotsOnly) {
  SnapshotTicks ticks;
  EXPECT_FALSE(ticks.tickOf(0));
  EXPECT_FALSE(ticks.tickOf(1));
  for (std::uint32_t number = 1; number <= 300; ++number) ticks.note(number, 1000 + number);
  EXPECT_EQ(ticks.tickOf(300), 1300u);
  EXPECT_EQ(ticks.tickOf(200), 1200u);
  EXPECT_FALSE(ticks.tickOf(100));
  EXPECT_FALSE(ticks.tickOf(301));
}

}  // namespace
}  // namespace naiad
