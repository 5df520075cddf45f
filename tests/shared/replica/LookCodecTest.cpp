#include <gtest/gtest.h>

#include "LegalRecords.h"
#include "Limits.h"
#include "LookCodec.h"
#include "RandomRecords.h"

namespace naiad {
namespace {

using test::RandomRecords;

/// What a reader met.
struct Met {
  Look look;
  std::optional<std::uint32_t> defined;
  std::optional<std::uint32_t> named;
  Appearance definition;
  bool whole = false;  ///< nothing missing, nothing left
};

Met read(std::string_view bytes, const Appearance* known = nullptr) {
  Met met;
  BitReader in(bytes);
  met.look = readLook(
      in,
      [&](std::uint32_t id, const Appearance& a) {
        met.defined = id;
        met.definition = a;
      },
      [&](std::uint32_t id) {
        met.named = id;
        return known;
      });
  met.whole = in.atEnd();
  return met;
}

std::string write(const Look& look, LookForm form = {}) {
  BitWriter out;
  writeLook(out, look, form);
  return out.bytes();
}

Look word(const char* text, df::Color color = df::GREEN) {
  Look look;
  Appearance& glyphs = look.sequence.emplace_back();
  for (int x = 0; *text != '\0'; ++text, x += 256)
    glyphs.push_back({x, 0, static_cast<char32_t>(*text), color});
  return look;
}

TEST(LookCodec, RandomLooksSurviveTheRoundTrip) {
  RandomRecords random(1);
  for (int i = 0; i < 5000; ++i) {
    const Look look = random.look();
    const Met met = read(write(look));
    ASSERT_TRUE(met.whole) << i;
    ASSERT_EQ(met.look, look) << i;
    ASSERT_FALSE(met.defined || met.named);
  }
}

TEST(LookCodec, ADefinitionTellsIdAndAppearance) {
  const Look look = word("saucer");
  const Met met = read(write(look, {LookForm::kDefined, 4095}));
  EXPECT_TRUE(met.whole);
  EXPECT_EQ(met.look, look);
  EXPECT_EQ(met.defined, 4095u);
  EXPECT_EQ(met.definition, look.sequence[0]);
  EXPECT_FALSE(met.named);
}

TEST(LookCodec, ANameStandsForWhatIsKnown) {
  Look look = word("saucer");
  look.altitude = 4;
  const std::string bytes = write(look, {LookForm::kNamed, 77});
  EXPECT_LE(bytes.size(), 3u);
  const Met met = read(bytes, &look.sequence[0]);
  EXPECT_TRUE(met.whole);
  EXPECT_EQ(met.named, 77u);
  EXPECT_EQ(met.look, look);
}

TEST(LookCodec, SingleCharactersAndNothingNeedNoName) {
  for (const LookForm form : {LookForm{}, LookForm{LookForm::kNamed, 3}, LookForm{LookForm::kDefined, 3}}) {
    for (const Look& look : {Look{}, Look{{{{0, 0, U'@', df::CYAN}}}, 2}}) {
      const Met met = read(write(look, form));
      EXPECT_TRUE(met.whole);
      EXPECT_EQ(met.look, look);
      EXPECT_FALSE(met.defined || met.named);
    }
  }
  EXPECT_TRUE(isSingleCharacter({{0, 0, U'@', df::CYAN}}));
  EXPECT_FALSE(isSingleCharacter({{1, 0, U'@', df::CYAN}}));
  EXPECT_FALSE(isSingleCharacter({{0, -1, U'@', df::CYAN}}));
  EXPECT_FALSE(isSingleCharacter({}));
}

TEST(LookCodec, WordsAreShort) {
  // Behind the first one a letter is: not moved, not recoloured, narrow, 7 bits.
  EXPECT_EQ(encodedBits(word("saucers").sequence[0]) - encodedBits(word("saucer").sequence[0]), 10u);
  BitWriter one;
  writeLook(one, {{{{0, 0, U'@', df::CYAN}}}, 2}, {});
  EXPECT_EQ(one.bitCount(), 14u);
}

TEST(LookCodec, EncodedBitsAreWhatASpelledLookTakes) {
  RandomRecords random(2);
  for (int i = 0; i < 500; ++i) {
    const Look look = random.look();
    if (look.sequence.empty() || isSingleCharacter(look.sequence[0])) continue;
    BitWriter out;
    writeLook(out, look, {});
    ASSERT_EQ(out.bitCount(), encodedBits(look.sequence[0]) + (look.altitude == 2 ? 1u : 9u) + 2 + 1);
  }
}

TEST(LookCodec, EveryDrawableCharacterAndNoOtherIsRead) {
  for (char32_t ch = 0; ch < 1u << 14; ++ch) {
    BitWriter out;
    writeCharacter(out, ch);
    const std::string bytes = out.bytes();
    BitReader in(bytes);
    const char32_t back = readCharacter(in);
    ASSERT_EQ(in.ok(), df::isDrawable(ch)) << static_cast<std::uint32_t>(ch);
    if (in.ok()) {
      ASSERT_TRUE(back == ch) << static_cast<std::uint32_t>(ch);
    }
  }
  // Those that 14 bits cannot name.
  for (char32_t ch = 1u << 14; ch < 0x110000; ++ch) ASSERT_FALSE(df::isDrawable(ch));
}

TEST(LookCodec, GlyphsFartherThanAllowedAreRefused) {
  const auto isRead = [](std::int32_t dx, std::int32_t dy) {
    return read(write({{{{0, 0, U'a', df::RED}, {dx, dy, U'b', df::RED}}}, 2})).whole;
  };
  const auto most = static_cast<std::int32_t>(kMaxGlyphOffset);
  EXPECT_TRUE(isRead(most, -most));
  EXPECT_TRUE(isRead(-most, most));
  EXPECT_FALSE(isRead(most + 1, 0));
  EXPECT_FALSE(isRead(-most - 1, 0));
  EXPECT_FALSE(isRead(0, most + 1));
  EXPECT_FALSE(isRead(0, -most - 1));
}

// Each glyph is one step farther than the last without saying so.
TEST(LookCodec, GlyphsThatWalkTooFarAreRefused) {
  const auto start = static_cast<std::int32_t>(kMaxGlyphOffset) - 256;
  Look look{{{{start, 0, U'a', df::RED}, {start + 256, 0, U'b', df::RED}}}, 2};
  EXPECT_TRUE(read(write(look)).whole);
  look.sequence[0].push_back({start + 512, 0, U'c', df::RED});
  EXPECT_FALSE(read(write(look)).whole);
}

TEST(LookCodec, TheLargestAppearanceFitsAndALargerOneIsRefused) {
  Look look{{Appearance(kMaxGlyphs, Glyph{0, 0, U'#', df::RED})}, 2};
  EXPECT_EQ(read(write(look)).look, look);
  BitWriter out;
  out.flag(true);
  out.bits(2, 2);
  out.flag(false);
  out.golomb(kMaxGlyphs + 1, 3);
  for (int i = 0; i < 200'000; ++i) out.flag(false);
  EXPECT_FALSE(read(out.bytes()).whole);
}

TEST(LookCodec, ACountThatIsOnlyClaimedCostsNothing) {
  BitWriter out;
  out.flag(true);
  out.bits(2, 2);
  out.flag(false);
  out.golomb(kMaxGlyphs, 3);
  const Met met = read(out.bytes());
  EXPECT_FALSE(met.whole);
  EXPECT_LE(met.look.sequence.at(0).capacity(), 8u);
}

TEST(LookCodec, BodiesSurviveTheRoundTrip) {
  RandomRecords random(3);
  for (int i = 0; i < 3000; ++i) {
    Body body = random.body();
    if (i % 3 == 0) body.box = Body{}.box;
    BitWriter out;
    writeBody(out, body);
    if (i % 3 == 0) {
      ASSERT_EQ(out.bitCount(), 4u);
    }
    const std::string bytes = out.bytes();
    BitReader in(bytes);
    ASSERT_EQ(readBody(in), body);
    ASSERT_TRUE(in.atEnd());
  }
}

TEST(LookCodec, BodiesOutOfRangeAreRefused) {
  const auto isRead = [](const Body& body) {
    BitWriter out;
    writeBody(out, body);
    const std::string bytes = out.bytes();
    BitReader in(bytes);
    readBody(in);
    return in.ok();
  };
  const df::Fixed most = df::fromCells(1'000'001);
  EXPECT_TRUE(isRead({{{-most, most}, {most, 0}}, df::SPECTRAL, true}));
  EXPECT_FALSE(isRead({{{-most - 1, 0}, {1, 1}}, df::HARD, false}));
  EXPECT_FALSE(isRead({{{0, 0}, {1, most + 1}}, df::HARD, false}));
  EXPECT_FALSE(isRead({{{0, 0}, {-1, 1}}, df::HARD, false}));
  EXPECT_FALSE(isRead({{{0, 0}, {1, -1}}, df::HARD, false}));
  EXPECT_FALSE(isRead({Body{}.box, static_cast<df::Solidness>(3), false}));
}

TEST(LookCodec, HostileBytesAreRefusedOrLegal) {
  RandomRecords random(4);
  int accepted = 0;
  for (int i = 0; i < 100'000; ++i) {
    std::string bytes(random.rng().below(60), '\0');
    for (char& byte : bytes) byte = static_cast<char>(random.rng().next() & (i % 2 == 0 ? 0xFF : 0x77));
    BitReader in(bytes);
    const Look look = readLook(
        in, [](std::uint32_t, const Appearance&) {}, [](std::uint32_t) { return nullptr; });
    ASSERT_TRUE(!in.ok() || test::isLegal(look));
    BitReader again(bytes);
    const Body body = readBody(again);
    ASSERT_TRUE(!again.ok() || test::isLegal(body));
    accepted += in.ok() ? 1 : 0;
  }
  EXPECT_GT(accepted, 100);
}

}  // namespace
}  // namespace naiad
