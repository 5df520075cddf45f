#include <gtest/gtest.h>

#include <algorithm>

#include "engine/world/ViewCover.h"
#include "shared/values/SplitMix64.h"

namespace df {
namespace {

FixedVector cells(std::int64_t x, std::int64_t y) {
  return {x * kFixedOne, y * kFixedOne};
}

/// Compares ViewCover with a test of every view, for boxes of many sizes in and around the views.
void compare(std::size_t views, std::int64_t extent, std::uint64_t seed) {
  naiad::SplitMix64 random(seed);
  const auto within = [&](std::int64_t most) {
    return static_cast<std::int64_t>(random.below(static_cast<std::uint64_t>(2 * most + 1))) - most;
  };
  const FixedVector size = cells(20 + static_cast<std::int64_t>(random.below(80)), 10);
  std::vector<FixedVector> corners;
  for (std::size_t i = 0; i < views; ++i) corners.push_back(cells(within(extent), within(extent)));
  const ViewCover cover(corners, size);
  int met = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto fraction = static_cast<Fixed>(random.below(4)) * (kFixedOne / 4);
    const FixedVector corner =
        cells(within(extent + 100), within(extent + 30)) + FixedVector{fraction, fraction};
    const std::int64_t most = i % 10 == 0 ? 2 * extent : 6;
    const FixedBox box{corner, cells(within(most) + most, within(most) + most)};
    const bool expected = std::any_of(corners.begin(), corners.end(), [&](FixedVector at) {
      return intersects(box, {at, size});
    });
    ASSERT_EQ(cover.intersectsAny(box), expected) << views << " views, box " << i;
    met += expected ? 1 : 0;
  }
  EXPECT_EQ(met > 0, views > 0);
  EXPECT_LT(met, 3000);
}

TEST(ViewCoverTest, MatchesTestingEveryView) {
  for (const std::size_t views : {0u, 1u, 5u, 8u, 9u, 40u, 700u}) {
    for (const std::int64_t extent : {60, 400, 20'000}) compare(views, extent, views + 1000 * extent);
  }
}

}  // namespace
}  // namespace df
