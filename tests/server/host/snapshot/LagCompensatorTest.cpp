#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <vector>

#include "DirectSender.h"
#include "SimulatedWorld.h"
#include "host/snapshot/LagCompensator.h"

namespace naiad {
namespace {

/// A random world, its published models, and the compensator under test.
class LagCompensatorTest : public testing::Test {
 protected:
  void tick() {
    world.tick();
    compensator.recordTick(world.publisher, world.view());
    auto& models = published[world.tickNumber()];
    world.publisher.forEach([&](std::uint32_t slot, const Publisher::Model& model) {
      if (slot != kFreeDrawSlot) models[slot] = model;
    });
  }
  df::ViewedTick seen(std::uint32_t base_age, std::uint32_t drawn_age) const {
    return {true, world.tickNumber() - base_age, world.tickNumber() - drawn_age};
  }

  test::PublishedWorld world{{}, 5};
  LagCompensator compensator;
  std::map<std::uint32_t, std::map<std::uint32_t, Publisher::Model>> published;  // keyed by tick and slot
};

TEST_F(LagCompensatorTest, ReturnsThePositionTheClientDrew) {
  SplitMix64 rng(1);
  int there = 0;
  int not_born = 0;
  int moved_since = 0;
  for (int i = 0; i < 1000; ++i) {
    tick();
    if (i < 40) continue;
    for (const auto& [slot, model] : published[world.tickNumber()]) {
      const df::ViewedTick picture =
          seen(static_cast<std::uint32_t>(rng.below(LagCompensator::kTicks)),
               static_cast<std::uint32_t>(rng.below(LagCompensator::kMaxBehind + 1)));
      const auto where = compensator.positionOf({slot, model.generation}, picture);
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

TEST_F(LagCompensatorTest, OldAndFutureTicksAreClamped) {
  for (int i = 0; i < 200; ++i) tick();
  int objects = 0;
  for (const auto& [slot, model] : published[world.tickNumber()]) {
    const df::ObjectKey key{slot, model.generation};
    const auto same = [&](const df::ViewedTick& a, const df::ViewedTick& b) {
      EXPECT_EQ(compensator.positionOf(key, a), compensator.positionOf(key, b));
    };
    same(seen(0, 0), seen(0, static_cast<std::uint32_t>(-5)));  // drawn ahead of the server
    same(seen(0, LagCompensator::kMaxBehind), seen(0, LagCompensator::kMaxBehind + 20));
    same(seen(LagCompensator::kTicks, 3),
         seen(LagCompensator::kTicks + 100, 3));  // the oldest base that the compensator keeps
    ++objects;
  }
  EXPECT_GT(objects, 10);
}

TEST_F(LagCompensatorTest, UnknownTickOrObjectHasNoPosition) {
  tick();
  tick();
  std::map<std::uint32_t, Publisher::Model> before = published[world.tickNumber()];
  for (int i = 0; i < 300; ++i) tick();
  int gone = 0;
  for (const auto& [slot, model] : before) {
    const Publisher::Model* p_now = world.publisher.find(slot);
    if (p_now != nullptr && p_now->generation == model.generation) {
      EXPECT_FALSE(compensator.positionOf({slot, model.generation}, {}));
      continue;
    }
    EXPECT_FALSE(compensator.positionOf({slot, model.generation}, seen(0, 0)));
    ++gone;
  }
  EXPECT_GT(gone, 5);
  EXPECT_FALSE(compensator.positionOf({5000, 1}, seen(0, 0)));
}

TEST_F(LagCompensatorTest, AGapBetweenTicksClearsTheHistory) {
  for (int i = 0; i < 50; ++i) tick();
  world.tick();
  tick();
  for (const auto& [slot, model] : published[world.tickNumber()]) {
    EXPECT_EQ(compensator.positionOf({slot, model.generation}, seen(0, 0)),
              positionAt(model.state.motion, world.tickNumber()));
    EXPECT_FALSE(compensator.positionOf({slot, model.generation}, seen(1, 0)));
  }
}

CellPosition cellAt(df::FixedVector position) {
  return {df::cellOf(position.x), df::cellOf(position.y)};
}

/// Players whose views follow objects and who receive all snapshots. Records what each client knew at each
/// tick.
class LagCompensatorViews : public testing::Test {
 protected:
  static constexpr std::size_t kPlayers = 3;

  void tick() {
    world.tick();
    compensator.recordTick(world.publisher, world.view());
    for (std::size_t i = 0; i < kPlayers; ++i) {
      senders[i].applyTick(world.publisher, world.player(i));
      for (const auto& packet : senders[i].build(world.publisher, {64, kMaxSnapshot, false}))
        readers[i].read(packet.bytes);
      senders[i].acknowledge(readers[i].acks);
      known[world.tickNumber()].push_back(readers[i].replica);
    }
    known.erase(world.tickNumber() - LagCompensator::kTicks - 1);
  }

  test::PublishedWorld world{{.width = 200, .height = 80, .players = kPlayers, .refollow = 0.02}, 7};
  LagCompensator compensator;
  std::vector<SnapshotSender> senders{kPlayers, SnapshotSender(Resend::kOnGap)};
  std::vector<test::SnapshotReader> readers{kPlayers};
  std::map<std::uint32_t, std::vector<Replica>> known;  ///< tick -> each player's replica
};

TEST_F(LagCompensatorViews, MatchTheViewsThatClientsDrew) {
  SplitMix64 rng(3);
  int compared = 0;
  int scrolled = 0;
  for (int t = 0; t < 1500; ++t) {
    ASSERT_NO_FATAL_FAILURE(tick());
    if (t < 40) continue;
    for (std::size_t i = 0; i < kPlayers; ++i) {
      const auto drawn_age = static_cast<std::uint32_t>(rng.below(LagCompensator::kMaxBehind + 1));
      const auto base_age = drawn_age + static_cast<std::uint32_t>(rng.below(LagCompensator::kMaxBehind + 1));
      const df::ViewedTick seen{true, world.tickNumber() - base_age, world.tickNumber() - drawn_age};
      const Replica& replica = known.at(seen.base)[i];
      const ObjectState* p_followed = replica.followed();
      // The client does not know the object's earlier path, which matters only if the path was not straight.
      if (p_followed != nullptr && !(p_followed->motion.acceleration == df::FixedVector{})) continue;
      const auto corner = compensator.viewCornerOf(world.player(i).id, seen);
      ASSERT_TRUE(corner);
      EXPECT_EQ(cellAt(*corner), replica.viewCorner(seen.drawn))
          << "tick " << world.tickNumber() << ", player " << i << ", " << base_age << ", " << drawn_age;
      ++compared;
      scrolled += cellAt(*corner) == cellAt(world.player(i).view_corner) ? 0 : 1;
    }
  }
  EXPECT_GT(compared, 3000);
  EXPECT_GT(scrolled, 300) << "the present corner would have been wrong";
}

TEST_F(LagCompensatorViews, RejectUnknownPlayersAndClampOldTicks) {
  for (int t = 0; t < 50; ++t) ASSERT_NO_FATAL_FAILURE(tick());
  const std::uint32_t now = world.tickNumber();
  const std::uint32_t id = world.player(1).id;
  EXPECT_TRUE(compensator.viewCornerOf(id, {true, now, now}));
  EXPECT_FALSE(compensator.viewCornerOf(id, {}));
  EXPECT_FALSE(compensator.viewCornerOf(999, {true, now, now}));
  EXPECT_EQ(compensator.viewCornerOf(id, {true, now - 1000, now}),
            compensator.viewCornerOf(id, {true, now - LagCompensator::kTicks, now}));
  EXPECT_EQ(compensator.viewCornerOf(id, {true, now - 20, now - 100}),
            compensator.viewCornerOf(id, {true, now - 20, now - LagCompensator::kMaxBehind}));
}

TEST_F(LagCompensatorViews, AreNotCompensatedWhenPlayersSteerTheFollowedObject) {
  for (int t = 0; t < 50; ++t) ASSERT_NO_FATAL_FAILURE(tick());
  df::WorldView view = world.view();
  df::PlayerFacts& steers = view.players[0];
  steers.followed = {3, 1};
  steers.steering.object = steers.followed;
  compensator.recordTick(world.publisher, view);
  const df::ViewedTick seen{true, world.tickNumber(), world.tickNumber()};
  EXPECT_TRUE(compensator.viewCornerOf(steers.id, seen)) << "by no declared controls";
  steers.steering.p_table = std::make_shared<const df::ControlTable>();
  compensator.recordTick(world.publisher, view);
  EXPECT_FALSE(compensator.viewCornerOf(steers.id, seen)) << "the client draws it ahead";
  EXPECT_TRUE(compensator.viewCornerOf(view.players[1].id, seen));
  steers.steering.object = {4, 1};
  compensator.recordTick(world.publisher, view);
  EXPECT_TRUE(compensator.viewCornerOf(steers.id, seen)) << "the view follows another object than they steer";
}

TEST(SnapshotTicksTest, KnowsTheLastSnapshotsOnly) {
  SnapshotTicks ticks;
  EXPECT_FALSE(ticks.tickOf(0));
  EXPECT_FALSE(ticks.tickOf(1));
  for (std::uint32_t number = 1; number <= 300; ++number) ticks.recordSent(number, 1000 + number);
  EXPECT_EQ(ticks.tickOf(300), 1300u);
  EXPECT_EQ(ticks.tickOf(200), 1200u);
  EXPECT_FALSE(ticks.tickOf(100));
  EXPECT_FALSE(ticks.tickOf(301));
}

}  // namespace
}  // namespace naiad
