#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

#include "RandomRecords.h"
#include "Replica.h"
#include "Vector.h"

namespace naiad {
namespace {

using test::RandomRecords;

df::FixedVector at(double x, double y) {
  return *df::toFixed(df::Vector(x, y));
}

ObjectState character(double x, double y, char32_t ch, std::int32_t altitude = 2, std::uint64_t order = 1) {
  return {order, {0, at(x, y), {}, {}}, {{{{0, 0, ch, df::CYAN}}}, altitude}, {}};
}

Records birth(std::uint32_t slot, std::uint32_t generation, const ObjectState& state) {
  Records records;
  records.objects.push_back({slot, generation, kAllGroups, state});
  return records;
}

Records death(std::uint32_t slot, std::uint32_t generation) {
  Records records;
  records.objects.push_back({slot, generation, 0, {}});
  return records;
}

Records motion(std::uint32_t slot, std::uint32_t generation, double x) {
  Records records;
  records.objects.push_back({slot, generation, kMotion, character(x, 0, U'?')});
  return records;
}

TEST(Replica, DrawsByAltitudeThenCreationOrderThenTexts) {
  Replica replica;
  replica.apply(1, 0, birth(1, 1, character(3, 1, U'b', 2, 20)));
  replica.apply(2, 0, birth(2, 1, character(3, 1, U'a', 2, 10)));
  replica.apply(3, 0, birth(3, 1, character(3, 1, U'c', 1, 30)));
  EXPECT_EQ(replica.render(0).at(3, 1).ch, U'b');
  replica.apply(4, 0, birth(4, 1, character(3, 1, U'd', 3, 5)));
  EXPECT_EQ(replica.render(0).at(3, 1).ch, U'd');
  Records text;
  text.texts.push_back({0, 2, 1, df::RED, "xé"});
  replica.apply(5, 0, text);
  EXPECT_EQ(replica.render(0).at(2, 1), (df::Cell{U'x', df::RED}));
  EXPECT_EQ(replica.render(0).at(3, 1), (df::Cell{U'é', df::RED}));
}

TEST(Replica, ExtrapolatesBetweenSnapshots) {
  Replica replica;
  ObjectState state = character(10, 5, U'@');
  state.motion = {100, at(10, 5), at(0.5, 0), at(0, 0.25)};
  replica.apply(1, 100, birth(7, 1, state));
  EXPECT_EQ(replica.render(100).at(10, 5).ch, U'@');
  EXPECT_EQ(replica.render(104).at(12, 7).ch, U'@');  // 5 + 6 × 0.25 = 6.5
}

TEST(Replica, IgnoresOlderRecordsOfAGroup) {
  Replica replica;
  replica.apply(1, 0, birth(7, 1, character(1, 0, U'@')));
  replica.apply(5, 0, motion(7, 1, 9));
  replica.apply(3, 0, motion(7, 1, 4));
  EXPECT_EQ(replica.find(7)->state.motion.position, at(9, 0));
  EXPECT_EQ(replica.find(7)->state.look.sequence[0][0].ch, U'@') << "a motion is no look";
}

TEST(Replica, ALateBirthDoesNotBringTheDeadBack) {
  Replica replica;
  replica.apply(2, 0, death(7, 1));
  replica.apply(1, 0, birth(7, 1, character(1, 0, U'@')));
  EXPECT_EQ(replica.find(7), nullptr);
  EXPECT_EQ(replica.aliveCount(), 0u);
}

TEST(Replica, ALateDeathDoesNotKillTheNextInTheSlot) {
  Replica replica;
  replica.apply(1, 0, birth(7, 1, character(1, 0, U'a')));
  replica.apply(3, 0, birth(7, 2, character(2, 0, U'b')));
  replica.apply(2, 0, death(7, 1));
  replica.apply(4, 0, motion(7, 1, 30));
  ASSERT_NE(replica.find(7), nullptr);
  EXPECT_EQ(replica.find(7)->generation, 2u);
  EXPECT_EQ(replica.find(7)->state.motion.position, at(2, 0));
  EXPECT_EQ(replica.aliveCount(), 1u);
}

TEST(Replica, GenerationsAndNumbersWrap) {
  Replica replica;
  replica.apply(0xFFFFFFFE, 0, birth(7, 0xFFFFFFFF, character(1, 0, U'a')));
  replica.apply(0xFFFFFFFF, 0, motion(7, 0xFFFFFFFF, 2));
  replica.apply(1, 0, motion(7, 0xFFFFFFFF, 3));
  EXPECT_EQ(replica.find(7)->state.motion.position, at(3, 0));
  replica.apply(2, 0, birth(7, 1, character(4, 0, U'b')));
  replica.apply(3, 0, death(7, 0xFFFFFFFF));
  ASSERT_NE(replica.find(7), nullptr);
  EXPECT_EQ(replica.find(7)->generation, 1u);
}

TEST(Replica, RecordsAboutUnknownObjectsDrawNothing) {
  Replica replica;
  replica.apply(1, 0, motion(7, 1, 5));
  EXPECT_EQ(replica.aliveCount(), 0u);
  EXPECT_EQ(countDifferences(replica.render(0), df::Canvas(80, 24)), 0);
}

TEST(Replica, AnEmptyTextIsGone) {
  Replica replica;
  Records text;
  text.texts.push_back({3, 0, 0, df::RED, "score"});
  replica.apply(1, 0, text);
  text.texts[0].text.clear();
  replica.apply(2, 0, text);
  EXPECT_EQ(replica.render(0).text(), df::Canvas(80, 24).text());
}

TEST(Replica, FollowsTheObjectOfTheViewRecord) {
  Replica replica;
  Records records = birth(7, 1, character(50, 12, U'@'));
  records.worlds.push_back({{at(0, 0), at(400, 24)}, 60, 20});
  records.views.push_back({at(20, 0), 7, 1});
  records.objects[0].state.motion = {10, at(50, 12), at(1, 0), {}};
  replica.apply(1, 10, records);
  EXPECT_EQ(replica.viewCorner(20), (CellPosition{20, 0}));
  EXPECT_EQ(replica.viewCorner(40), (CellPosition{40, 0}));
  EXPECT_EQ(replica.focus(40), (CellPosition{40, 12}));
  EXPECT_EQ(replica.render(40).at(40, 12).ch, U'@');
  replica.apply(2, 40, death(7, 1));
  EXPECT_EQ(replica.viewCorner(40), (CellPosition{20, 0}));
  EXPECT_EQ(replica.focus(40), (CellPosition{30, 10}));
}

TEST(Replica, IsBoundedWhateverItIsSent) {
  Replica replica;
  for (std::uint32_t slot = 0; slot < kMaxReplicaObjects + 10; ++slot) {
    replica.apply(slot + 1, 0, birth(slot, 1, {}));
  }
  EXPECT_EQ(replica.entries().size(), kMaxReplicaObjects);
  EXPECT_EQ(replica.overflowCount(), 10u);
}

TEST(Replica, LooksAreBoundedInAll) {
  Replica replica;
  ObjectState huge = character(1, 1, U'x');
  huge.look.sequence = {Appearance(8192, Glyph{0, 0, U'#', df::RED})};
  const std::uint32_t fits = kMaxReplicaGlyphs / 8192;
  std::uint32_t number = 0;
  for (std::uint32_t slot = 0; slot < fits + 10; ++slot) replica.apply(++number, 0, birth(slot, 1, huge));
  EXPECT_EQ(replica.overflowCount(), 10u);
  EXPECT_EQ(replica.find(fits - 1)->state.look, huge.look);
  EXPECT_TRUE(replica.find(fits)->state.look.sequence.empty());
  // Deaths, other births in the same slot and other looks give room back.
  replica.apply(++number, 0, death(0, 1));
  replica.apply(++number, 0, birth(1, 2, character(1, 1, U'x')));
  Records look;
  look.objects.push_back({2, 1, kLook, character(1, 1, U'x')});
  replica.apply(++number, 0, look);
  for (std::uint32_t slot = fits; slot < fits + 3; ++slot) replica.apply(++number, 0, birth(slot, 2, huge));
  EXPECT_EQ(replica.overflowCount(), 11u) << "three large looks went, two small ones came";
  EXPECT_EQ(replica.find(fits + 1)->state.look, huge.look);
}

// A server's history as the rules allow it: births are complete, partial records name only objects whose
// birth was acknowledged, a slot is taken again after its death was sent. `settled` says which snapshots must
// have been applied before: those that were acknowledged when it was sent.
struct Sent {
  std::uint32_t number;
  std::uint32_t tick;
  Records records;
  std::size_t settled;
};

class History {
 public:
  explicit History(std::uint64_t seed) : m_random(seed) {}

  std::vector<Sent> write(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      if (m_random.chance(0.15)) m_settled = m_sent.size();
      m_tick += static_cast<std::uint32_t>(m_random.rng().below(3));
      Records records;
      if (m_random.chance(0.1)) records.worlds.push_back(m_random.world());
      if (m_random.chance(0.2)) records.views.push_back(m_random.view());
      if (m_random.chance(0.2)) records.texts.push_back(m_random.text());
      for (std::uint32_t slot = 0; slot < kSlots; ++slot) {
        if (m_random.chance(0.3)) records.objects.push_back(about(slot));
      }
      m_sent.push_back({m_number, m_tick, std::move(records), m_settled});
      if (++m_number == 0) m_number = 1;
    }
    return m_sent;
  }

 private:
  static constexpr std::uint32_t kSlots = 8;
  struct Life {
    std::uint32_t generation = 0;
    bool alive = false;
    std::size_t born = 0;  ///< index of the first snapshot with its birth
    std::uint64_t order = 0;
  };

  ObjectRecord about(std::uint32_t slot) {
    Life& life = m_lives[slot];
    ObjectRecord record = m_random.object(m_tick);
    record.slot = slot;
    if (!life.alive) {
      const std::uint32_t next = life.generation == 0 ? 0xFFFFFFFD : life.generation + 1;
      life = {next == 0 ? 1 : next, true, m_sent.size(), m_random.rng().next()};
    } else if (m_random.chance(0.2)) {
      life.alive = false;
      return {slot, life.generation, 0, {}};
    }
    record.generation = life.generation;
    const bool known = life.born < m_settled;
    record.groups = known ? static_cast<std::uint8_t>(2 * (1 + m_random.rng().below(7))) : kAllGroups;
    record.state = m_random.state(m_tick);
    record.state.order = life.order;
    return record;
  }

  RandomRecords m_random;
  std::vector<Sent> m_sent;
  std::size_t m_settled = 0;
  std::uint32_t m_number = 0xFFFFFFF0;
  std::uint32_t m_tick = 0xFFFFFFF0;
  std::map<std::uint32_t, Life> m_lives;
};

// An order of arrival with duplicates that keeps what `settled` demands.
std::vector<std::size_t> shuffled(const std::vector<Sent>& sent, SplitMix64& rng) {
  std::vector<std::size_t> order;
  std::vector<bool> arrived(sent.size(), false);
  std::size_t whole = 0;  // all before this index arrived
  while (whole < sent.size()) {
    std::size_t pick = whole + rng.below(12);
    if (rng.below(4) == 0 && whole > 0) pick = rng.below(whole);  // again
    if (pick >= sent.size() || sent[pick].settled > whole) continue;
    arrived[pick] = true;
    order.push_back(pick);
    while (whole < sent.size() && arrived[whole]) ++whole;
  }
  return order;
}

void expectSameState(const Replica& a, const Replica& b, std::uint32_t tick) {
  ASSERT_EQ(a.aliveCount(), b.aliveCount());
  for (const auto& [slot, entry] : a.entries()) {
    const Replica::Entry* other = b.find(slot);
    ASSERT_EQ(entry.alive, other != nullptr) << "slot " << slot;
    if (!entry.alive) continue;
    ASSERT_EQ(entry.generation, other->generation);
    ASSERT_TRUE(entry.state == other->state) << "slot " << slot;
  }
  for (const std::uint32_t later : {tick, tick + 7}) {
    ASSERT_EQ(a.viewCorner(later), b.viewCorner(later));
    ASSERT_EQ(countDifferences(a.render(later), b.render(later)), 0);
  }
}

TEST(Replica, EndsTheSameWhateverTheOrderOfArrivalWithDuplicates) {
  std::size_t deaths = 0;
  std::size_t partial = 0;
  std::size_t reused = 0;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    const std::vector<Sent> sent = History(seed).write(80);
    Replica in_order;
    for (const Sent& s : sent) {
      in_order.apply(s.number, s.tick, s.records);
      for (const ObjectRecord& record : s.records.objects) {
        deaths += record.groups == 0 ? 1 : 0;
        partial += record.groups != 0 && record.groups != kAllGroups ? 1 : 0;
        reused += record.groups == kAllGroups && record.generation != 0xFFFFFFFD ? 1 : 0;
      }
    }
    SplitMix64 rng(seed);
    for (int permutation = 0; permutation < 4; ++permutation) {
      Replica replica;
      for (const std::size_t i : shuffled(sent, rng))
        replica.apply(sent[i].number, sent[i].tick, sent[i].records);
      expectSameState(in_order, replica, sent.back().tick);
      if (HasFatalFailure()) FAIL() << "seed " << seed << ", permutation " << permutation;
    }
  }
  EXPECT_GT(deaths, 1000u);
  EXPECT_GT(partial, 1000u);
  EXPECT_GT(reused, 1000u);
}

}  // namespace
}  // namespace naiad
