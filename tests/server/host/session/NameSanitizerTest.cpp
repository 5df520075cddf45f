#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "host/session/NameSanitizer.h"
#include "shared/net/base/Limits.h"
#include "shared/values/Canvas.h"
#include "shared/values/SplitMix64.h"
#include "tests/support/HostileTexts.h"

namespace naiad {
namespace {

TEST(Names, BlanksAreTrimmedAndCollapsed) {
  EXPECT_EQ(cleanName("  Ann \t  Bee\u00a0 "), "Ann Bee");
  EXPECT_EQ(cleanName(" \t "), "");
  EXPECT_EQ(cleanName(""), "");
}

TEST(Names, CharactersThatDisturbATerminalAreRemoved) {
  EXPECT_EQ(cleanName("A\x1b[31mn\nn"), "A[31mnn");
  EXPECT_EQ(cleanName("\u202eevil\u200b"), "evil");
  EXPECT_EQ(cleanName("\xff\xfe\xc3"), "");
  EXPECT_EQ(cleanName("Zoë"), "Zoë");
}

TEST(Names, TextsOfEveryHostileClassAreMadeHarmless) {
  for (const test::HostileText& hostile : test::hostileTexts()) {
    for (const std::string& text : {cleanName("x" + hostile.bytes), cleanChat("x" + hostile.bytes)}) {
      EXPECT_EQ(text.front(), 'x') << hostile.what;
      for (const char32_t ch : df::decodeUtf8(text)) EXPECT_TRUE(df::isDrawable(ch)) << hostile.what;
    }
  }
}

TEST(Names, AreCutByCharactersNotBytes) {
  EXPECT_EQ(cleanName("ééééééééééééééééé"), "éééééééééééééééé");
  EXPECT_EQ(cleanName("123456789012345 x"), "123456789012345") << "no blank at the end after the cut";
}

TEST(Names, AnyBytesGiveADrawableNameThatFits) {
  SplitMix64 rng(1);
  for (int i = 0; i < 5000; ++i) {
    std::string bytes(rng.below(60), '\0');
    for (char& byte : bytes) byte = static_cast<char>(rng.next());
    const std::string name = cleanName(bytes);
    const std::u32string characters = df::decodeUtf8(name);
    ASSERT_LE(characters.size(), kMaxNameLength);
    for (const char32_t ch : characters) ASSERT_TRUE(df::isDrawable(ch));
    ASSERT_EQ(cleanName(name), name);
  }
}

TEST(Names, ATakenNameGetsTheLowestFreeNumber) {
  EXPECT_EQ(uniqueName("Ann", {}), "Ann");
  EXPECT_EQ(uniqueName("Ann", {"ann"}), "Ann2");
  EXPECT_EQ(uniqueName("Ann", {"Ann", "ANN2", "Ann4"}), "Ann3");
}

TEST(Names, ConfusableNamesCountAsTaken) {
  const std::pair<const char*, const char*> alike[] = {
      {"ann", "ANN"},                 // different case
      {"ZOË", "zoë"},                 // also beyond ASCII
      {"\u0410NN", "ANN"},            // Cyrillic A among Latin letters
      {"\u0410nn", "ann"},            // also in different case
      {"\u0391nn", "Ann"},            // Greek Alpha
      {"\u039Cark", "mark"},          // Greek Mu, whose small letter looks different
      {"\u0421\u0410\u0420", "CAP"},  // entirely Cyrillic
      {"Ilse", "llse"},               // capital i, small L
      {"1lse", "Ilse"},               // digit 1
      {"B0b", "BOb"},                 // zero and capital O
      {"B0B", "bob"},
      {"\u0131van", "ivan"},        // dotless i
      {"Ann\u2013Bee", "Ann-Bee"},  // dashes
  };
  for (const auto& [name, taken] : alike) {
    EXPECT_EQ(uniqueName(name, {taken}), std::string(name) + "2") << taken;
    EXPECT_EQ(uniqueName(taken, {name}), std::string(taken) + "2") << name;
  }
}

TEST(Names, DistinguishableNamesDoNotCountAsTaken) {
  for (const auto& [name, taken] :
       std::initializer_list<std::pair<const char*, const char*>>{{"Ann", "Anna"},
                                                                  {"Zoe", "Zoë"},
                                                                  {"Ann2", "Ann3"},
                                                                  {"Мария", "Мар"},
                                                                  {"Ann Bee", "AnnBee"},
                                                                  {"Σ", "E"}}) {
    EXPECT_EQ(uniqueName(name, {taken}), name) << taken;
  }
}

TEST(Names, ConfusableNamesShareTheirNumbering) {
  EXPECT_EQ(uniqueName("\u0410NN", {"ANN", "\u0410nn2"}), "\u0410NN3");
}

TEST(Names, FullWidthLettersAreNotDrawnAtAll) {
  EXPECT_EQ(cleanName("\uFF21nn"), "nn") << "two cells wide";
}

TEST(Names, NumbersDoNotMakeANameTooLong) {
  const std::string longest(kMaxNameLength, 'x');
  std::vector<std::string> taken = {longest};
  for (int i = 0; i < 12; ++i) {
    taken.push_back(uniqueName(longest, taken));
    EXPECT_LE(taken.back().size(), kMaxNameLength);
  }
  EXPECT_EQ(taken[1], std::string(kMaxNameLength - 1, 'x') + "2");
  EXPECT_EQ(taken[9], std::string(kMaxNameLength - 2, 'x') + "10");
}

TEST(Names, ChatIsCleanedAndCutToo) {
  EXPECT_EQ(cleanChat("  hello\x1b  there "), "hello there");
  EXPECT_EQ(df::decodeUtf8(cleanChat(std::string(500, 'a'))).size(), kMaxChatLength);
}

}  // namespace
}  // namespace naiad
