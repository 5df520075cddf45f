#include <gtest/gtest.h>

#include <array>

#include "shared/replica/Limits.h"
#include "shared/replica/Replica.h"
#include "shared/replica/SnapshotCodec.h"
#include "shared/values/Vector.h"
#include "tests/support/CellsAt.h"

namespace naiad {
namespace {

using test::cellsAt;

ObjectState character(double x, double y, char32_t ch, std::int32_t altitude = 2, std::uint64_t order = 1) {
  return {order, {0, cellsAt(x, y), {}, {}}, {{{{0, 0, ch, df::CYAN}}}, altitude}, {}};
}

Records birth(std::uint32_t id, std::uint8_t generation, const ObjectState& state) {
  Records records;
  records.objects.push_back({id, generation, kAllGroups, state});
  return records;
}

Records death(std::uint32_t id) {
  Records records;
  records.objects.push_back({id, 0, kDeath, {}});
  return records;
}

Records motion(std::uint32_t id, double x) {
  Records records;
  records.objects.push_back({id, 0, kMotion, character(x, 0, U'?')});
  return records;
}

void apply(Replica& replica, std::uint32_t number, std::uint32_t tick, Records records) {
  Snapshot snapshot;
  snapshot.header.number = number;
  snapshot.header.tick = tick;
  snapshot.records = std::move(records);
  replica.apply(snapshot);
}

struct ReplicaTest : testing::Test {
  Replica replica;
};

TEST_F(ReplicaTest, DrawsByAltitudeThenCreationOrderThenTexts) {
  apply(replica, 1, 0, birth(1, 1, character(3, 1, U'b', 2, 20)));
  apply(replica, 2, 0, birth(2, 1, character(3, 1, U'a', 2, 10)));
  apply(replica, 3, 0, birth(3, 1, character(3, 1, U'c', 1, 30)));
  EXPECT_EQ(replica.render(0).at(3, 1).ch, U'b');
  apply(replica, 4, 0, birth(4, 1, character(3, 1, U'd', 3, 5)));
  EXPECT_EQ(replica.render(0).at(3, 1).ch, U'd');
  Records text;
  text.texts.push_back({0, 2, 1, df::RED, "xé"});
  apply(replica, 5, 0, text);
  EXPECT_EQ(replica.render(0).at(2, 1), (df::Cell{U'x', df::RED}));
  EXPECT_EQ(replica.render(0).at(3, 1), (df::Cell{U'é', df::RED}));
}

TEST_F(ReplicaTest, ExtrapolatesBetweenSnapshots) {
  ObjectState state = character(10, 5, U'@');
  state.motion = {100, cellsAt(10, 5), cellsAt(0.5, 0), cellsAt(0, 0.25)};
  apply(replica, 1, 100, birth(7, 1, state));
  EXPECT_EQ(replica.render(100).at(10, 5).ch, U'@');
  EXPECT_EQ(replica.render(104).at(12, 7).ch, U'@');  // 5 + 6 × 0.25 = 6.5
}

TEST_F(ReplicaTest, BirthOfANewGenerationReplacesTheOldOne) {
  apply(replica, 1, 0, birth(7, 3, character(1, 0, U'a', 2, 10)));
  apply(replica, 2, 0, birth(7, 0, character(4, 0, U'b', 2, 20)));
  ASSERT_NE(replica.find(7), nullptr);
  EXPECT_EQ(replica.find(7)->generation, 0u);
  EXPECT_EQ(replica.find(7)->state.order, 20u);
  EXPECT_EQ(replica.aliveCount(), 1u);
}

TEST_F(ReplicaTest, ReportsTheNewestAppliedSnapshot) {
  Replica fresh(1000);
  EXPECT_EQ(fresh.newest().tick, 1000u);
  const auto input = [&](std::uint32_t number, std::uint32_t tick, std::uint32_t id) {
    Snapshot snapshot;
    snapshot.header.number = number;
    snapshot.header.tick = tick;
    snapshot.header.has_input = id != 0;
    snapshot.header.input = id;
    fresh.apply(snapshot);
  };
  input(5, 1002, 3);
  input(4, 1001, 2);  // arrives late
  EXPECT_EQ(fresh.newest().number, 5u);
  EXPECT_EQ(fresh.newest().tick, 1002u);
  EXPECT_EQ(fresh.newest().input, 3u);
  input(6, 1005, 0);
  EXPECT_EQ(fresh.newest().number, 6u);
  EXPECT_EQ(fresh.newest().tick, 1005u);
  EXPECT_EQ(fresh.newest().input, 3u);
}

TEST_F(ReplicaTest, KeepsNamesForLaterSnapshots) {
  const ObjectState state = character(1, 1, U'x');
  ObjectState word = state;
  word.look.sequence = {{word.look.sequence[0][0], {256, 0, U'y', df::CYAN}}};
  const auto snapshot = [&](std::uint32_t number, std::uint32_t slot, const Origin& origin, LookForm form,
                            bool sets_origin) {
    SnapshotWriter out;
    SnapshotHeader header;
    header.number = number;
    out.beginSnapshot(header, slot, origin);
    if (sets_origin) out.write(OriginRecord{1, {{-5, -5}, 4, 4, 0}});
    BitWriter bits;
    out.encode(bits, kAllGroups, 1, word, word.motion, form);
    out.object(number, std::move(bits));
    return out.finish();
  };
  const Origin origin{{-5, -5}, 4, 4, 0};
  const std::string defines = snapshot(1, 0, {}, {LookForm::kDefined, 9}, true);
  const std::string names = snapshot(2, 1, origin, {LookForm::kNamed, 9}, false);
  const std::string redefines = snapshot(3, 1, origin, {LookForm::kDefined, 9}, false);
  Snapshot out;
  EXPECT_EQ(replica.read(names, out), ReadResult::kMalformed) << "before it was sent";
  ASSERT_EQ(replica.read(defines, out), ReadResult::kOk);
  EXPECT_EQ(replica.read(names, out), ReadResult::kMalformed) << "reading is not applying";
  ASSERT_EQ(replica.read(defines, out), ReadResult::kOk);
  replica.apply(out);
  ASSERT_EQ(replica.read(names, out), ReadResult::kOk);
  replica.apply(out);
  EXPECT_EQ(replica.find(2)->state.look, word.look);
  EXPECT_EQ(replica.find(2)->state.motion.position, cellsAt(1, 1));
  ASSERT_EQ(replica.read(redefines, out), ReadResult::kOk);
  replica.apply(out);
  EXPECT_EQ(replica.read(names, out), ReadResult::kStale);
}

TEST_F(ReplicaTest, RecordsAboutUnknownObjectsDrawNothing) {
  apply(replica, 1, 0, motion(7, 5));
  EXPECT_EQ(replica.aliveCount(), 0u);
  EXPECT_EQ(countDifferences(replica.render(0), df::Canvas(80, 24)), 0);
}

TEST_F(ReplicaTest, EmptyTextRemovesTheText) {
  Records text;
  text.texts.push_back({3, 0, 0, df::RED, "score"});
  apply(replica, 1, 0, text);
  text.texts[0].text.clear();
  apply(replica, 2, 0, text);
  EXPECT_EQ(replica.render(0).text(), df::Canvas(80, 24).text());
}

TEST_F(ReplicaTest, FollowsTheObjectOfTheViewRecord) {
  Records records = birth(7, 1, character(50, 12, U'@'));
  records.worlds.push_back({{cellsAt(0, 0), cellsAt(400, 24)}, 60, 20});
  records.views.push_back({cellsAt(20, 0), true, 7, 1});
  records.objects[0].state.motion = {10, cellsAt(50, 12), cellsAt(1, 0), {}};
  apply(replica, 1, 10, records);
  EXPECT_EQ(replica.viewCorner(20), (CellPosition{20, 0}));
  EXPECT_EQ(replica.viewCorner(40), (CellPosition{40, 0}));
  EXPECT_EQ(replica.focus(40), (CellPosition{40, 12}));
  EXPECT_EQ(replica.render(40).at(40, 12).ch, U'@');
  apply(replica, 2, 40, death(7));
  EXPECT_EQ(replica.viewCorner(40), (CellPosition{20, 0}));
  EXPECT_EQ(replica.focus(40), (CellPosition{30, 10}));
}

TEST_F(ReplicaTest, ObjectCountIsBoundedAndOverflowCounted) {
  for (std::uint32_t id = 0; id < kMaxReplicaObjects + 10; ++id) apply(replica, id + 1, 0, birth(id, 1, {}));
  EXPECT_EQ(replica.entries().size(), kMaxReplicaObjects);
  EXPECT_EQ(replica.overflowCount(), 10u);
}

TEST_F(ReplicaTest, DrawnGlyphsAreLimitedToTheTopmost) {
  // All objects share this sequence, so it takes little memory but much drawing.
  const Sequence large{Appearance(8192, Glyph{0, 0, U'#', df::RED})};
  const std::uint32_t fits = kMaxDrawnGlyphs / 8192;
  Records records;
  for (std::uint32_t id = 0; id < fits + 10; ++id) {
    ObjectState state;
    state.order = id;
    state.motion.position = cellsAt(static_cast<int>(id) % 80, static_cast<int>(id) / 80);
    state.look.sequence = large;
    records.objects.push_back({id, 1, kAllGroups, state});
  }
  apply(replica, 1, 0, records);
  const df::Canvas picture = replica.render(0);
  for (std::uint32_t id = 0; id < fits + 10; ++id) {
    const char32_t ch = picture.at(static_cast<int>(id) % 80, static_cast<int>(id) / 80).ch;
    EXPECT_EQ(ch, id < 10 ? U' ' : U'#') << id;
  }
}

TEST_F(ReplicaTest, DrawnObjectsAreLimitedToTheTopmost) {
  Records records;
  for (std::uint32_t id = 0; id < kMaxDrawnObjects + 2; ++id) {
    records.objects.push_back({id, 1, kAllGroups, character(id < 3 ? static_cast<int>(id) : 5, 0, U'x')});
    records.objects.back().state.order = id;
  }
  apply(replica, 1, 0, records);
  EXPECT_EQ(replica.render(0).text().substr(0, 6), "  x  x");
}

TEST_F(ReplicaTest, ObjectsReachingIntoTheViewAreDrawn) {
  // A glyph at each end of a long look, with the object outside the view on every side.
  std::uint32_t id = 0;
  for (const auto& [x, y, dx, dy] : {std::array{-100, 3, 100, 0}, std::array{190, 4, -190, 0},
                                     std::array{5, -60, 0, 60}, std::array{6, 99, 0, -99}}) {
    ObjectState state;
    state.motion.position = cellsAt(x, y);
    state.look.sequence = {{Glyph{dx << kGlyphUnitBits, dy << kGlyphUnitBits, U'@', df::RED}}};
    apply(replica, id + 1, 0, birth(id, 1, state));
    ++id;
  }
  const df::Canvas picture = replica.render(0);
  for (const auto& [x, y] : {std::pair{0, 3}, {0, 4}, {5, 0}, {6, 0}}) EXPECT_EQ(picture.at(x, y).ch, U'@');
}

TEST_F(ReplicaTest, TotalLookSizeIsBounded) {
  ObjectState huge = character(1, 1, U'x');
  const auto makeCopy = [&huge] { huge.look.sequence = {Appearance(8192, Glyph{0, 0, U'#', df::RED})}; };
  const std::uint32_t fits = kMaxReplicaGlyphs / 8192;
  std::uint32_t number = 0;
  for (std::uint32_t id = 0; id < fits + 10; ++id) {
    makeCopy();  // an equal sequence that is not shared
    apply(replica, ++number, 0, birth(id, 1, huge));
  }
  EXPECT_EQ(replica.overflowCount(), 10u);
  EXPECT_EQ(replica.find(fits - 1)->state.look, huge.look);
  EXPECT_TRUE(replica.find(fits)->state.look.sequence.empty());
  // Deaths, a new birth with an id in use, and changed looks free space.
  apply(replica, ++number, 0, death(0));
  apply(replica, ++number, 0, birth(1, 2, character(1, 1, U'x')));
  Records look;
  look.objects.push_back({2, 0, kLook, character(1, 1, U'x')});
  apply(replica, ++number, 0, look);
  for (std::uint32_t id = fits; id < fits + 3; ++id) {
    makeCopy();
    apply(replica, ++number, 0, birth(id, 2, huge));
  }
  EXPECT_EQ(replica.overflowCount(), 11u) << "three large looks went, two small ones came";
  EXPECT_EQ(replica.find(fits + 1)->state.look, huge.look);
}

TEST_F(ReplicaTest, SharedLooksCountOnce) {
  ObjectState huge = character(1, 1, U'x');
  huge.look.sequence = {Appearance(8192, Glyph{0, 0, U'#', df::RED})};
  const std::uint32_t many = 2 * kMaxReplicaGlyphs / 8192;
  std::uint32_t number = 0;
  for (std::uint32_t id = 0; id < many; ++id) apply(replica, ++number, 0, birth(id, 1, huge));
  EXPECT_EQ(replica.overflowCount(), 0u);
  for (std::uint32_t id = 0; id < many; ++id) apply(replica, ++number, 0, death(id));
  // Exactly the used space is freed.
  const std::uint32_t fits = kMaxReplicaGlyphs / 8192;
  for (std::uint32_t id = 0; id < fits + 1; ++id) {
    huge.look.sequence = {Appearance(8192, Glyph{0, 0, U'#', df::RED})};
    apply(replica, ++number, 0, birth(id, 2, huge));
    EXPECT_EQ(replica.overflowCount(), id < fits ? 0u : 1u);
  }
}

// SnapshotLossTest compares replicas of whole worlds after losses, duplicates and late arrivals.
TEST_F(ReplicaTest, LateRecordsOfEachKindChangeNothing) {
  const auto records = [](double x, const char* text, std::int32_t width) {
    Records all = birth(7, 1, character(x, 1, U'@'));
    all.worlds.push_back({{cellsAt(0, 0), cellsAt(400, 24)}, width, 20});
    all.views.push_back({cellsAt(x, 0), false, 0, 0});
    all.texts.push_back({0, 0, 0, df::RED, text});
    return all;
  };
  const std::uint32_t before = 0xFFFFFFFF, after = 2;  // the numbers wrap between the two
  Records older = records(3, "old", 60);
  older.objects.push_back({8, 0, kDeath, {}});
  Records newer = records(5, "new", 70);
  newer.objects.push_back({8, 2, kAllGroups, character(6, 1, U'b')});
  Replica expected;
  apply(expected, before, 9, older);
  apply(expected, after, 10, newer);
  Replica late;
  apply(late, after, 10, newer);
  for (int times = 0; times < 2; ++times) apply(late, before, 9, older);
  EXPECT_EQ(late.aliveCount(), 2u);
  for (const Replica* p_replica : {&expected, &late}) {
    EXPECT_EQ(p_replica->newest().number, after);
    EXPECT_EQ(p_replica->checksum(), expected.checksum());
    EXPECT_EQ(p_replica->viewWidth(), 70);
    EXPECT_EQ(p_replica->viewCorner(12), (CellPosition{5, 0}));
    EXPECT_EQ(p_replica->find(7)->state.motion.position, cellsAt(5, 1));
    EXPECT_EQ(p_replica->render(12).text().substr(0, 4), "new\n");
    EXPECT_EQ(countDifferences(p_replica->render(12), expected.render(12)), 0);
  }
}

TEST_F(ReplicaTest, ChecksumCoversOnlyLivingObjects) {
  EXPECT_EQ(replica.checksum(), 0u);
  apply(replica, 1, 0, birth(7, 1, character(1, 0, U'a')));
  const std::uint64_t one = replica.checksum();
  EXPECT_NE(one, 0u);
  apply(replica, 2, 0, birth(8, 1, character(2, 0, U'b')));
  EXPECT_NE(replica.checksum(), one);
  apply(replica, 3, 0, death(8));
  EXPECT_EQ(replica.checksum(), one);
  apply(replica, 4, 0, motion(7, 9));
  EXPECT_NE(replica.checksum(), one);
}

}  // namespace
}  // namespace naiad
