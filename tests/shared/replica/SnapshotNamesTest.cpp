// Appearances and origins that snapshots name: known, defined in the snapshot, replaced, or unknown.
#include <gtest/gtest.h>

#include "shared/replica/Limits.h"
#include "shared/replica/SnapshotCodec.h"
#include "tests/support/WriteSnapshot.h"

namespace naiad {
namespace {

constexpr LookForm::Kind kNamed = LookForm::kNamed;
constexpr LookForm::Kind kDefined = LookForm::kDefined;

ObjectState drawnAs(const char* text) {
  ObjectState state;
  Appearance glyphs;
  for (int x = 0; *text != '\0'; ++text, x += 256)
    glyphs.push_back({x, 0, static_cast<char32_t>(*text), df::GREEN});
  state.look.sequence = {glyphs};
  return state;
}

class SnapshotNames : public testing::Test {
 protected:
  void SetUp() override { start(50); }
  void start(std::uint32_t number) {
    m_header = {};
    m_header.number = number;
    m_header.tick = 100;
    writer.beginSnapshot(m_header, 0, {});
  }
  void look(std::uint32_t id, const char* text, LookForm form) {
    BitWriter bits;
    writer.encode(bits, kLook, 0, drawnAs(text), {}, form);
    writer.object(id, std::move(bits));
  }
  ReadResult read() { return readSnapshot(writer.finish(), {m_header.number, 100, 0}, dictionary, snapshot); }
  const Look& lookOf(std::size_t object) const { return snapshot.records.objects.at(object).state.look; }
  void know(std::uint32_t number, std::uint32_t id, const char* text) {
    dictionary.define(number, SequenceRecord{id, drawnAs(text).look.sequence});
  }

  SnapshotWriter writer;
  SnapshotDictionary dictionary;
  Snapshot snapshot;

 private:
  SnapshotHeader m_header;
};

TEST_F(SnapshotNames, ADefinitionIsReported) {
  look(3, "saucer", {kDefined, 7});
  ASSERT_EQ(read(), ReadResult::kOk);
  EXPECT_EQ(lookOf(0), drawnAs("saucer").look);
  EXPECT_EQ(snapshot.records.sequences, (std::vector<SequenceRecord>{{7, drawnAs("saucer").look.sequence}}));
}

TEST_F(SnapshotNames, SnapshotsOwnDefinitionTakesPrecedence) {
  know(40, 7, "old");
  look(9, "new", {kDefined, 7});
  look(3, "new", {kNamed, 7});
  ASSERT_EQ(read(), ReadResult::kOk);
  EXPECT_EQ(lookOf(0), drawnAs("new").look);
  know(60, 7, "newer still");  // a definition by a newer snapshot, which arrived earlier
  ASSERT_EQ(read(), ReadResult::kOk);
  EXPECT_EQ(lookOf(0), drawnAs("new").look);
}

TEST_F(SnapshotNames, RedefinedNameIsStale) {
  know(51, 7, "another");
  look(3, "saucer", {kNamed, 7});
  EXPECT_EQ(read(), ReadResult::kStale);
}

TEST_F(SnapshotNames, AnUndefinedNameIsMalformed) {
  know(49, 7, "saucer");
  look(3, "saucer", {kNamed, 6});
  EXPECT_EQ(read(), ReadResult::kMalformed);
}

TEST_F(SnapshotNames, StaleNameWithAnUnknownOneIsMalformed) {
  know(51, 7, "another");
  look(3, "saucer", {kNamed, 7});
  look(4, "saucer", {kNamed, 6});
  EXPECT_EQ(read(), ReadResult::kMalformed);
}

TEST_F(SnapshotNames, ATruncatedSnapshotIsMalformedEvenIfStale) {
  know(51, 7, "another");
  look(3, "saucer", {kNamed, 7});
  const std::string bytes = writer.finish();
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_EQ(readSnapshot(std::string_view(bytes).substr(0, length), {50, 100, 0}, dictionary, snapshot),
              ReadResult::kMalformed);
  }
}

TEST_F(SnapshotNames, OriginsAreKnownStaleOrUnknown) {
  SnapshotHeader head;
  head.number = 50;
  const Origin there{{10, 10}, 6, 4, 3};
  const std::string bytes = test::writeSnapshot(head, {}, 2, there);
  const auto readAfter = [&](std::uint32_t defined_by) {
    SnapshotDictionary origins;
    if (defined_by != 0) origins.define(defined_by, OriginRecord{2, there});
    return readSnapshot(bytes, {50, 0, 0}, origins, snapshot);
  };
  EXPECT_EQ(readAfter(49), ReadResult::kOk);
  EXPECT_EQ(readAfter(50), ReadResult::kStale);
  EXPECT_EQ(readAfter(51), ReadResult::kStale);
  EXPECT_EQ(readAfter(0), ReadResult::kMalformed);
}

// A few bytes can name large sequences, which must not be copied.
TEST_F(SnapshotNames, LooksOfOneNameShareTheirSequence) {
  dictionary.define(49, SequenceRecord{7, {Appearance(kMaxGlyphs, Glyph{0, 0, U'#', df::RED})}});
  for (std::uint32_t id = 0; id < 1000; ++id) look(id, "saucer", {kNamed, 7});
  look(1000, "new", {kDefined, 8});
  look(1001, "new", {kNamed, 8});
  ASSERT_EQ(read(), ReadResult::kOk);
  for (std::size_t i = 1; i < 1000; ++i) ASSERT_TRUE(lookOf(i).sequence.isSharedWith(lookOf(0).sequence));
  EXPECT_TRUE(lookOf(1000).sequence.isSharedWith(lookOf(1001).sequence));
}

TEST_F(SnapshotNames, SelectorMustFitItsNamedSequence) {
  const auto isRead = [this](const Selector& selector, std::uint32_t name, bool defined_here) {
    start(50);
    const Appearance a{{256, 0, U'a', df::RED}};
    ObjectState state;
    state.look = {Sequence{a, a, a}, 2, selector};
    BitWriter bits;
    writer.encode(bits, kLook, 0, state, {}, {kNamed, name});
    writer.object(3, bits);
    state.look = {name == 7 ? Sequence{a, a} : Sequence{a, a, a}, 2};
    BitWriter more;
    writer.encode(more, kLook, 0, state, {}, {defined_here ? kDefined : kNamed, name});
    writer.object(4, more);
    return read();
  };
  const Appearance a{{256, 0, U'a', df::RED}};
  dictionary.define(49, SequenceRecord{7, {a, a}});
  dictionary.define(49, SequenceRecord{8, {a, a, a}});
  dictionary.define(49, SequenceRecord{9, {a}});
  for (const bool here : {false, true}) {
    EXPECT_EQ(isRead(Selector::fixed(1), 7, here), ReadResult::kOk);
    EXPECT_EQ(isRead(Selector::fixed(2), 7, here), ReadResult::kMalformed);
    EXPECT_EQ(isRead(Selector::fixed(2), 8, here), ReadResult::kOk);
    EXPECT_EQ(isRead(Selector::clock(100, 3), 7, here), ReadResult::kOk);
    EXPECT_EQ(isRead(Selector::turning(100, 3, 9), 7, here), ReadResult::kOk);
  }
  EXPECT_EQ(isRead(Selector::clock(100, 3), 9, false), ReadResult::kMalformed) << "one frame never changes";
  EXPECT_EQ(isRead(Selector::turning(100, 3, 9), 9, false), ReadResult::kMalformed);
}

}  // namespace
}  // namespace naiad
