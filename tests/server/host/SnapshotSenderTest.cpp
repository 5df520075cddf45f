#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "LossyLink.h"
#include "Replica.h"
#include "SimulatedWorld.h"
#include "SnapshotSender.h"
#include "Vector.h"
#include "VirtualClock.h"
#include "naiad.pb.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kDatagramRecords = 1100;

df::FixedVector at(double x, double y) {
  return *df::toFixed(df::Vector(x, y));
}

/// A server and a client over two directions of a bad network. Snapshots go down and acknowledgements go up
/// as the messages of the schema, in datagrams of at most 1200 bytes.
class LossyPair {
 public:
  LossyPair(test::WorldConfig config, const LinkConditions& conditions, std::uint64_t seed)
      : m_world(config, seed),
        m_link(m_clock, conditions, seed),
        m_server_end(m_link.takeEnd(LinkEnd::kServer)),
        m_client_end(m_link.takeEnd(LinkEnd::kClient)) {
    m_server_end->start([this](std::string_view packet) { serverHears(packet); });
    m_client_end->start([this](std::string_view packet) { clientHears(packet); });
  }

  void tick(bool quiet = false) {
    m_world.tick(quiet);
    m_publisher.update(m_world.view());
    sender.note(m_publisher);
    sender.setPlayer(m_world.view().players[0]);
    for (SnapshotSender::Snapshot& snapshot : sender.build(m_publisher)) {
      ++snapshots;
      ASSERT_LE(snapshot.records.size(), kDatagramRecords);
      checkSlotReuse(snapshot);
      wire::ServerMessage message;
      message.mutable_snapshot()->set_number(snapshot.number);
      message.mutable_snapshot()->set_tick(snapshot.tick);
      message.mutable_snapshot()->set_records(std::move(snapshot.records));
      m_server_end->send(message.SerializeAsString());
    }
    m_clock.advanceBy(33'333us);
  }
  void setConditions(const LinkConditions& conditions) {
    m_link.setConditions(LinkEnd::kServer, conditions);
    m_link.setConditions(LinkEnd::kClient, conditions);
  }

  /// The replica holds exactly the published objects, and draws what the world draws.
  void expectSame() {
    std::size_t alive = 0;
    m_publisher.forEach([&](std::uint32_t slot, const Publisher::Model& model) {
      ++alive;
      const Replica::Entry* entry = replica.find(slot);
      ASSERT_NE(entry, nullptr) << "slot " << slot << " is missing";
      ASSERT_EQ(entry->generation, model.generation) << "slot " << slot;
      EXPECT_EQ(entry->state.order, model.state.order);
      EXPECT_TRUE(entry->state.look == model.state.look) << "slot " << slot;
      EXPECT_TRUE(entry->state.body == model.state.body) << "slot " << slot;
      const std::uint32_t tick = m_publisher.tick();
      EXPECT_EQ(rebase(entry->state.motion, tick), rebase(model.state.motion, tick)) << "slot " << slot;
    });
    ASSERT_EQ(replica.aliveCount(), alive) << "ghosts";
    const df::Canvas wanted = m_world.picture(0);
    const df::Canvas seen = replica.render(m_publisher.tick());
    ASSERT_EQ(countDifferences(wanted, seen), 0) << test::explain(wanted, seen);
  }

  const test::SimulatedWorld& world() const { return m_world; }
  const LinkCounters& down() const { return m_link.counters(LinkEnd::kServer); }

  SnapshotSender sender{kDatagramRecords};
  Replica replica;
  std::size_t snapshots = 0;
  std::size_t births = 0;  ///< objects that came to life in the replica
  std::size_t reuses = 0;  ///< births sent into a slot of which the client knew an older object

 private:
  void serverHears(std::string_view packet) {
    wire::ClientMessage message;
    ASSERT_TRUE(message.ParseFromArray(packet.data(), static_cast<int>(packet.size())));
    sender.acknowledge({message.ack().newest(), message.ack().mask()});
  }

  void clientHears(std::string_view packet) {
    wire::ServerMessage message;
    ASSERT_TRUE(message.ParseFromArray(packet.data(), static_cast<int>(packet.size())));
    const wire::Snapshot& snapshot = message.snapshot();
    const auto records = readRecords(snapshot.records(), snapshot.tick());
    ASSERT_TRUE(records);
    replica.apply(snapshot.number(), snapshot.tick(), *records);
    checkLives();
    m_acks.note(snapshot.number());
    wire::ClientMessage answer;
    answer.mutable_ack()->set_newest(m_acks.newest);
    answer.mutable_ack()->set_mask(m_acks.mask);
    m_client_end->send(answer.SerializeAsString());
  }

  // Nobody is born twice: whoever is gone from the replica never comes back to life in it.
  void checkLives() {
    std::set<std::pair<std::uint32_t, std::uint32_t>> alive;
    for (const auto& [slot, entry] : replica.entries()) {
      if (entry.alive) alive.insert({slot, entry.generation});
    }
    for (const auto& who : alive) {
      if (m_alive.count(who) != 0) continue;
      ++births;
      ASSERT_TRUE(m_ever_alive.insert(who).second) << "slot " << who.first << " came back to life";
    }
    m_alive = std::move(alive);
  }

  // A slot is taken again only after the client confirmed, so surely applied, the death of the one before.
  void checkSlotReuse(const SnapshotSender::Snapshot& snapshot) {
    const auto records = readRecords(snapshot.records, snapshot.tick);
    ASSERT_TRUE(records);
    for (const ObjectRecord& record : records->objects) {
      const auto [told, first] = m_told.emplace(record.slot, record.generation);
      if (first || told->second == record.generation) continue;
      ASSERT_EQ(record.groups, kAllGroups);
      ASSERT_TRUE(isNewer(record.generation, told->second));
      const auto entry = replica.entries().find(record.slot);
      ASSERT_NE(entry, replica.entries().end());
      ASSERT_TRUE(entry->second.generation == told->second && !entry->second.alive)
          << "slot " << record.slot << " was used again too early";
      told->second = record.generation;
      ++reuses;
    }
  }

  VirtualClock m_clock;
  test::SimulatedWorld m_world;
  Publisher m_publisher;
  LossyDatagramLink m_link;
  std::unique_ptr<DatagramChannel> m_server_end;
  std::unique_ptr<DatagramChannel> m_client_end;
  AckWindow m_acks;
  std::set<std::pair<std::uint32_t, std::uint32_t>> m_alive;
  std::set<std::pair<std::uint32_t, std::uint32_t>> m_ever_alive;
  std::map<std::uint32_t, std::uint32_t> m_told;  ///< newest generation sent, by slot
};

TEST(SnapshotSender, EveryReplicaIsRightOnceABadLinkHeals) {
  std::uint64_t lost = 0;
  std::uint64_t reordered = 0;
  std::uint64_t duplicated = 0;
  std::uint64_t resent = 0;
  std::size_t reuses = 0;
  for (std::uint64_t seed = 0; seed < 240; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    SplitMix64 rng(seed);
    LinkConditions bad;
    bad.loss = rng.unit() * 0.3;
    bad.duplicate = rng.unit() * 0.2;
    bad.delay = std::chrono::microseconds(rng.below(150'000));
    bad.jitter = std::chrono::microseconds(rng.below(120'000));
    test::WorldConfig config;
    config.objects = 5 + rng.below(60);
    config.vanish = 0.02;
    config.turn = 0.05;
    LossyPair pair(config, bad, seed);
    for (int i = 0; i < 150 && !testing::Test::HasFatalFailure(); ++i) pair.tick();
    pair.setConditions({});
    for (int i = 0; i < 40 && !testing::Test::HasFatalFailure(); ++i) pair.tick(true);
    EXPECT_TRUE(pair.sender.isSettled());
    pair.expectSame();
    if (testing::Test::HasFailure()) return;
    lost += pair.down().dropped;
    reordered += pair.down().reordered;
    duplicated += pair.down().duplicated;
    resent += pair.sender.resentCount();
    reuses += pair.reuses;
  }
  EXPECT_GT(lost, 1000u);
  EXPECT_GT(reordered, 1000u);
  EXPECT_GT(duplicated, 1000u);
  EXPECT_GT(resent, 1000u);
  EXPECT_GT(reuses, 1000u);
}

TEST(SnapshotSender, FollowingViewsAreRightOnceABadLinkHeals) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    LinkConditions bad;
    bad.loss = 0.3;
    bad.delay = 60ms;
    test::WorldConfig config;
    config.objects = 6;
    config.width = 300;
    config.height = 120;
    config.turn = 0.1;
    config.block = 0.1;
    config.vanish = 0.002;
    LossyPair pair(config, bad, seed);
    for (int i = 0; i < 100 && !testing::Test::HasFatalFailure(); ++i) pair.tick();
    pair.setConditions({});
    // Right at once when all has arrived, not only after the next correction.
    for (int i = 0; i < 40 && !testing::Test::HasFatalFailure(); ++i) {
      pair.tick(true);
      if (pair.sender.isSettled()) pair.expectSame();
    }
    EXPECT_TRUE(pair.sender.isSettled());
    if (testing::Test::HasFailure()) return;
  }
}

TEST(SnapshotSender, NothingIsSentTwiceWhereNothingIsLost) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    LinkConditions slow;
    slow.delay = std::chrono::milliseconds(10 * (seed % 16));
    slow.jitter = 20ms;
    slow.reorder = false;
    slow.duplicate = 0.1;
    test::WorldConfig config;
    config.objects = 60;
    LossyPair pair(config, slow, seed);
    for (int i = 0; i < 150; ++i) pair.tick();
    EXPECT_EQ(pair.sender.resentCount(), 0u);
    pair.setConditions({});
    for (int i = 0; i < 20; ++i) pair.tick(true);
    pair.expectSame();
    if (testing::Test::HasFailure()) return;
  }
}

TEST(SnapshotSender, AWorldLargerThanTheWindowArrivesWithoutResending) {
  LinkConditions slow;
  slow.delay = 70ms;
  test::WorldConfig config;
  config.objects = 6000;
  config.turn = config.block = config.restyle = config.vanish = config.hide = config.reshape = 0;
  LossyPair pair(config, slow, 1);
  for (int i = 0; i < 60 && !testing::Test::HasFatalFailure(); ++i) pair.tick(i > 0);
  EXPECT_GT(pair.snapshots, 2 * SnapshotSender::kMaxInFlight);
  EXPECT_EQ(pair.sender.resentCount(), 0u);
  pair.setConditions({});
  for (int i = 0; i < 10 && !testing::Test::HasFatalFailure(); ++i) pair.tick(true);
  EXPECT_TRUE(pair.sender.isSettled());
  pair.expectSame();
}

TEST(SnapshotSender, ALinkThatWasDeadForSecondsRecovers) {
  LinkConditions dead;
  dead.loss = 1;
  LossyPair pair({}, {}, 3);
  for (int i = 0; i < 20; ++i) pair.tick();
  pair.setConditions(dead);
  for (int i = 0; i < 300; ++i) pair.tick();
  pair.setConditions({});
  for (int i = 0; i < 20; ++i) pair.tick(true);
  EXPECT_TRUE(pair.sender.isSettled());
  pair.expectSame();
}

// By hand, without a link.
class Direct {
 public:
  explicit Direct(std::size_t objects, std::size_t record_limit = kMaxSnapshotRecords)
      : sender(record_limit) {
    m_view.boundary = {at(0, 0), at(80, 24)};
    player.id = 1;
    m_view.players.push_back(player);
    for (std::uint32_t slot = 0; slot < objects; ++slot) {
      df::ObjectFacts facts;
      facts.key = {slot, 1};
      facts.order = slot + 1;
      facts.position = at(slot % 80, slot % 24);
      m_view.changed.push_back(facts);
    }
  }

  df::WorldView& view() { return m_view; }
  std::vector<SnapshotSender::Snapshot> tick() {
    ++m_view.tick;
    publisher.update(m_view);
    m_view.changed.clear();
    m_view.vanished.clear();
    sender.note(publisher);
    sender.setPlayer(player);
    return sender.build(publisher);
  }
  void acknowledge(std::uint32_t newest, std::uint64_t mask = ~std::uint64_t{0}) {
    sender.acknowledge({newest, mask});
  }

  Publisher publisher;
  SnapshotSender sender;
  df::PlayerFacts player;

 private:
  df::WorldView m_view;
};

Records decoded(const SnapshotSender::Snapshot& snapshot) {
  return readRecords(snapshot.records, snapshot.tick).value();
}

TEST(SnapshotSender, RespectsTheRecordLimitFor700Births) {
  Direct direct(700, kDatagramRecords);
  const auto snapshots = direct.tick();
  std::set<std::uint32_t> born;
  for (const auto& snapshot : snapshots) {
    EXPECT_LE(snapshot.records.size(), kDatagramRecords);
    for (const ObjectRecord& record : decoded(snapshot).objects) {
      EXPECT_EQ(record.groups, kAllGroups);
      EXPECT_TRUE(born.insert(record.slot).second);
    }
  }
  EXPECT_EQ(born.size(), 700u);
  EXPECT_GT(snapshots.size(), 10u);
  EXPECT_EQ(snapshots[0].number, 1u);
  EXPECT_EQ(decoded(snapshots[0]).worlds.size(), 1u);
  EXPECT_EQ(decoded(snapshots[0]).views.size(), 1u);
}

TEST(SnapshotSender, SendsAnEmptySnapshotEveryFifthTick) {
  Direct direct(3);
  ASSERT_EQ(direct.tick().size(), 1u);
  direct.acknowledge(1);
  EXPECT_TRUE(direct.sender.isSettled());
  for (int i = 1; i <= 20; ++i) {
    const auto snapshots = direct.tick();
    ASSERT_EQ(snapshots.size(), i % 5 == 0 ? 1u : 0u) << "tick " << i;
    EXPECT_TRUE(snapshots.empty() || snapshots[0].records.empty());
  }
}

TEST(SnapshotSender, UntilABirthIsAcknowledgedEveryRecordIsABirth) {
  Direct direct(1);
  direct.tick();
  df::ObjectFacts facts;
  facts.key = {0, 1};
  facts.order = 1;
  facts.position = at(9, 9);
  direct.view().changed.push_back(facts);
  auto snapshots = direct.tick();
  ASSERT_EQ(snapshots.size(), 1u);
  EXPECT_EQ(decoded(snapshots[0]).objects[0].groups, kAllGroups);
  direct.acknowledge(2, 0);
  facts.position = at(12, 9);
  direct.view().changed.push_back(facts);
  snapshots = direct.tick();
  ASSERT_EQ(snapshots.size(), 1u);
  EXPECT_EQ(decoded(snapshots[0]).objects[0].groups, kMotion);
}

TEST(SnapshotSender, AnObjectThatDiedBeforeItWasSentIsNeverMentioned) {
  Direct direct(2);
  ++direct.view().tick;
  direct.publisher.update(direct.view());
  direct.sender.note(direct.publisher);  // nothing built: the client was busy
  direct.view().changed.clear();
  direct.view().vanished.push_back({0, 1});
  const auto snapshots = direct.tick();
  ASSERT_EQ(snapshots.size(), 1u);
  const Records records = decoded(snapshots[0]);
  ASSERT_EQ(records.objects.size(), 1u);
  EXPECT_EQ(records.objects[0].slot, 1u);
}

TEST(SnapshotSender, ALostSnapshotIsSentAgainInItsNewestState) {
  Direct direct(1);
  direct.tick();
  direct.acknowledge(1);
  df::ObjectFacts facts;
  facts.key = {0, 1};
  facts.order = 1;
  facts.position = at(9, 9);
  facts.velocity = at(1, 0);
  direct.view().changed.push_back(facts);
  ASSERT_EQ(direct.tick().size(), 1u);  // number 2 gets lost
  std::uint32_t empty = 0;
  std::vector<SnapshotSender::Snapshot> again;
  for (int i = 0; i < 30 && again.empty(); ++i) {
    facts.position = facts.position + facts.velocity;
    direct.view().changed.push_back(facts);
    const auto snapshots = direct.tick();
    if (snapshots.empty()) continue;
    if (!snapshots[0].records.empty()) {
      again = snapshots;
    } else {  // a keep-alive arrives: number 3 and those after it are acknowledged, 2 is not
      direct.acknowledge(snapshots[0].number, (std::uint64_t{1} << empty++) - 1);
    }
  }
  ASSERT_FALSE(again.empty());
  EXPECT_EQ(empty, static_cast<std::uint32_t>(SnapshotSender::kReorder));
  const ObjectRecord record = decoded(again[0]).objects.at(0);
  EXPECT_EQ(record.groups, kMotion);
  EXPECT_EQ(record.state.motion.position, facts.position);
  EXPECT_EQ(direct.sender.resentCount(), 1u);
}

enum class Arrival { kLost, kDownOnly, kBothWays };

/// A player whose view (80 by 24, in a wide world) follows the only object, and what the client makes of it.
class Following {
 public:
  Following() {
    direct.view().boundary = {at(0, 0), at(400, 24)};
    direct.player.followed = {0, 1};
    direct.player.view_corner = at(60, 0);
    m_facts.key = {0, 1};
    m_facts.order = 1;
    m_facts.position = at(100, 5);
    direct.view().changed.push_back(m_facts);
  }

  /// One tick in which the object is put at `x`, to fly on with `velocity`.
  void tick(double x, double velocity, Arrival arrival) {
    m_facts.position = at(x, 5);
    m_facts.velocity = at(velocity, 0);
    direct.view().changed.push_back(m_facts);
    const ViewFrame frame{direct.player.view_corner, at(80, 24), direct.view().boundary};
    direct.player.view_corner = followView(frame, m_facts.position);
    for (const SnapshotSender::Snapshot& snapshot : direct.tick()) {
      if (arrival == Arrival::kLost) continue;
      replica.apply(snapshot.number, snapshot.tick, decoded(snapshot));
      acks.note(snapshot.number);
    }
    if (arrival == Arrival::kBothWays) direct.sender.acknowledge(acks);
  }
  void becomeAnother() {
    direct.view().vanished.push_back(m_facts.key);
    direct.player.followed = m_facts.key = {0, ++m_facts.key.generation};
    ++m_facts.order;
  }
  void expectSameView() {
    EXPECT_EQ(replica.viewCorner(direct.publisher.tick()).x, df::cellOf(direct.player.view_corner.x))
        << "tick " << direct.publisher.tick();
  }

  Direct direct{0};
  Replica replica;
  AckWindow acks;

 private:
  df::ObjectFacts m_facts;
};

TEST(SnapshotSender, AViewIsRightAlthoughTheMotionItFollowsCameLate) {
  Following scene;
  scene.tick(100, 0, Arrival::kBothWays);
  scene.expectSameView();
  scene.tick(80, 1, Arrival::kLost);  // pulls the view to the left, and the snapshot is lost
  double x = 80;
  for (int i = 0; i < 25; ++i) scene.tick(x += 1, 1, Arrival::kBothWays);  // too slow to push the view back
  EXPECT_GT(scene.direct.sender.resentCount(), 0u);
  EXPECT_TRUE(scene.direct.sender.isSettled());
  scene.expectSameView();
}

TEST(SnapshotSender, AViewIsRightWhileItsObjectWaitsForTheSlot) {
  Following scene;
  scene.tick(100, 0, Arrival::kBothWays);
  scene.becomeAnother();
  for (int i = 0; i < 20; ++i) {  // the death stays unacknowledged
    scene.tick(100 + 3 * i, 3, Arrival::kDownOnly);
    EXPECT_EQ(scene.replica.aliveCount(), 0u);
    scene.expectSameView();
  }
  scene.tick(160, 3, Arrival::kBothWays);
  scene.tick(163, 3, Arrival::kBothWays);
  EXPECT_EQ(scene.replica.aliveCount(), 1u);
  scene.expectSameView();
}

TEST(SnapshotSender, AcknowledgementsOfWhatWasNeverSentAreIgnored) {
  Direct direct(40, kDatagramRecords);
  const auto snapshots = direct.tick();
  const auto sent = static_cast<std::uint32_t>(snapshots.size());
  for (const std::uint32_t lie :
       {sent + 1, sent + 100, 0x7FFFFFFFu, 0x80000000u, 0x80000001u, 0xFFFFFFFFu, 0u}) {
    direct.acknowledge(lie);
    EXPECT_FALSE(direct.sender.isSettled()) << lie;
  }
  EXPECT_EQ(direct.sender.resentCount(), 0u);
  direct.acknowledge(sent);
  EXPECT_TRUE(direct.sender.isSettled());
}

TEST(SnapshotSender, AnyAcknowledgementsAreHarmless) {
  SplitMix64 rng(8);
  for (int run = 0; run < 50; ++run) {
    test::SimulatedWorld world({}, static_cast<std::uint64_t>(run));
    Publisher publisher;
    SnapshotSender sender(kDatagramRecords);
    for (int i = 0; i < 60; ++i) {
      world.tick();
      publisher.update(world.view());
      sender.note(publisher);
      sender.setPlayer(world.view().players[0]);
      for (const auto& snapshot : sender.build(publisher))
        ASSERT_TRUE(readRecords(snapshot.records, snapshot.tick));
      for (auto n = rng.below(4); n > 0; --n) {
        sender.acknowledge(
            {static_cast<std::uint32_t>(rng.below(5) == 0 ? rng.next() : rng.below(120)), rng.next()});
      }
    }
  }
}

TEST(SnapshotSender, TextsAreSentWhenTheyChange) {
  Direct direct(0);
  direct.tick();
  direct.acknowledge(1);
  direct.player.texts.push_back({2, 5, 0, df::GREEN, "Score 3"});
  auto snapshots = direct.tick();
  ASSERT_EQ(snapshots.size(), 1u);
  EXPECT_EQ(decoded(snapshots[0]).texts, (std::vector<TextRecord>{{2, 5, 0, df::GREEN, "Score 3"}}));
  EXPECT_FALSE(direct.sender.isSettled()) << "not acknowledged yet";
  direct.acknowledge(2);
  EXPECT_TRUE(direct.tick().empty());
  direct.player.texts.clear();
  snapshots = direct.tick();
  ASSERT_EQ(snapshots.size(), 1u);
  EXPECT_EQ(decoded(snapshots[0]).texts.at(0).text, "");
  direct.acknowledge(3);
  EXPECT_TRUE(direct.sender.isSettled());
  EXPECT_TRUE(direct.tick().empty());
}

TEST(SnapshotSender, SendsNoMoreThanAskedAndTheRestLater) {
  Direct direct(700, kDatagramRecords);
  ++direct.view().tick;
  direct.publisher.update(direct.view());
  direct.sender.note(direct.publisher);
  direct.sender.setPlayer(direct.player);
  EXPECT_EQ(direct.sender.build(direct.publisher, 3).size(), 3u);
  EXPECT_EQ(direct.sender.build(direct.publisher, 2).size(), 2u);
  EXPECT_GT(direct.sender.build(direct.publisher).size(), 5u);
  EXPECT_TRUE(direct.sender.build(direct.publisher).empty());
}

}  // namespace
}  // namespace naiad
