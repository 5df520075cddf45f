#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "SimulatedWorld.h"
#include "host/snapshot/ChangeIndex.h"
#include "host/snapshot/Interest.h"
#include "host/snapshot/InterestGrid.h"
#include "shared/values/SplitMix64.h"
#include "tests/support/Sanitizers.h"

namespace naiad {
namespace {

/// A window that stays, slides and jumps at random.
class Window {
 public:
  explicit Window(SplitMix64& rng) : m_rng(rng) {}

  CellRect next() {
    if (m_rng.below(40) == 0) m_dx = static_cast<std::int64_t>(m_rng.below(5)) - 2;
    if (m_rng.below(40) == 0) m_dy = static_cast<std::int64_t>(m_rng.below(3)) - 1;
    if (m_rng.below(20) == 0) m_dx = m_dy = 0;
    m_left += m_dx;
    m_top += m_dy;
    if (m_rng.below(60) == 0 || m_left < -60 || m_left > 160 || m_top < -40 || m_top > 80) {
      m_left = static_cast<std::int64_t>(m_rng.below(120)) - 20;
      m_top = static_cast<std::int64_t>(m_rng.below(60)) - 10;
    }
    return {m_left, m_top, m_left + 40, m_top + 20};
  }

 private:
  SplitMix64& m_rng;
  std::int64_t m_left = 10;
  std::int64_t m_top = 10;
  std::int64_t m_dx = 0;
  std::int64_t m_dy = 0;
};

// Checks in every tick: an object that isVisible() accepts is known, and an object that was not accepted,
// with kHysteresis, for more than kSearchInterval ticks is not known.
void expectPlain(const test::WorldConfig& config, std::uint64_t seed, bool stands, std::size_t& compared) {
  SplitMix64 rng(seed);
  test::PublishedWorld world(config, seed);
  Interest interest;
  KnownObjects known;
  Window window(rng);
  CellRect rect = window.next();
  std::map<std::uint64_t, std::uint32_t> near;  // slot and generation -> last tick in which it was accepted
  for (int i = 0; i < 300; ++i) {
    world.tick(i % 100 > 60);
    if (!stands) rect = window.next();
    const std::uint32_t tick = world.tickNumber();
    const df::ObjectKey own = world.player().followed;
    interest.update(world.publisher, {rect, {own, {}}, 4, static_cast<std::uint32_t>(seed)}, known);
    world.publisher.forEach([&](std::uint32_t slot, const Publisher::Model& model) {
      const std::uint32_t id = known.find(slot);
      const bool is_known = id != KnownObjects::kNone && known.at(id).generation == model.generation;
      const bool is_own = own == df::ObjectKey{slot, model.generation};
      if (is_own || Interest::isVisible(model, tick, 4, rect)) {
        ASSERT_TRUE(is_known) << "tick " << tick << ", slot " << slot;
      }
      std::uint32_t& last = near[std::uint64_t{slot} << 32 | model.generation];
      if (is_own || Interest::isVisible(model, tick, 4, rect.grownBy(Interest::kHysteresis))) last = tick;
      if (is_known) {
        ++compared;
        ASSERT_LE(tick - last, Interest::kSearchInterval) << "tick " << tick << ", slot " << slot;
      }
    });
    known.forEachAlive([&](std::uint32_t, const KnownObjects::Known& one) {
      const Publisher::Model* model = world.publisher.find(one.slot);
      ASSERT_TRUE(model != nullptr && model->generation == one.generation) << "tick " << tick;
    });
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(Interest, EqualsThePlainRuleInEveryTick) {
  for (const bool turns : {true, false}) {
    std::size_t compared = 0;
    for (std::uint64_t seed = 0; seed < (turns ? 120u : 40u) / test::kShare; ++seed) {
      SCOPED_TRACE((turns ? "seed " : "nothing ever turns, seed ") + std::to_string(seed));
      test::WorldConfig config{.objects = turns ? 20 + 5 * (seed % 30) : 150};
      config.turn = config.vanish = config.block = turns ? 0.02 * static_cast<double>(seed % 4) : 0;
      if (!turns) config.restyle = config.reshape = config.hide = 0;
      expectPlain(config, seed, seed % (turns ? 3 : 2) == 0, compared);
      if (testing::Test::HasFatalFailure()) return;
    }
    EXPECT_GT(compared, turns ? 100'000u / test::kShare : 10'000u);
  }
}

std::multiset<std::uint32_t> slotsNear(const InterestGrid& grid, const CellRect& rect) {
  std::multiset<std::uint32_t> slots;
  grid.forEachNear(rect, CellRect{}, [&](std::uint32_t slot) { slots.insert(slot); });
  return slots;
}

TEST(InterestGrid, RectanglesAreHalfOpen) {
  const CellRect rect{-2, 3, 5, 4};
  EXPECT_TRUE(rect.contains({-2, 3}));
  EXPECT_TRUE(rect.contains({4, 3}));
  EXPECT_FALSE(rect.contains({5, 3}));
  EXPECT_FALSE(rect.contains({-3, 3}));
  EXPECT_FALSE(rect.contains({0, 4}));
  EXPECT_FALSE(rect.contains({0, 2}));
  EXPECT_TRUE(rect.grownBy(1).contains({5, 4}));
  EXPECT_FALSE(rect.grownBy(1).contains({6, 4}));
}

TEST(InterestGrid, CompactRectanglesIntersectLikeFullOnes) {
  const CompactRect rect(CellRect{-2, 3, 5, 4});
  EXPECT_TRUE(rect.meets(CompactRect(CellRect{4, 3, 9, 9})));
  EXPECT_FALSE(rect.meets(CompactRect(CellRect{5, 3, 9, 9})));
  EXPECT_FALSE(rect.meets(CompactRect(CellRect{-9, 3, -2, 9})));
  EXPECT_FALSE(rect.meets(CompactRect(CellRect{4, 4, 9, 9})));
  EXPECT_FALSE(rect.meets(CompactRect(CellRect{4, -9, 9, 3})));
  constexpr std::int64_t kFar = std::int64_t{1} << 40;
  EXPECT_TRUE(rect.meets(CompactRect(CellRect{-kFar, -kFar, kFar, kFar})));
  EXPECT_FALSE(rect.meets(CompactRect(CellRect{kFar, -kFar, 2 * kFar, kFar})));
}

TEST(InterestGrid, FindsEachObjectOfARectangleOnce) {
  SplitMix64 rng(1);
  for (const std::int64_t world : {200, 20'000, 2'000'000'000}) {
    InterestGrid grid;
    std::map<std::uint32_t, CellPosition> plain;
    const auto coordinate = [&] {
      return static_cast<std::int32_t>(
          static_cast<std::int64_t>(rng.below(2 * static_cast<std::uint64_t>(world))) - world);
    };
    std::size_t found = 0;
    for (int i = 0; i < 20'000; ++i) {
      const auto slot = static_cast<std::uint32_t>(rng.below(500));
      if (rng.below(4) == 0) {
        grid.remove(slot);
        plain.erase(slot);
      } else {
        CellPosition& cell = plain[slot];
        cell = rng.below(2) == 0 ? CellPosition{cell.x + 1, cell.y - 1}
                                 : CellPosition{coordinate(), coordinate()};
        grid.put(slot, cell);
      }
      if (i % 20 != 0) continue;
      const std::int64_t x = coordinate();
      const std::int64_t y = coordinate();
      const auto extent =
          static_cast<std::int64_t>(rng.below(i % 40 == 0 ? 100 : static_cast<std::uint64_t>(world)));
      const CellRect rect{x, y, x + extent, y + extent / 2};
      const auto slots = slotsNear(grid, rect);
      for (const auto& [s, cell] : plain) {
        ASSERT_LE(slots.count(s), 1u);
        if (!rect.contains(cell)) continue;
        ASSERT_EQ(slots.count(s), 1u) << "slot " << s << ", step " << i;
        ++found;
      }
      for (const std::uint32_t s : slots) ASSERT_EQ(plain.count(s), 1u) << "removed";
    }
    EXPECT_GT(found, 100u);
  }
}

TEST(InterestGrid, SearchesFewBlocksOnly) {
  InterestGrid grid;
  std::uint32_t slot = 0;
  for (std::int32_t x = -1000; x < 1000; x += 32) {
    for (std::int32_t y = -1000; y < 1000; y += 16) grid.put(slot++, {x, y});
  }
  EXPECT_LE(slotsNear(grid, {0, 0, 80, 24}).size(), 5u * 4u);
  EXPECT_EQ(slotsNear(grid, {-5000, -5000, 5000, 5000}).size(), slot);
}

CompactRect randomRect(SplitMix64& rng) {
  const auto left = static_cast<std::int64_t>(rng.below(60)) - 30;
  const auto top = static_cast<std::int64_t>(rng.below(60)) - 30;
  return CompactRect({left, top, left + 1 + static_cast<std::int64_t>(rng.below(9)),
                      top + 1 + static_cast<std::int64_t>(rng.below(9))});
}

std::vector<std::size_t> marked(const ChangeIndex::Marks& marks) {
  std::vector<std::size_t> all;
  ChangeIndex::forEachMarked(marks, [&all](std::size_t i) { all.push_back(i); });
  return all;
}

TEST(ChangeIndex, MarksTheSameChangesAsAFullScan) {
  SplitMix64 rng(1);
  ChangeIndex index;
  ChangeIndex::Marks marks;
  for (std::size_t count = 0; count < 200; ++count) {
    index.clear();
    std::set<std::uint32_t> slots;
    while (slots.size() < count) slots.insert(static_cast<std::uint32_t>(rng.below(SlotBits::kBits)));
    const std::vector<std::uint32_t> changed(slots.begin(), slots.end());
    std::vector<CompactRect> sweeps;
    for (const std::uint32_t slot : changed) {
      sweeps.push_back(rng.below(8) == 0 ? CompactRect::nowhere() : randomRect(rng));
      index.add(slot, sweeps.back());
    }
    SlotBits known;
    for (int i = 0; i < 300; ++i) known.set(static_cast<std::uint32_t>(rng.below(SlotBits::kBits)));
    const CompactRect view = randomRect(rng);

    std::vector<std::size_t> meeting;
    std::vector<std::size_t> all;
    for (std::size_t i = 0; i < count; ++i) {
      if (sweeps[i].meets(view)) meeting.push_back(i);
      if (sweeps[i].meets(view) || known.has(changed[i])) all.push_back(i);
    }
    index.markMeeting(view, marks);
    EXPECT_EQ(marked(marks), meeting);
    index.markShared(known, marks);
    EXPECT_EQ(marked(marks), all);
  }
}

TEST(ChangeIndex, NowhereRectangleMeetsNothing) {
  EXPECT_FALSE(CompactRect::nowhere().meets(CompactRect::everywhere()));
  EXPECT_FALSE(CompactRect::nowhere().meets(CompactRect({-5, -5, 5, 5})));
  EXPECT_TRUE(CompactRect({-5, -5, 5, 5}).meets(CompactRect::everywhere()));
}

TEST(SlotBits, StoreSlotsModuloTheBitCount) {
  SlotBits bits;
  bits.set(70);
  EXPECT_TRUE(bits.has(70));
  EXPECT_TRUE(bits.has(70 + SlotBits::kBits));
  EXPECT_FALSE(bits.has(71));
  bits.clear(70);
  EXPECT_FALSE(bits.has(70));
}

}  // namespace
}  // namespace naiad
