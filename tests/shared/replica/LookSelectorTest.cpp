#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "RandomRecords.h"
#include "shared/replica/LookSelector.h"
#include "shared/values/SplitMix64.h"
#include "tests/support/CellsAt.h"

namespace naiad {
namespace {

// Compares the selector with a simple clock that counts ticks and changes the frame.
TEST(LookSelector, ClockAdvancesTheFrameEveryInterval) {
  for (const std::uint32_t begin : {0u, 1000u, 0xFFFFFFF0u}) {  // tick numbers may wrap
    for (const bool loop : {true, false}) {
      for (const std::size_t frames : {2u, 3u, 256u}) {
        const Selector clock = Selector::clock(begin, 3, loop, 1);
        std::size_t page = 1, shown = 0;
        for (std::uint32_t i = 0; i < 2000; ++i) {
          ASSERT_EQ(clock.at(begin + i, frames), page);
          if (++shown < 3) continue;
          shown = 0;
          page = page + 1 < frames ? page + 1 : loop ? 0 : page;
        }
      }
    }
  }
}

TEST(LookSelector, BeforeStartLoopsWrapOneShotsShowFirstFrame) {
  EXPECT_EQ(Selector::clock(100, 2).at(99, 5), 4u);
  EXPECT_EQ(Selector::clock(100, 2).at(90, 5), 0u);
  EXPECT_EQ(Selector::clock(100, 2, false).at(99, 5), 0u);
  EXPECT_EQ(Selector::clock(100, 2, false).at(7, 5), 0u);
}

// The selector must show the frame whose angle is nearest, or the higher one of two that are equally near.
TEST(LookSelector, AnAngleShowsTheNearestFrame) {
  test::RandomRecords random(1);
  for (int i = 0; i < 200'000; ++i) {
    const std::size_t frames = 2 + random.rng().below(kMaxFrames - 1);
    auto angle = static_cast<std::uint32_t>(random.rng().next());
    if (i % 2 == 0) {  // choose an angle close to a change of frames
      const std::uint64_t edge = ((2 * random.rng().below(frames) + 1) << 31) / frames;
      angle = static_cast<std::uint32_t>(edge + random.rng().below(5) - 2);
    }
    const std::size_t shown = Selector::turning(0, angle, 0).at(0, frames);
    ASSERT_LT(shown, frames);
    // The unit is 1/frames of 2^-32 turn, so half a frame is 2^31.
    const auto off = static_cast<std::int64_t>(std::uint64_t{angle} * frames - (std::uint64_t{shown} << 32));
    const auto whole = static_cast<std::int64_t>(frames) << 32;
    const std::int64_t around = off > whole / 2 ? off - whole : off;
    // Rounding half a frame down to a whole number loses less than `frames` units.
    ASSERT_GE(around, -(std::int64_t{1} << 31)) << angle << " of " << frames;
    ASSERT_LT(around, (std::int64_t{1} << 31) + (whole >> 32)) << angle << " of " << frames;
  }
}

TEST(LookSelector, AngleGrowsByItsSpinAcrossWraps) {
  test::RandomRecords random(2);
  for (int i = 0; i < 2000; ++i) {
    const auto spin = static_cast<std::int32_t>(random.rng().next());
    const auto begin = static_cast<std::uint32_t>(0 - random.rng().below(100));
    auto angle = static_cast<std::uint32_t>(random.rng().next());
    const Selector turning = Selector::turning(begin, angle, spin);
    for (std::uint32_t n = 0; n < 200; ++n) {
      ASSERT_EQ(turning.angleAt(begin + n), angle);
      angle += static_cast<std::uint32_t>(spin);
    }
  }
}

TEST(LookSelector, RebasedSelectorShowsTheSameFrames) {
  test::RandomRecords random(3);
  for (int i = 0; i < 5000; ++i) {
    const std::size_t frames = 2 + random.rng().below(20);
    const Selector selector = random.selector(frames);
    const auto tick = static_cast<std::uint32_t>(random.rng().below(1000));
    const Selector later = selector.rebased(tick, frames);
    for (std::uint32_t n = 0; n < 100; ++n)
      ASSERT_EQ(later.at(tick + n, frames), selector.at(tick + n, frames));
    ASSERT_EQ(later.rebased(tick, frames), later);
    ASSERT_TRUE(later.fits(frames));
    ASSERT_LT(later.age(tick, frames), frames * later.ticks_per_frame);
  }
}

TEST(LookSelector, SelectorsMustFitTheFrameCount) {
  EXPECT_TRUE(Selector::fixed(0).fits(1));
  EXPECT_TRUE(Selector::fixed(255).fits(256));
  EXPECT_FALSE(Selector::fixed(2).fits(2));
  EXPECT_TRUE(Selector::clock(0, 1).fits(2));
  EXPECT_TRUE(Selector::clock(0, kMaxTicksPerFrame).fits(256));
  EXPECT_FALSE(Selector::clock(0, 0).fits(2));
  EXPECT_FALSE(Selector::clock(0, kMaxTicksPerFrame + 1).fits(2));
  EXPECT_FALSE(Selector::clock(0, 1).fits(1));
  EXPECT_FALSE(Selector::turning(0, 0, 1).fits(1));
  EXPECT_FALSE(Selector::turning(0, 0, 1).fits(257));
}

using test::cellsAt;
constexpr std::int32_t kCell = 1 << kGlyphUnitBits;

TEST(Look, GlyphCellsRoundHalfUp) {
  EXPECT_EQ(glyphCell(cellsAt(3.25, -2.5), {}), (CellPosition{3, -2}));
  EXPECT_EQ(glyphCell(cellsAt(3.25, 0), {kCell / 4, 0, U'x', df::RED}), (CellPosition{4, 0}));
  EXPECT_EQ(glyphCell(cellsAt(3.25, 0), {kCell / 4 - 1, -kCell, U'x', df::RED}), (CellPosition{3, -1}));
}

TEST(Look, HalfCellOffsetsMatchFloatingPointRounding) {
  SplitMix64 rng(3);
  for (int i = 0; i < 10'000; ++i) {
    const double x = (rng.unit() - 0.5) * 1000;
    const double y = (rng.unit() - 0.5) * 1000;
    const double dx = static_cast<double>(static_cast<int>(rng.below(20)) - 10) / 2;
    const Glyph glyph{static_cast<std::int32_t>(dx * kCell), 0, U'x', df::RED};
    const CellPosition cell = glyphCell(cellsAt(x, y), glyph);
    ASSERT_EQ(cell.x, static_cast<int>(std::floor(df::toCells(cellsAt(x, y).x) + dx + 0.5)));
    ASSERT_EQ(cell.y, static_cast<int>(std::floor(df::toCells(cellsAt(x, y).y) + 0.5)));
  }
}

TEST(Look, DistantGlyphsWrapWithoutTrapping) {
  const df::Fixed most = std::numeric_limits<df::Fixed>::max();
  EXPECT_EQ(glyphCell({most, most}, {kCell, 0, U'x', df::RED}).x,
            std::numeric_limits<std::int32_t>::min() + 1);
}

TEST(Look, SelectsItsOnlyAppearanceAtEveryTick) {
  Look look;
  EXPECT_EQ(look.select(0), nullptr);
  look.sequence = {{{0, 0, U'@', df::CYAN}}};
  for (const std::uint32_t tick : {0u, 7u, 0xFFFFFFFFu}) EXPECT_EQ(look.select(tick), &look.sequence[0]);
}

}  // namespace
}  // namespace naiad
