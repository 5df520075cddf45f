#include <gtest/gtest.h>

#include <string>

#include "shared/values/Canvas.h"

namespace df {
namespace {

std::string utf8(char32_t ch) {
  std::string out;
  appendUtf8(out, ch);
  return out;
}

TEST(Canvas, IsBlankAtFirstAndAfterClear) {
  Canvas canvas(3, 2);
  EXPECT_EQ(canvas.text(), "\n\n");
  canvas.put(1, 1, {U'x', RED});
  canvas.clear();
  EXPECT_EQ(canvas.at(1, 1), Cell{});
}

TEST(Canvas, DropsCellsOutside) {
  Canvas canvas(3, 2);
  for (const auto& [x, y] : {std::pair{-1, 0}, {3, 0}, {0, -1}, {0, 2}}) canvas.put(x, y, {U'x', RED});
  EXPECT_EQ(countDifferences(canvas, Canvas(3, 2)), 0);
  EXPECT_EQ(canvas.at(-1, 5), Cell{});
}

TEST(Canvas, TextTrimsRowsAndRowTextDoesNot) {
  Canvas canvas(4, 2);
  canvas.put(1, 0, {U'é', GREEN});
  canvas.put(0, 1, {U'─', GREEN});
  EXPECT_EQ(canvas.text(), " é\n─\n");
  EXPECT_EQ(canvas.rowText(0), " é  ");
}

TEST(Canvas, BlanksOfAnyColourAreEqual) {
  EXPECT_EQ((Cell{U' ', RED}), (Cell{U' ', BLUE}));
  EXPECT_FALSE((Cell{U'a', RED}) == (Cell{U'a', BLUE}));
  EXPECT_FALSE((Cell{U'a', RED}) == (Cell{U'b', RED}));
}

TEST(Canvas, CountsDifferences) {
  Canvas a(5, 4);
  Canvas b(5, 4);
  a.put(0, 0, {U'a', RED});
  b.put(4, 3, {U'a', RED});
  EXPECT_EQ(countDifferences(a, b), 2);
  EXPECT_EQ(countDifferences(a, a), 0);
  EXPECT_EQ(countDifferences(a, Canvas(6, 2)), 6 * 4);
}

TEST(Canvas, NegativeSizesAreEmpty) {
  const Canvas canvas(-3, 4);
  EXPECT_EQ(canvas.width(), 0);
  EXPECT_EQ(canvas.at(0, 0), Cell{});
}

TEST(Utf8, EveryCodePointSurvivesTheRoundTrip) {
  for (char32_t ch = 0; ch <= 0x10FFFF; ++ch) {
    if (ch == 0xD800) ch = 0xE000;
    ASSERT_EQ(decodeUtf8(utf8(ch)), std::u32string(1, ch));
  }
}

TEST(Utf8, MalformedBytesBecomeReplacementCharacters) {
  constexpr char32_t bad = 0xFFFD;
  const auto all_bad = [](const std::string& text) {
    return decodeUtf8(text) == std::u32string(text.size(), bad);
  };
  EXPECT_TRUE(all_bad("\x80"));
  EXPECT_TRUE(all_bad("\xC0\xAF"));          // overlong '/'
  EXPECT_TRUE(all_bad("\xE0\x80\xAF"));      // overlong
  EXPECT_TRUE(all_bad("\xED\xA0\x80"));      // surrogate
  EXPECT_TRUE(all_bad("\xF4\x90\x80\x80"));  // above U+10FFFF
  EXPECT_TRUE(all_bad("\xE2\x94"));          // truncated
  EXPECT_TRUE(all_bad("\xFF"));
  EXPECT_EQ(decodeUtf8("a\xE2z"), (std::u32string{U'a', bad, U'z'}));
}

TEST(Drawable, AcceptsOrdinaryCharacters) {
  for (const char32_t ch : std::u32string(U" ~aéΩд│█●⠿→≈"))
    EXPECT_TRUE(isDrawable(ch)) << std::hex << static_cast<std::uint32_t>(ch);
}

TEST(Drawable, RejectsCharactersThatDisruptATerminal) {
  for (const char32_t ch : {U'\0',     U'\n',     U'\x1b',   U'\x7f',   U'\u0085', U'\u009b', U'\u00ad',
                            U'\u0300', U'\u0301', U'\u200b', U'\u200d', U'\u200e', U'\u202a', U'\u202e',
                            U'\u2066', U'\ufeff', U'\u4e00', U'\u1100', U'\uff21', U'\ufffd'}) {
    EXPECT_FALSE(isDrawable(ch)) << std::hex << static_cast<std::uint32_t>(ch);
  }
  EXPECT_FALSE(isDrawable(0x1F600));
  EXPECT_FALSE(isDrawable(0x10FFFF));
  EXPECT_FALSE(isDrawable(0xFFFFFFFF));
}

}  // namespace
}  // namespace df
