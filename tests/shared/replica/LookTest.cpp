#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "shared/replica/Look.h"
#include "shared/values/SplitMix64.h"
#include "shared/values/Vector.h"
#include "tests/support/CellsAt.h"

namespace naiad {
namespace {

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
