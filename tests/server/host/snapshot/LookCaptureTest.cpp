#include <gtest/gtest.h>

#include <vector>

#include "host/snapshot/LookCapture.h"
#include "shared/replica/Limits.h"
#include "shared/replica/LookCodec.h"
#include "shared/values/SplitMix64.h"
#include "shared/values/Vector.h"
#include "tests/support/CellsAt.h"

namespace naiad {
namespace {

using test::cellsAt;
TEST(LookCapture, KeepsCharactersColoursAndOffsets) {
  const std::vector<df::DrawCommand> commands = {{cellsAt(10.25, 4), U'a', df::RED},
                                                 {cellsAt(8.75, 5), U'é', df::BLUE}};
  const Appearance appearance = captureAppearance(cellsAt(10.25, 4), commands);
  EXPECT_EQ(appearance, (Appearance{{0, 0, U'a', df::RED}, {-384, 256, U'é', df::BLUE}}));
}

TEST(LookCapture, NoticesEveryKindOfDifference) {
  const std::vector<df::DrawCommand> commands = {{cellsAt(1, 1), U'a', df::RED},
                                                 {cellsAt(2, 1), U'b', df::RED}};
  const Look look{{captureAppearance(cellsAt(1, 1), commands)}, 2};
  ASSERT_TRUE(drawsTheSame(look, 0, cellsAt(1, 1), commands));
  EXPECT_FALSE(drawsTheSame(look, 0, cellsAt(2, 1), commands));
  EXPECT_FALSE(drawsTheSame(look, 0, cellsAt(1, 1), std::span(commands).first(1)));
  EXPECT_FALSE(drawsTheSame(look, 0, cellsAt(1, 1), {}));
  EXPECT_FALSE(drawsTheSame(Look{}, 0, cellsAt(1, 1), commands));
  EXPECT_TRUE(drawsTheSame(Look{}, 0, cellsAt(1, 1), {}));
  for (int change = 0; change < 3; ++change) {
    std::vector<df::DrawCommand> other = commands;
    if (change == 0) other[1].ch = U'c';
    if (change == 1) other[1].color = df::BLUE;
    if (change == 2) other[1].position = cellsAt(2, 2);
    EXPECT_FALSE(drawsTheSame(look, 0, cellsAt(1, 1), other)) << change;
  }
}

TEST(LookCapture, LeavesOutDistantCharacters) {
  const std::vector<df::DrawCommand> commands = {{cellsAt(8192, 0), U'a', df::RED},
                                                 {cellsAt(8193, 0), U'b', df::RED}};
  EXPECT_EQ(captureAppearance(cellsAt(0, 0), commands).size(), 1u);
  EXPECT_EQ(captureCells(cellsAt(0, 0), commands).size(), 1u);
  const std::vector<df::DrawCommand> opposite = {{cellsAt(2e9, -2e9), U'a', df::RED}};
  EXPECT_TRUE(captureAppearance(cellsAt(-2e9, 2e9), opposite).empty());
  EXPECT_TRUE(captureCells(cellsAt(-2e9, 2e9), opposite).empty());
}

TEST(LookCapture, CutsAtTheLargestAppearance) {
  const std::vector<df::DrawCommand> commands(kMaxGlyphs + 5, {cellsAt(0, 0), U'x', df::RED});
  EXPECT_EQ(captureAppearance(cellsAt(0, 0), commands).size(), kMaxGlyphs);
}

TEST(LookCapture, TruncatesALookToFitARecord) {
  Appearance whole(kMaxGlyphs);
  SplitMix64 rng(3);
  for (Glyph& glyph : whole) {
    glyph = {static_cast<std::int32_t>(rng.below(90'000)), static_cast<std::int32_t>(rng.below(90'000)), U'█',
             static_cast<df::Color>(rng.below(8))};
  }
  ASSERT_GT(encodedBits({whole}), 8 * kMaxLookBytes);
  const Sequence fitted = fitToRecord(whole);
  EXPECT_LE(encodedBits(fitted), 8 * kMaxLookBytes);
  EXPECT_GT(encodedBits(fitted), 4 * kMaxLookBytes);
  ASSERT_EQ(fitted.size(), 1u);
  EXPECT_TRUE(std::equal(fitted[0].begin(), fitted[0].end(), whole.begin()));
  EXPECT_EQ(fitToRecord(fitted[0]), fitted);
}

}  // namespace
}  // namespace naiad
