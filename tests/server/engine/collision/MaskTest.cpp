#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "engine/collision/Mask.h"

namespace df::test {
namespace {

Mask maskOf(const std::vector<std::string>& rows, char32_t hole = U' ') {
  const auto mask = Mask::fromRows(rows, hole);
  EXPECT_TRUE(mask.has_value());
  return mask.value_or(Mask{});
}

// Draws a mask: '#' where a character is set, '.' elsewhere.
std::vector<std::string> picture(const Mask& mask) {
  std::vector<std::string> rows(static_cast<std::size_t>(mask.height()));
  for (int y = 0; y < mask.height(); ++y) {
    for (int x = 0; x < mask.width(); ++x) rows[static_cast<std::size_t>(y)] += mask.isSet(x, y) ? '#' : '.';
  }
  return rows;
}

using Rows = std::vector<std::string>;

TEST(Mask, BlanksAreHoles) {
  EXPECT_EQ(picture(maskOf({"  /\\  ", " /##\\ ", "/_||_\\"})), (Rows{"..##..", ".####.", "######"}));
}

TEST(Mask, ShorterRowsArePaddedWithHoles) {
  EXPECT_EQ(picture(maskOf({"#", "", "###", " #"})), (Rows{"#..", "...", "###", ".#."}));
}

TEST(Mask, TransparencyCharacterIsAHole) {
  EXPECT_EQ(picture(maskOf({"a.b", " .c"}, U'.')), (Rows{"#.#", "..#"}));
  EXPECT_EQ(picture(maskOf({"█░█"}, U'░')), (Rows{"#.#"}));
}

TEST(Mask, CharactersAreCountedNotBytes) {
  EXPECT_EQ(picture(maskOf({"é █", "ab€c"})), (Rows{"#.#.", "####"}));
  EXPECT_EQ(picture(maskOf({"\xff \xe2\x82"})), (Rows{"#.##"})) << "a malformed byte is one character";
}

TEST(Mask, EmptyMaskSharesNoCell) {
  const Mask mask = maskOf({"  ", " "});
  const FixedBox box = {{}, {2 * kFixedOne, 2 * kFixedOne}};
  EXPECT_EQ(picture(mask), (Rows{"..", ".."}));
  EXPECT_FALSE(shareCell(&mask, box, nullptr, box));
  EXPECT_FALSE(shareCell(&mask, box, &mask, box));
}

TEST(Mask, EmptyAndOversizedMasksAreRefused) {
  const auto side = static_cast<std::size_t>(Mask::kMaxSide);
  EXPECT_FALSE(Mask::fromRows({}));
  EXPECT_FALSE(Mask::fromRows({""}));
  EXPECT_FALSE(Mask::fromRows({"", ""}));
  EXPECT_FALSE(Mask::fromRows({"#", std::string(side + 1, '#')}));
  EXPECT_FALSE(Mask::fromRows(Rows(side + 1, "#")));
  const Mask largest = maskOf(Rows(side, std::string(side, '#')));
  EXPECT_EQ(largest.width(), Mask::kMaxSide);
  EXPECT_EQ(largest.height(), Mask::kMaxSide);
  EXPECT_TRUE(largest.isSet(Mask::kMaxSide - 1, Mask::kMaxSide - 1));
  std::string wide;
  for (std::size_t i = 0; i < side; ++i) wide += "█";
  EXPECT_EQ(maskOf({wide}).width(), Mask::kMaxSide) << "the limit is one of characters";
}

TEST(Mask, CellsOutsideTheMaskAreNotSet) {
  const Mask mask = maskOf(Rows(3, std::string(70, '#')));
  EXPECT_TRUE(mask.isSet(69, 2));
  for (const auto& [x, y] : std::vector<std::pair<int, int>>{
           {-1, 0}, {0, -1}, {70, 0}, {0, 3}, {127, 0}, {INT32_MIN, INT32_MIN}, {INT32_MAX, INT32_MAX}}) {
    EXPECT_FALSE(mask.isSet(x, y)) << x << ' ' << y;
  }
}

TEST(Mask, FirstCharacterLiesInTheCellAfterTheCorner) {
  const Fixed half = kFixedOne / 2;
  using Cells = std::array<std::int64_t, 4>;  // x, y, width, height
  const auto cells = [](FixedVector corner, FixedVector size) {
    const CellBox box = drawnCells(nullptr, {corner, size});
    return Cells{box.x, box.y, box.width, box.height};
  };
  // The box of a single character at (7,3).
  EXPECT_EQ(cells({7 * kFixedOne - half, 3 * kFixedOne - half}, {kFixedOne, kFixedOne}), (Cells{7, 3, 1, 1}));
  EXPECT_EQ(cells({-1, -kFixedOne - 1}, {0, kFixedOne + 1}), (Cells{0, -1, 1, 2}));
  EXPECT_EQ(cells({fromCells(-2001000000), fromCells(2001000000)}, {fromCells(1000000), 0}),
            (Cells{-2000999999, 2001000001, 1000000, 1}));
}

TEST(Mask, FullMasksOfHugeBoxesNeedNoRows) {
  const FixedBox huge = {{fromCells(-2001000000), fromCells(-2001000000)},
                         {fromCells(1000000), fromCells(1000000)}};
  FixedBox other = translate(huge, {fromCells(999999), fromCells(999999)});
  EXPECT_TRUE(shareCell(nullptr, huge, nullptr, other));
  EXPECT_FALSE(shareCell(nullptr, huge, nullptr, translate(other, {0, kFixedOne})));
  const Mask dots = maskOf({"#    ", "    #"});
  other = {{fromCells(-2001000003), fromCells(-2001000001)}, {fromCells(5), fromCells(2)}};
  EXPECT_TRUE(shareCell(nullptr, huge, &dots, other));
  other.corner.y = fromCells(-2000000001);
  EXPECT_FALSE(shareCell(nullptr, huge, &dots, other));
}

}  // namespace
}  // namespace df::test
