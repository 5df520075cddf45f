#include <gtest/gtest.h>

#include <cstdlib>

#include "client/world/ExtrapolationClamp.h"
#include "client/world/ReplicaBarriers.h"
#include "shared/values/SplitMix64.h"
#include "shared/values/Vector.h"
#include "tests/support/CellsAt.h"

namespace naiad {
namespace {

using df::FixedVector;
using df::fromCells;
using df::kFixedOne;
using test::cellsAt;

constexpr std::uint32_t kKnown = 50;

class ExtrapolationClampTest : public testing::Test {
 protected:
  std::uint32_t add(FixedVector position, FixedVector velocity = {}, df::Solidness solidness = df::HARD,
                    df::FixedBox box = {{-kFixedOne / 2, -kFixedOne / 2}, {kFixedOne, kFixedOne}}) {
    ObjectRecord record{m_slot, 1, kAllGroups, {}};
    record.state.order = m_slot;
    record.state.motion = {kKnown, position, velocity, {}};
    record.state.body = {box, solidness, false};
    Snapshot snapshot;
    snapshot.header.number = ++m_number;
    snapshot.header.tick = kKnown;
    snapshot.records.objects = {record};
    replica.apply(snapshot);
    return m_slot++;
  }
  FixedVector clamped(std::uint32_t slot, std::uint32_t ahead) const {
    return clampedPosition(replica, replica.find(slot)->state, kKnown, kKnown + ahead);
  }
  Replica replica;

 private:
  std::uint32_t m_slot = 1;
  std::uint32_t m_number = 0;
};

TEST_F(ExtrapolationClampTest, LongExtrapolationsAndPastTicksAreNotClamped) {
  const auto ball = add(cellsAt(10, 5), cellsAt(1, 0));
  add(cellsAt(14, 5));
  EXPECT_EQ(clamped(ball, ExtrapolationClamp::kMaxTicks + 1), cellsAt(27, 5));
  EXPECT_EQ(clampedPosition(replica, replica.find(ball)->state, kKnown, kKnown - 2), cellsAt(8, 5));
}

/// Computes the rule in its simplest form: all pairs, tick by tick.
FixedVector plainly(const Replica& replica, const ObjectState& mover, std::uint32_t drawn) {
  const auto touches = [&](const ObjectState& other, std::uint32_t tick) {
    const bool moved = tick == kKnown || other.order < mover.order;
    return df::intersects(*boxAt(mover.body, positionAt(mover.motion, tick)),
                          *boxAt(other.body, positionAt(other.motion, moved ? tick : tick - 1)));
  };
  if (mover.body.solidness != df::HARD) return positionAt(mover.motion, drawn);
  for (std::uint32_t tick = kKnown + 1; tick != drawn + 1; ++tick) {
    for (const auto& [slot, entry] : replica.entries()) {
      const ObjectState& other = entry.state;
      if (other.order == mover.order || other.body.solidness != df::HARD || touches(other, kKnown)) continue;
      if (touches(other, tick)) return positionAt(mover.motion, tick - 1);
    }
  }
  return positionAt(mover.motion, drawn);
}

/// Expects the positions of the reference in tick `drawn`. Returns the number of objects that are held back.
int expectPlain(const Replica& replica, std::uint32_t drawn) {
  int held = 0;
  const ExtrapolationClamp clamp(replica, kKnown, drawn);
  EXPECT_FALSE(clamp.isExhausted());
  for (const auto& [slot, entry] : replica.entries()) {
    const FixedVector wanted = plainly(replica, entry.state, drawn);
    EXPECT_EQ(clamp.positionOf(entry.state), wanted) << "slot " << slot;
    held += wanted != positionAt(entry.state.motion, drawn) ? 1 : 0;
  }
  return held;
}

TEST_F(ExtrapolationClampTest, MatchesTheReferenceForRandomObjects) {
  int held = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SplitMix64 rng(seed);
    replica = Replica();
    for (int i = 0; i < 200; ++i) {
      const bool large = rng.below(20) == 0;
      const auto side = [&] { return 0.5 + rng.unit() * (large ? 90 : 3); };
      const double w = side();
      const double h = side();
      const double x = rng.unit() * 160 - 40;
      const double y = rng.unit() * 80 - 40;
      const double vx = rng.below(2) == 0 ? 0 : rng.unit() * 4 - 2;
      const double vy = rng.below(2) == 0 ? 0 : rng.unit() * 2 - 1;
      add(cellsAt(x, y), cellsAt(vx, vy), static_cast<df::Solidness>(rng.below(3)),
          {cellsAt(-w / 2, -h / 2), cellsAt(w, h)});
    }
    SCOPED_TRACE("seed " + std::to_string(seed));
    held += expectPlain(replica, kKnown + 1 + static_cast<std::uint32_t>(rng.below(8)));
  }
  EXPECT_GT(held, 300);
}

/// Many small objects that move in one spot.
class CrowdedSpotTest : public ExtrapolationClampTest {
 protected:
  void fill(int count) {
    SplitMix64 rng(7);
    Snapshot snapshot;
    snapshot.header.number = 1'000'000;
    snapshot.header.tick = kKnown;
    for (int i = 0; i < count; ++i) {
      ObjectRecord record{static_cast<std::uint32_t>(1000 + i), 1, kAllGroups, {}};
      record.state.order = record.id;
      // Separate statements, because compilers may order the calls in an expression differently.
      const double y = 12 + rng.unit(), x = 40 + rng.unit();
      const double down = rng.unit() * 0.2 - 0.1, right = rng.unit() * 0.4 - 0.2;
      record.state.motion = {kKnown, cellsAt(x, y), cellsAt(right, down), {}};
      record.state.body = {{{0, 0}, {kFixedOne / 50, kFixedOne / 50}}, df::HARD, false};
      snapshot.records.objects.push_back(record);
    }
    replica.apply(snapshot);
  }
};

TEST_F(CrowdedSpotTest, TwoHundredObjectsMatchTheReference) {
  fill(200);
  EXPECT_GT(expectPlain(replica, kKnown + 8), 20);
}

// Counts units of work, about ten nanoseconds each, so the result does not depend on the processor.
TEST_F(CrowdedSpotTest, WorkIsLimitedForAnyNumberOfObjects) {
  for (const int count : {1'000, 4'000, 48'000}) {
    replica = Replica();
    fill(count);
    const ExtrapolationClamp clamp(replica, kKnown, kKnown + ExtrapolationClamp::kMaxTicks);
    EXPECT_TRUE(clamp.isExhausted()) << count;
    EXPECT_LE(clamp.work(), ExtrapolationClamp::kMaxWork + 1'000) << count;
    for (const auto& [slot, entry] : replica.entries()) {
      // The object is drawn at some point of its path.
      const FixedVector drawn = clamp.positionOf(entry.state);
      const FixedVector from = positionAt(entry.state.motion, kKnown);
      EXPECT_LE(std::abs(drawn.x - from.x), fromCells(4)) << slot;
    }
  }
}

TEST_F(CrowdedSpotTest, LeavesWorkForObjectsElsewhere) {
  fill(2'000);
  const auto ball = add(cellsAt(10, 5), cellsAt(1, 0));
  add(cellsAt(14, 5));
  const ExtrapolationClamp clamp(replica, kKnown, kKnown + 8);
  ASSERT_TRUE(clamp.isExhausted());
  EXPECT_EQ(clamp.positionOf(replica.find(ball)->state), cellsAt(12, 5)) << "before its wall";
}

TEST_F(CrowdedSpotTest, WorkIsLimitedForLargeObjects) {
  for (int i = 0; i < 3'000; ++i)
    add(cellsAt(i % 50, i % 20), cellsAt(0.1, 0.1), df::HARD, {cellsAt(-50, -50), cellsAt(100, 100)});
  const ExtrapolationClamp clamp(replica, kKnown, kKnown + 8);
  EXPECT_LE(clamp.work(), ExtrapolationClamp::kMaxWork + 1'000);
}

}  // namespace
}  // namespace naiad
