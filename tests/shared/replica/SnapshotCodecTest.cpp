#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "RandomRecords.h"
#include "shared/replica/Limits.h"
#include "shared/replica/SnapshotCodec.h"
#include "tests/support/WriteSnapshot.h"

namespace naiad {
namespace {

using test::RandomRecords;
using test::writeSnapshot;

ReadResult read(std::string_view bytes, const SnapshotContext& context, Snapshot& out) {
  return readSnapshot(bytes, context, SnapshotDictionary{}, out);
}

SnapshotHeader header(std::uint32_t number, std::uint32_t tick) {
  SnapshotHeader header;
  header.number = number;
  header.tick = tick;
  return header;
}

void expectSame(const SnapshotHeader& a, const SnapshotHeader& b) {
  ASSERT_EQ(a.number, b.number);
  ASSERT_EQ(a.tick, b.tick);
  ASSERT_EQ(a.epoch, b.epoch);
  ASSERT_EQ(a.complete, b.complete);
  ASSERT_EQ(a.has_input, b.has_input);
  ASSERT_EQ(a.input, b.input);
  ASSERT_EQ(a.input_tick, b.input_tick);
}

void expectSame(const Records& a, const Records& b) {
  ASSERT_EQ(a.worlds, b.worlds);
  ASSERT_EQ(a.views, b.views);
  ASSERT_EQ(a.origins, b.origins);
  ASSERT_EQ(a.texts, b.texts);
  ASSERT_EQ(a.sequences, b.sequences);
  ASSERT_EQ(a.objects.size(), b.objects.size());
  for (std::size_t i = 0; i < a.objects.size(); ++i) {
    ASSERT_EQ(a.objects[i].id, b.objects[i].id);
    ASSERT_EQ(a.objects[i].generation, b.objects[i].generation);
    ASSERT_EQ(a.objects[i].groups, b.objects[i].groups);
    ASSERT_TRUE(a.objects[i].state == b.objects[i].state) << "object " << i;
  }
}

TEST(SnapshotCodec, RandomSnapshotsSurviveTheRoundTrip) {
  RandomRecords random(11);
  for (int i = 0; i < 5000; ++i) {
    const SnapshotHeader head = random.header();
    const Records records = random.records(head.tick);
    Snapshot out;
    ASSERT_EQ(read(writeSnapshot(head, records), test::near(head), out), ReadResult::kOk) << "round " << i;
    expectSame(head, out.header);
    expectSame(records, out.records);
    if (HasFatalFailure()) FAIL() << "round " << i;
  }
}

TEST(SnapshotCodec, PositionsAndOrdersAreRelativeToAnOrigin) {
  RandomRecords random(12);
  for (int i = 0; i < 2000; ++i) {
    const SnapshotHeader head = random.header();
    const OriginRecord origin = random.originRecord();
    const Records records = random.records(head.tick);
    SnapshotDictionary dictionary;
    dictionary.define(head.number - 1 == 0 ? 0xFFFFFFFF : head.number - 1, origin);
    const std::string bytes = writeSnapshot(head, records, origin.slot, origin.origin);
    Snapshot out;
    ASSERT_EQ(readSnapshot(bytes, test::near(head), dictionary, out), ReadResult::kOk);
    expectSame(records, out.records);
    if (HasFatalFailure()) FAIL() << "round " << i;
    ASSERT_EQ(read(bytes, test::near(head), out), ReadResult::kMalformed) << "an origin that was never set";
  }
}

TEST(SnapshotCodec, NumbersAreRestoredNearKnownOnes) {
  for (const std::uint32_t known : {5u, 0x8000u, 0xFFFFu, 0x10000u, 0xFFFFFFFFu}) {
    for (const std::int32_t apart : {-32768, -1, 1, 32767}) {
      SnapshotHeader head = header(known + static_cast<std::uint32_t>(apart), known - 1);
      if (head.number == 0) continue;
      head.has_input = true;
      head.input = known + 9;
      head.input_tick = head.tick - 63;
      Snapshot out;
      ASSERT_EQ(read(writeSnapshot(head, {}), {known, known, known}, out), ReadResult::kOk);
      expectSame(head, out.header);
    }
  }
}

TEST(SnapshotCodec, OldInputIsSentAs63TicksOld) {
  SnapshotHeader head = header(3, 1000);
  head.has_input = true;
  head.input = 7;
  head.input_tick = 900;
  Snapshot out;
  ASSERT_EQ(read(writeSnapshot(head, {}), {2, 999, 7}, out), ReadResult::kOk);
  EXPECT_EQ(out.header.input_tick, 1000u - 63);
}

TEST(SnapshotCodec, NumberZeroIsRefused) {
  Snapshot out;
  const std::string bytes = writeSnapshot(header(0x10000, 5), {});
  EXPECT_EQ(read(bytes, {0, 5, 0}, out), ReadResult::kMalformed);
  EXPECT_EQ(read(bytes, {0x10000, 5, 0}, out), ReadResult::kOk);
}

TEST(SnapshotCodec, EpochCanBeReadFromTheFirstBytes) {
  for (std::uint8_t epoch = 0; epoch < 4; ++epoch) {
    SnapshotHeader head = header(0xABCD, 0x1234);
    head.epoch = epoch;
    const std::string bytes = writeSnapshot(head, {});
    EXPECT_EQ(peekEpoch(bytes), epoch);
    EXPECT_EQ(peekEpoch(bytes.substr(0, 5)), epoch);
    EXPECT_EQ(peekEpoch(bytes.substr(0, 4)), std::nullopt);
  }
}

TEST(SnapshotCodec, EveryTruncationIsRefused) {
  RandomRecords random(13);
  for (int i = 0; i < 150; ++i) {
    const SnapshotHeader head = random.header();
    const std::string bytes = writeSnapshot(head, random.records(head.tick));
    Snapshot out;
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      ASSERT_EQ(read(std::string_view(bytes).substr(0, length), test::near(head), out),
                ReadResult::kMalformed)
          << i << ", " << length << " bytes";
    }
    ASSERT_EQ(read(bytes + '\0', test::near(head), out), ReadResult::kMalformed);
  }
}

TEST(SnapshotCodec, TheLongestTextOfTheWidestViewFits) {
  Records records;
  records.texts.push_back({3, 0, 7, df::GREEN, ""});
  for (int i = 0; i < kMaxViewWidth; ++i) df::appendUtf8(records.texts[0].text, U'█');
  Snapshot out;
  ASSERT_EQ(read(writeSnapshot(header(1, 1), records), {}, out), ReadResult::kOk);
  expectSame(records, out.records);
  Records longer = records;
  df::appendUtf8(longer.texts[0].text, U'x');
  ASSERT_EQ(read(writeSnapshot(header(1, 1), longer), {}, out), ReadResult::kOk);
  expectSame(records, out.records);
}

TEST(SnapshotCodec, CharactersThatDisturbATerminalAreRefused) {
  for (const char32_t ch : {U'\x1b', U'\n', U'\u202e', U'\u200b', U'\x7f'}) {
    Records glyph;
    glyph.objects.push_back({1, 0, kLook, {}});
    glyph.objects[0].state.look.sequence = {{{0, 0, ch, df::RED}}};
    Snapshot out;
    EXPECT_EQ(read(writeSnapshot(header(1, 1), glyph), {}, out), ReadResult::kMalformed);
    glyph.objects[0].state.look.sequence = {{{0, 0, ch, df::RED}, {0, 0, U'a', df::RED}}};
    EXPECT_EQ(read(writeSnapshot(header(1, 1), glyph), {}, out), ReadResult::kMalformed);
    Records text;
    text.texts.push_back({0, 0, 0, df::RED, "a"});
    df::appendUtf8(text.texts[0].text, ch);
    EXPECT_EQ(read(writeSnapshot(header(1, 1), text), {}, out), ReadResult::kMalformed);
  }
}

TEST(SnapshotCodec, IdsBeyondTheLimitAreRefused) {
  const auto isRead = [](std::uint32_t first, std::uint32_t second) {
    Records records;
    records.objects.push_back({first, 0, kDeath, {}});
    records.objects.push_back({second, 0, kDeath, {}});
    Snapshot out;
    return read(writeSnapshot(header(1, 1), records), {}, out) == ReadResult::kOk;
  };
  EXPECT_TRUE(isRead(0, kMaxSlots - 1));
  EXPECT_TRUE(isRead(kMaxSlots - 2, kMaxSlots - 1));
  EXPECT_FALSE(isRead(0, kMaxSlots));
  EXPECT_FALSE(isRead(kMaxSlots - 1, kMaxSlots));
}

TEST(SnapshotCodec, ViewFollowingAnInvalidIdIsRefused) {
  for (const std::uint32_t id : {kMaxSlots - 1, kMaxSlots}) {
    Records records;
    records.views.push_back({{}, true, id, 3});
    Snapshot out;
    EXPECT_EQ(read(writeSnapshot(header(1, 1), records), {}, out),
              id < kMaxSlots ? ReadResult::kOk : ReadResult::kMalformed);
  }
}

TEST(SnapshotCodec, OrdersOutOfRangeAreRefused) {
  const auto isRead = [](std::uint64_t order, std::uint64_t written_from) {
    Records records;
    records.objects.push_back({1, 0, kAllGroups, {}});
    records.objects[0].state.order = order;
    records.objects[0].state.motion.tick = 5;
    SnapshotDictionary dictionary;
    dictionary.define(1, OriginRecord{1, {{}, 0, 0, 10}});
    Snapshot out;
    const std::string bytes = writeSnapshot(header(2, 5), records, 1, {{}, 0, 0, written_from});
    return readSnapshot(bytes, {1, 5, 0}, dictionary, out) == ReadResult::kOk;
  };
  const std::uint64_t last = (std::uint64_t{1} << 48) - 1;
  EXPECT_TRUE(isRead(0, 10));
  EXPECT_FALSE(isRead(0, 11)) << "reads as -1";
  EXPECT_TRUE(isRead(last, 10));
  EXPECT_FALSE(isRead(last, 9)) << "reads as 2^48";
}

TEST(SnapshotCodec, WorldsOutOfRangeAreRefused) {
  const auto isRead = [](const WorldRecord& world) {
    Records records;
    records.worlds.push_back(world);
    Snapshot out;
    return read(writeSnapshot(header(1, 1), records), {}, out) == ReadResult::kOk;
  };
  const df::FixedBox box{{}, {INT64_MAX, INT64_MAX}};
  EXPECT_TRUE(isRead({box, kMaxViewWidth, kMaxViewHeight, df::WHITE}));
  EXPECT_TRUE(isRead({box, kMinViewWidth, kMinViewHeight, df::BLACK}));
  EXPECT_FALSE(isRead({box, kMinViewWidth - 1, kMinViewHeight, df::BLACK}));
  EXPECT_FALSE(isRead({box, kMinViewWidth, kMinViewHeight - 1, df::BLACK}));
  EXPECT_FALSE(isRead({box, kMaxViewWidth + 1, kMinViewHeight, df::BLACK}));
  EXPECT_FALSE(isRead({box, kMinViewWidth, kMaxViewHeight + 1, df::BLACK}));
  EXPECT_FALSE(isRead({{{}, {-1, 0}}, 80, 24, df::BLACK}));
  EXPECT_FALSE(isRead({{{}, {0, -1}}, 80, 24, df::BLACK}));
}

TEST(SnapshotCodec, ClaimedObjectCountReservesLittleMemory) {
  BitWriter out;
  out.bits(1, 16);
  out.bits(1, 16);
  out.bits(0, 2 + 1 + 1 + 2 + 1);
  out.golomb(1'000'000'000, 3);
  out.bits(0, 4);
  Snapshot snapshot;
  EXPECT_EQ(read(out.bytes(), {}, snapshot), ReadResult::kMalformed);
  EXPECT_LE(snapshot.records.objects.capacity(), 64u);
}

TEST(SnapshotCodec, ARecordWithoutGroupsIsRefused) {
  BitWriter out;
  out.bits(1, 16);
  out.bits(1, 16);
  out.bits(0, 2 + 1 + 1 + 2 + 1);
  out.golomb(1, 3);
  out.bits(0, 4);
  out.golomb(0, 0);
  out.bits(0b111, 3);
  BitWriter none = out;
  none.bits(0, 3);
  Snapshot snapshot;
  EXPECT_EQ(read(none.bytes(), {}, snapshot), ReadResult::kMalformed);
  out.bits(0b100, 3);  // the groups: a body
  writeBody(out, {});
  EXPECT_EQ(read(out.bytes(), {}, snapshot), ReadResult::kOk);
  EXPECT_EQ(snapshot.records.objects.at(0).groups, kBody);
}

/// Returns up to `count` different ids, close together or far apart.
std::set<std::uint32_t> someIds(RandomRecords& random, std::size_t count) {
  std::set<std::uint32_t> ids;
  const std::uint64_t span = std::uint64_t{1} << random.rng().below(21);
  const bool clusters = random.chance(0.3);
  while (ids.size() < std::min<std::uint64_t>(count, span)) {
    const std::uint64_t id = random.rng().below(span);
    for (std::uint64_t i = id; i < span && i < id + (clusters ? 20 : 1); ++i)
      ids.insert(static_cast<std::uint32_t>(i));
  }
  return ids;
}

TEST(SnapshotCodec, RecordsAcceptedByHasRoomFit) {
  RandomRecords random(16);
  double filled = 0;
  int full = 0;
  for (int round = 0; round < 3000; ++round) {
    const std::size_t bytes = 30 + random.rng().below(random.chance(0.2) ? kMaxSnapshot : 1200);
    std::vector<std::uint32_t> ids;
    for (const std::uint32_t id : someIds(random, 1 + random.rng().below(random.chance(0.1) ? 3000 : 200)))
      ids.insert(ids.begin() + static_cast<std::ptrdiff_t>(random.rng().below(ids.size() + 1)), id);
    const std::uint32_t last = random.chance(0.5) ? kMaxSlots - 1 : *std::max_element(ids.begin(), ids.end());
    SnapshotWriter out;
    const SnapshotHeader head = random.header();
    out.beginSnapshot(head, 0, {});
    if (random.chance(0.3)) out.write(random.view());
    if (random.chance(0.3)) out.write(random.text());
    if (!out.hasSpace(0, last, bytes)) continue;
    bool refused = false;
    for (std::size_t i = 0; i < ids.size() && !refused; ++i) {
      BitWriter bits;
      const std::uint8_t groups = random.chance(0.5) ? kDeath : +kBody;
      out.encode(bits, groups, 0, random.state(head.tick), {});
      refused = !out.hasSpace(bits.bitCount(), last, bytes);
      if (!refused) out.object(ids[i], std::move(bits));
    }
    const std::string snapshot = out.finish();
    ASSERT_LE(snapshot.size(), bytes) << "round " << round;
    Snapshot back;
    ASSERT_EQ(read(snapshot, test::near(head), back), ReadResult::kOk);
    if (!refused || bytes < 300) continue;
    filled += static_cast<double>(snapshot.size()) / static_cast<double>(bytes);
    ++full;
  }
  ASSERT_GT(full, 100);
  EXPECT_GT(filled / full, 0.6) << "the estimate leaves too much unused";
}

// The most expensive ids: gaps of three times the code's step, with almost a third of the gaps empty.
TEST(SnapshotCodec, MostExpensiveIdsFitWhenHasRoomAccepts) {
  for (int order = 1; order <= 15; ++order) {
    for (const std::uint32_t count : {1u, 2u, 5u, 30u, 300u}) {
      SnapshotWriter out;
      SnapshotHeader head = header(0xFFFF, 1);
      head.has_input = true;
      out.beginSnapshot(head, 0, {});
      std::uint32_t id = 0;
      std::size_t bytes = 0;
      for (std::uint32_t i = 0; i < count; ++i) {
        if (i % 25 < 16) id += 3u << order;
        if (id >= kMaxSlots) break;
        BitWriter bits;
        out.encode(bits, kDeath, 0, {}, {});
        bytes = 1;
        while (!out.hasSpace(bits.bitCount(), id, bytes)) ++bytes;
        out.object(id++, std::move(bits));
      }
      ASSERT_LE(out.finish().size(), bytes) << count << " ids, order " << order;
    }
  }
}

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

TEST_F(SnapshotNames, StaleNameWithAnUnknownOneIsMalformed) {
  know(51, 7, "another");
  look(3, "saucer", {kNamed, 7});
  look(4, "saucer", {kNamed, 6});
  EXPECT_EQ(read(), ReadResult::kMalformed);
}

TEST_F(SnapshotNames, RedefinedNameIsStaleUnlessTruncated) {
  know(51, 7, "another");
  look(3, "saucer", {kNamed, 7});
  const std::string bytes = writer.finish();
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_EQ(readSnapshot(std::string_view(bytes).substr(0, length), {50, 100, 0}, dictionary, snapshot),
              ReadResult::kMalformed);
  }
  EXPECT_EQ(readSnapshot(bytes, {50, 100, 0}, dictionary, snapshot), ReadResult::kStale);
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
