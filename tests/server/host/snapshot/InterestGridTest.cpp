#include <gtest/gtest.h>

#include <map>
#include <set>

#include "host/snapshot/InterestGrid.h"
#include "shared/values/SplitMix64.h"

namespace naiad {
namespace {

std::multiset<std::uint32_t> near(const InterestGrid& grid, const CellRect& rect) {
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
      const auto slots = near(grid, rect);
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
  EXPECT_LE(near(grid, {0, 0, 80, 24}).size(), 5u * 4u);
  EXPECT_EQ(near(grid, {-5000, -5000, 5000, 5000}).size(), slot);
}

}  // namespace
}  // namespace naiad
