#include <gtest/gtest.h>

#include "shared/replica/SnapshotDictionary.h"

namespace naiad {
namespace {

using Find = SnapshotDictionary::Find;

Sequence word(std::size_t glyphs, char32_t ch) {
  return {Appearance(glyphs, Glyph{0, 0, ch, df::RED})};
}

Find find(const SnapshotDictionary& dictionary, std::uint32_t number, std::uint32_t slot) {
  Origin origin;
  return dictionary.find(number, slot, origin);
}

TEST(SnapshotDictionary, OriginIsKnownOnlyToLaterSnapshots) {
  SnapshotDictionary dictionary;
  const Origin there{{5, -6}, 7, 8, 9};
  EXPECT_EQ(find(dictionary, 11, 2), Find::kUnknown);
  dictionary.define(10, OriginRecord{2, there});
  Origin origin;
  EXPECT_EQ(dictionary.find(11, 2, origin), Find::kFound);
  EXPECT_EQ(origin, there);
  EXPECT_EQ(find(dictionary, 10, 2), Find::kStale);
  EXPECT_EQ(find(dictionary, 9, 2), Find::kStale);
  EXPECT_EQ(find(dictionary, 11, 1), Find::kUnknown);
  EXPECT_EQ(find(dictionary, 11, kOriginSlots + 1), Find::kUnknown);
}

TEST(SnapshotDictionary, NewestDefinitionWinsInAnyOrder) {
  for (const bool in_order : {true, false}) {
    SnapshotDictionary dictionary;
    const std::uint32_t before = 0xFFFFFFFF;
    const std::uint32_t after = 3;  // the numbers wrap between the two
    for (const std::uint32_t number : {in_order ? before : after, in_order ? after : before}) {
      dictionary.define(number, OriginRecord{1, {{static_cast<std::int32_t>(number), 0}, 1, 1, 1}});
      EXPECT_TRUE(dictionary.define(number, SequenceRecord{5, word(number == after ? 2 : 9, U'x')}));
    }
    Origin origin;
    EXPECT_EQ(dictionary.find(4, 1, origin), Find::kFound);
    EXPECT_EQ(origin.corner.x, 3);
    const Sequence* sequence = nullptr;
    EXPECT_EQ(dictionary.find(4, 5, sequence), Find::kFound);
    EXPECT_EQ(*sequence, word(2, U'x'));
    EXPECT_EQ(dictionary.find(1, 5, sequence), Find::kStale);
  }
}

TEST(SnapshotDictionary, TotalGlyphsAreBoundedAndReleased) {
  SnapshotDictionary dictionary;
  const std::size_t large = kMaxDictionaryGlyphs / 8;
  std::uint32_t number = 0;
  for (std::uint32_t id = 0; id < 8; ++id)
    EXPECT_TRUE(dictionary.define(++number, SequenceRecord{id, word(large, U'a')}));
  EXPECT_FALSE(dictionary.define(++number, SequenceRecord{8, word(1, U'b')}));
  const Sequence* sequence = nullptr;
  EXPECT_EQ(dictionary.find(++number, 8, sequence), Find::kUnknown);
  EXPECT_TRUE(dictionary.define(++number, SequenceRecord{3, word(large - 1, U'c')})) << "instead of another";
  EXPECT_TRUE(dictionary.define(++number, SequenceRecord{8, word(1, U'b')}));
  EXPECT_FALSE(dictionary.define(++number, SequenceRecord{9, word(1, U'b')}));
}

}  // namespace
}  // namespace naiad
