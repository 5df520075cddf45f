#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "Bytes.h"
#include "RandomRecords.h"
#include "RecordCodec.h"

namespace naiad {
namespace {

using test::RandomRecords;

std::string encode(const Records& records) {
  RecordWriter out;
  for (const WorldRecord& record : records.worlds) out.write(record);
  for (const ViewRecord& record : records.views) out.write(record);
  for (const TextRecord& record : records.texts) out.write(record);
  for (const ObjectRecord& record : records.objects) out.write(record);
  return out.bytes();
}

bool within(df::FixedVector v, std::int64_t most_cells) {
  const df::Fixed most = most_cells << df::kFixedBits;
  return v.x >= -most && v.x <= most && v.y >= -most && v.y <= most;
}

bool isLegal(const df::Color color) {
  return color >= 0 && color < df::kColorCount;
}

bool isLegal(const Look& look) {
  if (look.altitude < 0 || look.altitude > 255 || look.sequence.size() > 1) return false;
  for (const Appearance& appearance : look.sequence) {
    if (appearance.size() > kMaxGlyphs) return false;
    for (const Glyph& glyph : appearance) {
      if (std::abs(glyph.dx) > kMaxGlyphOffset || std::abs(glyph.dy) > kMaxGlyphOffset) return false;
      if (!df::isDrawable(glyph.ch) || !isLegal(glyph.color)) return false;
    }
  }
  return true;
}

bool isLegal(const ObjectRecord& record, std::uint32_t tick) {
  const Motion& m = record.state.motion;
  const Body& body = record.state.body;
  const bool moves = (record.groups & kMotion) != 0;
  return record.slot < kMaxSlots && record.generation != 0 &&
         ((record.groups & kLife) == 0 || record.groups == kAllGroups) && record.groups <= kAllGroups &&
         (!moves || m.tick == tick) && within(m.position, 2'100'000'000) && within(m.velocity, 1 << 25) &&
         within(m.acceleration, 1 << 25) && isLegal(record.state.look) &&
         within(body.box.corner, 1'000'001) && within(body.box.size, 1'000'001) && body.box.size.x >= 0 &&
         body.box.size.y >= 0 && body.solidness >= df::HARD && body.solidness <= df::SPECTRAL;
}

bool isLegal(const TextRecord& text) {
  const std::u32string characters = df::decodeUtf8(text.text);
  return text.id < kMaxTexts && std::abs(text.x) <= kMaxViewWidth && std::abs(text.y) <= kMaxViewHeight &&
         isLegal(text.color) && std::all_of(characters.begin(), characters.end(), df::isDrawable);
}

bool isLegal(const Records& records, std::uint32_t tick) {
  const auto world = [](const WorldRecord& r) {
    return within(r.boundary.corner, 2'100'000'000) && r.boundary.size.x >= 0 && r.boundary.size.y >= 0 &&
           r.view_width >= kMinViewWidth && r.view_width <= kMaxViewWidth &&
           r.view_height >= kMinViewHeight && r.view_height <= kMaxViewHeight;
  };
  const auto view = [](const ViewRecord& r) { return within(r.corner, 2'100'000'000) && r.slot < kMaxSlots; };
  return std::all_of(records.worlds.begin(), records.worlds.end(), world) &&
         std::all_of(records.views.begin(), records.views.end(), view) &&
         std::all_of(records.texts.begin(), records.texts.end(),
                     [](const TextRecord& r) { return isLegal(r); }) &&
         std::all_of(records.objects.begin(), records.objects.end(),
                     [tick](const ObjectRecord& r) { return isLegal(r, tick); });
}

void expectSame(const Records& a, const Records& b) {
  ASSERT_EQ(a.worlds, b.worlds);
  ASSERT_EQ(a.views, b.views);
  ASSERT_EQ(a.texts, b.texts);
  ASSERT_EQ(a.objects.size(), b.objects.size());
  for (std::size_t i = 0; i < a.objects.size(); ++i) {
    ASSERT_EQ(a.objects[i].slot, b.objects[i].slot);
    ASSERT_EQ(a.objects[i].generation, b.objects[i].generation);
    ASSERT_EQ(a.objects[i].groups, b.objects[i].groups);
    ASSERT_TRUE(a.objects[i].state == b.objects[i].state) << "object " << i;
  }
}

TEST(RecordCodec, RandomRecordsSurviveTheRoundTrip) {
  RandomRecords random(11);
  for (int i = 0; i < 3000; ++i) {
    const auto tick = static_cast<std::uint32_t>(random.rng().next());
    const Records records = random.records(tick);
    const auto read = readRecords(encode(records), tick);
    ASSERT_TRUE(read) << "round " << i;
    expectSame(records, *read);
  }
}

TEST(RecordCodec, NothingAtAllIsASnapshotWithoutRecords) {
  const auto read = readRecords("", 5);
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->worlds.empty() && read->views.empty() && read->texts.empty() && read->objects.empty());
}

TEST(RecordCodec, EveryTruncationWithinARecordIsRefused) {
  RandomRecords random(12);
  for (int i = 0; i < 300; ++i) {
    Records one;
    switch (i % 4) {
      case 0:
        one.worlds.push_back(random.world());
        break;
      case 1:
        one.views.push_back(random.view());
        break;
      case 2:
        one.texts.push_back(random.text());
        break;
      default:
        one.objects.push_back(random.object(9));
    }
    const std::string bytes = encode(one);
    for (std::size_t length = 1; length < bytes.size(); ++length) {
      ASSERT_FALSE(readRecords(std::string_view(bytes).substr(0, length), 9))
          << i << ", " << length << " bytes";
    }
  }
}

TEST(RecordCodec, EverySingleBitFlipIsRefusedOrLegal) {
  RandomRecords random(13);
  int refused = 0;
  int accepted = 0;
  for (int i = 0; i < 150; ++i) {
    std::string bytes = encode(random.records(9));
    for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
      bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << (bit % 8)));
      const auto read = readRecords(bytes, 9);
      ASSERT_TRUE(!read || isLegal(*read, 9)) << "round " << i << ", bit " << bit;
      ++(read ? accepted : refused);
      bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << (bit % 8)));
    }
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(accepted, 1000);
}

TEST(RecordCodec, RandomBytesAreRefusedOrLegal) {
  RandomRecords random(14);
  int accepted = 0;
  for (int i = 0; i < 100'000; ++i) {
    std::string bytes(random.rng().below(40), '\0');
    for (char& byte : bytes) byte = static_cast<char>(random.rng().next() & (i % 2 == 0 ? 0xFF : 0x1F));
    const auto read = readRecords(bytes, 3);
    ASSERT_TRUE(!read || isLegal(*read, 3));
    accepted += read ? 1 : 0;
  }
  EXPECT_GT(accepted, 100);
}

TEST(RecordCodec, TheLongestTextOfTheWidestViewFits) {
  Records records;
  records.texts.push_back({3, 0, 7, df::GREEN, ""});
  for (int i = 0; i < kMaxViewWidth; ++i) df::appendUtf8(records.texts[0].text, U'█');
  const auto read = readRecords(encode(records), 1);
  ASSERT_TRUE(read);
  expectSame(records, *read);
}

TEST(RecordCodec, AModelThatWasAcceleratedOnceTooOftenFits) {
  const df::Fixed most = *df::toFixed(df::kMaxVelocityCells);
  const Motion fastest{8, {}, {most, -most}, {most, -most}};
  Records records;
  records.objects.push_back({1, 1, kMotion, {0, rebase(fastest, 9), {}, {}}});
  const auto read = readRecords(encode(records), 9);
  ASSERT_TRUE(read);
  expectSame(records, *read);
}

TEST(RecordCodec, UnknownTagsAreRefused) {
  for (int tag = 0; tag < 256; ++tag) {
    if (tag >= 1 && tag <= 3) continue;
    std::string bytes(1, static_cast<char>(tag));
    bytes += std::string("\x05\x01", 2);  // slot 5, generation 1: a death, behind tag 0x10
    EXPECT_EQ(readRecords(bytes, 1).has_value(), tag == 0x10) << tag;
  }
}

TEST(RecordCodec, ABirthMustCarryAllGroups) {
  Records records;
  records.objects.push_back({1, 1, kAllGroups, {}});
  std::string bytes = encode(records);
  ASSERT_TRUE(readRecords(bytes, 0));
  for (std::uint8_t groups = kLife; groups < kAllGroups; groups += 2) {
    bytes[0] = static_cast<char>(0x10 + groups);
    EXPECT_FALSE(readRecords(bytes, 0)) << int{groups};
  }
}

TEST(RecordCodec, GenerationZeroIsRefused) {
  EXPECT_FALSE(readRecords(std::string("\x10\x05\x00", 3), 1));
  EXPECT_FALSE(readRecords(std::string("\x02\x00\x00\x06\x00", 5), 1));
  EXPECT_TRUE(readRecords(std::string("\x02\x00\x00\x06\x01", 5), 1));
}

TEST(RecordCodec, SlotsBeyondTheLastAreRefused) {
  const auto death = [](std::uint64_t slot) {
    std::string bytes;
    ByteWriter out(bytes);
    out.byte(0x10);
    out.varint(slot);
    out.varint(1);
    return bytes;
  };
  EXPECT_TRUE(readRecords(death(kMaxSlots - 1), 1));
  EXPECT_FALSE(readRecords(death(kMaxSlots), 1));
}

TEST(RecordCodec, CharactersThatDisturbATerminalAreRefused) {
  for (const char32_t ch : {U'\x1b', U'\n', U'\u202e', U'\u200b'}) {
    Records glyph;
    glyph.objects.push_back({1, 1, kLook, {}});
    glyph.objects[0].state.look.sequence.push_back({{0, 0, ch, df::RED}});
    EXPECT_FALSE(readRecords(encode(glyph), 1));
    Records text;
    text.texts.push_back({0, 0, 0, df::RED, "a"});
    df::appendUtf8(text.texts[0].text, ch);
    EXPECT_FALSE(readRecords(encode(text), 1));
  }
  Records text;
  text.texts.push_back({0, 0, 0, df::RED, "\xC3"});  // cut within a character
  EXPECT_FALSE(readRecords(encode(text), 1));
}

TEST(RecordCodec, ACountThatIsOnlyClaimedCostsNothing) {
  // A look of 8192 glyphs, none of which follow.
  EXPECT_FALSE(readRecords(std::string("\x14\x05\x01\x02\x01\x80\x40", 7), 1));
}

TEST(RecordCodec, EncodedSizeIsWhatARecordGrowsBy) {
  RandomRecords random(15);
  for (int i = 0; i < 200; ++i) {
    ObjectRecord record{1, 1, kLook, {}};
    record.state.look = random.look();
    RecordWriter out;
    out.write(record);
    ASSERT_EQ(out.size(), 3 + encodedSize(record.state.look));
  }
}

TEST(Bytes, VarintsBeyond64BitsAreRefused) {
  const auto read = [](std::string bytes) {
    ByteReader in(bytes);
    in.varint();
    return in.ok();
  };
  EXPECT_TRUE(read("\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\x01"));
  EXPECT_FALSE(read("\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\x02"));
  EXPECT_FALSE(read("\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\x81\x01"));
}

TEST(Bytes, AFailedReaderStaysFailedAndYieldsZeros) {
  ByteReader in("\x05\x80");
  EXPECT_EQ(in.upTo(4), 0u);
  EXPECT_FALSE(in.ok());
  EXPECT_EQ(in.byte(), 0);
  EXPECT_EQ(in.bytes(1), "");
}

}  // namespace
}  // namespace naiad
