#include <gtest/gtest.h>

#include "shared/replica/SnapshotDictionary.h"

namespace naiad {
namespace {

using Find = SnapshotDictionary::Find;

Sequence word(std::size_t glyphs, char32_t ch) {
  return {Appearance(glyphs, Glyph{0, 0, ch, df::RED})};
}

Find find(const SnapshotDictionary& vocabulary, std::uint32_t number, std::uint32_t slot) {
  Origin origin;
  return vocabulary.find(number, slot, origin);
}

TEST(SnapshotDictionary, SlotZeroIsTheZeroOriginForEver) {
  const SnapshotDictionary vocabulary;
  Origin origin{{5, 6}, 7, 8, 9};
  EXPECT_EQ(vocabulary.find(1, 0, origin), Find::kFound);
  EXPECT_EQ(origin, Origin{});
}

TEST(SnapshotDictionary, AnOriginIsKnownToSnapshotsAfterTheOneThatSetIt) {
  SnapshotDictionary vocabulary;
  const Origin there{{5, -6}, 7, 8, 9};
  EXPECT_EQ(find(vocabulary, 11, 2), Find::kUnknown);
  vocabulary.define(10, OriginRecord{2, there});
  Origin origin;
  EXPECT_EQ(vocabulary.find(11, 2, origin), Find::kFound);
  EXPECT_EQ(origin, there);
  EXPECT_EQ(find(vocabulary, 10, 2), Find::kStale);
  EXPECT_EQ(find(vocabulary, 9, 2), Find::kStale);
  EXPECT_EQ(find(vocabulary, 11, 1), Find::kUnknown);
  EXPECT_EQ(find(vocabulary, 11, kOriginSlots + 1), Find::kUnknown);
}

TEST(SnapshotDictionary, TheNewestDefinitionHoldsWhateverTheOrder) {
  for (const bool in_order : {true, false}) {
    SnapshotDictionary vocabulary;
    const std::uint32_t before = 0xFFFFFFFF;
    const std::uint32_t after = 3;  // the numbers wrap in between
    for (const std::uint32_t number : {in_order ? before : after, in_order ? after : before}) {
      vocabulary.define(number, OriginRecord{1, {{static_cast<std::int32_t>(number), 0}, 1, 1, 1}});
      EXPECT_TRUE(vocabulary.define(number, SequenceRecord{5, word(number == after ? 2 : 9, U'x')}));
    }
    Origin origin;
    EXPECT_EQ(vocabulary.find(4, 1, origin), Find::kFound);
    EXPECT_EQ(origin.corner.x, 3);
    const Sequence* sequence = nullptr;
    EXPECT_EQ(vocabulary.find(4, 5, sequence), Find::kFound);
    EXPECT_EQ(*sequence, word(2, U'x'));
    EXPECT_EQ(vocabulary.find(1, 5, sequence), Find::kStale);
  }
}

TEST(SnapshotDictionary, ASequenceThatNobodyDefinedIsUnknown) {
  SnapshotDictionary vocabulary;
  const Sequence* sequence = nullptr;
  EXPECT_EQ(vocabulary.find(1, 0, sequence), Find::kUnknown);
  EXPECT_TRUE(vocabulary.define(1, SequenceRecord{7, word(3, U'a')}));
  EXPECT_EQ(vocabulary.find(2, 6, sequence), Find::kUnknown);
  EXPECT_EQ(vocabulary.find(2, 7, sequence), Find::kFound);
}

TEST(SnapshotDictionary, GlyphsAreBoundedInAllAndGivenBack) {
  SnapshotDictionary vocabulary;
  const std::size_t large = kMaxVocabularyGlyphs / 8;
  std::uint32_t number = 0;
  for (std::uint32_t id = 0; id < 8; ++id)
    EXPECT_TRUE(vocabulary.define(++number, SequenceRecord{id, word(large, U'a')}));
  EXPECT_FALSE(vocabulary.define(++number, SequenceRecord{8, word(1, U'b')}));
  const Sequence* sequence = nullptr;
  EXPECT_EQ(vocabulary.find(++number, 8, sequence), Find::kUnknown);
  EXPECT_TRUE(vocabulary.define(++number, SequenceRecord{3, word(large - 1, U'c')})) << "instead of another";
  EXPECT_TRUE(vocabulary.define(++number, SequenceRecord{8, word(1, U'b')}));
  EXPECT_FALSE(vocabulary.define(++number, SequenceRecord{9, word(1, U'b')}));
}

}  // namespace
}  // namespace naiad
