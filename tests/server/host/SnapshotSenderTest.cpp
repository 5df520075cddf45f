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
#include "SteeredCopy.h"
#include "UpdateCodec.h"
#include "Vector.h"
#include "VirtualClock.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

df::FixedVector at(double x, double y) {
  return *df::toFixed(df::Vector(x, y));
}

/// A server and a client over two directions of a bad network. Snapshots go down and acknowledgements go up
/// as the messages of the schema, in datagrams of at most 1200 bytes.
class LossyPair {
 public:
  LossyPair(test::WorldConfig config, const LinkConditions& conditions, std::uint64_t seed,
            Resend resend = Resend::kOnGap)
      : sender(resend),
        m_world(config, seed),
        m_link(m_clock, conditions, seed),
        m_server_end(m_link.takeEnd(LinkEnd::kServer)),
        m_client_end(m_link.takeEnd(LinkEnd::kClient)) {
    m_server_end->start([this](std::string_view packet) { serverHears(packet); });
    m_client_end->start([this](std::string_view packet) { clientHears(packet); });
  }

  void tick(bool quiet = false) {
    m_world.tick(quiet);
    m_publisher.update(m_world.view());
    sender.note(m_publisher, m_world.view().players[0]);
    for (const SnapshotSender::Packet& packet : sender.build(m_publisher)) {
      ++snapshots;
      std::vector<std::uint32_t>& lives = m_births[packet.number];
      for (std::uint32_t id = 0; id < sender.known().idCount(); ++id) {
        lives.push_back(sender.known().at(id).birth);
      }
      ASSERT_LE(packet.bytes.size(), packet.large ? kMaxSnapshot : kMaxDatagramSnapshot);
      // What is too large for a datagram would go on the stream; here it goes the same bad way, in no hurry.
      if (packet.large) {
        m_late.push_back(packet.bytes);
      } else {
        m_server_end->send(packet.bytes);
      }
    }
    m_clock.advanceBy(33'333us);
    for (const std::string& bytes : std::exchange(m_late, {})) clientHears(bytes);
  }
  void setConditions(const LinkConditions& conditions) {
    m_link.setConditions(LinkEnd::kServer, conditions);
    m_link.setConditions(LinkEnd::kClient, conditions);
  }

  /// The replica holds exactly what the server thinks it was told, and draws what the world draws.
  void expectSame() {
    std::size_t alive = 0;
    const std::uint32_t tick = m_publisher.tick();
    sender.known().forEachAlive([&](std::uint32_t id, const KnownObjects::Known& known) {
      ++alive;
      const Publisher::Model& model = *m_publisher.find(known.slot);
      const Replica::Entry* entry = replica.find(id);
      ASSERT_NE(entry, nullptr) << "object " << id << " is missing";
      ASSERT_EQ(known.generation, model.generation) << "object " << id;
      EXPECT_EQ(entry->state.order, model.state.order);
      EXPECT_TRUE(entry->state.look == model.state.look) << "object " << id;
      EXPECT_TRUE(entry->state.body == model.state.body) << "object " << id;
      EXPECT_EQ(rebase(entry->state.motion, tick), rebase(model.state.motion, tick)) << "object " << id;
    });
    ASSERT_EQ(replica.aliveCount(), alive) << "ghosts";
    EXPECT_NE(sender.isRight(m_acks, replica.checksum()), std::optional(false));
    expectSamePicture();
  }
  void expectSamePicture() {
    const df::Canvas wanted = m_world.picture(0);
    const df::Canvas seen = replica.render(m_publisher.tick());
    ASSERT_EQ(countDifferences(wanted, seen), 0) << test::explain(wanted, seen);
  }

  const test::SimulatedWorld& world() const { return m_world; }
  const LinkCounters& down() const { return m_link.counters(LinkEnd::kServer); }

  SnapshotSender sender;
  Replica replica;
  std::size_t snapshots = 0;
  std::size_t births = 0;  ///< objects that came to life in the replica
  std::size_t reuses = 0;  ///< … under an id that another one had before
  std::size_t checks = 0;  ///< checksums that were compared

 private:
  void serverHears(std::string_view packet) {
    const auto update = readUpdate(packet, {sender.newestNumber(), m_publisher.tick(), 0});
    ASSERT_TRUE(update);
    sender.acknowledge(update->acks);
    const auto right = sender.isRight(update->acks, *update->checksum);
    checks += right ? 1 : 0;
    ASSERT_NE(right, std::optional(false)) << "after snapshot " << update->acks.newest;
  }

  void clientHears(std::string_view packet) {
    Snapshot snapshot;
    const ReadResult result = replica.read(packet, snapshot);
    ASSERT_NE(result, ReadResult::kMalformed);
    if (result == ReadResult::kStale) return;
    replica.apply(snapshot);
    checkLives(snapshot.header.number);
    m_acks.note(snapshot.header.number);
    ClientUpdate update;
    update.acks = m_acks;
    update.checksum = replica.checksum();
    m_client_end->send(writeUpdate(update));
  }

  // Nobody is born twice: whoever is gone from the replica never comes back to life in it.
  void checkLives(std::uint32_t number) {
    for (const auto& [id, entry] : replica.entries()) {
      const auto was = m_alive.find(id);
      const bool alive = was != m_alive.end() && was->second;
      if (entry.alive && !alive) {
        ++births;
        const std::uint32_t life = m_births.at(number).at(id);
        const auto before = m_lives.find(id);
        if (before != m_lives.end()) {
          ASSERT_LT(before->second, life) << "object " << id << " came back to life";
          ++reuses;
        }
        m_lives[id] = life;
      }
      m_alive[id] = entry.alive;
    }
  }

  VirtualClock m_clock;
  test::SimulatedWorld m_world;
  Publisher m_publisher;
  LossyDatagramLink m_link;
  std::unique_ptr<DatagramChannel> m_server_end;
  std::unique_ptr<DatagramChannel> m_client_end;
  AckWindow m_acks;
  std::vector<std::string> m_late;
  std::map<std::uint32_t, bool> m_alive;           ///< by id
  std::map<std::uint32_t, std::uint32_t> m_lives;  ///< the how-manieth object was seen last, by id
  std::map<std::uint32_t, std::vector<std::uint32_t>>
      m_births;  ///< the how-manieth is meant, by number and id
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
    LossyPair pair(config, bad, seed, static_cast<Resend>(seed % 3));
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
    LossyPair pair(config, bad, seed, static_cast<Resend>(seed % 3));
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

// What is confirmed is not sent again, although newer snapshots that carried it too are still on their way.
TEST(SnapshotSender, WhatIsRepeatedEveryTickIsConfirmedByTheFirstThatArrives) {
  LinkConditions slow;
  slow.delay = 50ms;
  test::WorldConfig config;
  config.objects = 30;
  LossyPair pair(config, slow, 1, Resend::kEveryTick);
  for (int i = 0; i < 60; ++i) pair.tick();
  for (int i = 0; i < 4; ++i) pair.tick(true);
  std::size_t unconfirmed = 0;
  for (int i = 0; i < 40; ++i) {
    pair.tick(true);
    pair.sender.known().forEachAlive([&](std::uint32_t, const KnownObjects::Known& known) {
      unconfirmed += known.unconfirmed != 0 ? 1 : 0;
    });
  }
  EXPECT_LT(unconfirmed, 40u * 3);
  pair.expectSame();
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
  config.objects = 12000;
  config.width = 40;
  config.height = 20;
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
  explicit Direct(std::size_t objects) {
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
  std::vector<SnapshotSender::Packet> tick(SnapshotSender::Room room = {}) {
    note();
    std::vector<SnapshotSender::Packet> packets = sender.build(publisher, room);
    for (const SnapshotSender::Packet& packet : packets) read(packet);
    return packets;
  }
  /// A tick in which nothing is sent: the client is busy.
  void note() {
    ++m_view.tick;
    m_view.players[0] = player;
    publisher.update(m_view);
    m_view.changed.clear();
    m_view.vanished.clear();
    sender.note(publisher, player);
  }
  /// The records of a packet that tick() gave, as a client reads them that got all.
  const Records& decoded(const SnapshotSender::Packet& packet) const { return m_records.at(packet.number); }
  void acknowledge(std::uint32_t newest, std::uint64_t mask = ~std::uint64_t{0}) {
    sender.acknowledge({newest, mask});
  }

  const Replica& reader() const { return m_reader; }

  Publisher publisher;
  SnapshotSender sender;
  df::PlayerFacts player;

 private:
  void read(const SnapshotSender::Packet& packet) {
    Snapshot snapshot;
    ASSERT_EQ(m_reader.read(packet.bytes, snapshot), ReadResult::kOk);
    m_reader.apply(snapshot);
    EXPECT_EQ(snapshot.header.number, packet.number);
    EXPECT_EQ(snapshot.header.tick, packet.tick);
    m_records[packet.number] = snapshot.records;
  }

  df::WorldView m_view;
  Replica m_reader;
  std::map<std::uint32_t, Records> m_records;  ///< by number
};

TEST(SnapshotSender, RespectsTheRecordLimitFor700Births) {
  Direct direct(700);
  const auto snapshots = direct.tick();
  std::set<std::uint32_t> born;
  for (const auto& snapshot : snapshots) {
    EXPECT_LE(snapshot.bytes.size(), kMaxDatagramSnapshot);
    for (const ObjectRecord& record : direct.decoded(snapshot).objects) {
      EXPECT_EQ(record.groups, kAllGroups);
      EXPECT_TRUE(born.insert(record.id).second);
    }
  }
  EXPECT_EQ(born.size(), 700u);
  EXPECT_GT(snapshots.size(), 3u);
  EXPECT_EQ(snapshots[0].number, 1u);
  const Records first = direct.decoded(snapshots[0]);
  EXPECT_EQ(first.worlds.size(), 1u);
  EXPECT_EQ(first.views.size(), 1u);
}

TEST(SnapshotSender, SendsAnEmptySnapshotEveryFifthTick) {
  Direct direct(3);
  ASSERT_EQ(direct.tick().size(), 1u);
  direct.acknowledge(1);
  EXPECT_TRUE(direct.sender.isSettled());
  for (int i = 1; i <= 20; ++i) {
    const auto snapshots = direct.tick();
    ASSERT_EQ(snapshots.size(), i % 5 == 0 ? 1u : 0u) << "tick " << i;
    EXPECT_TRUE(snapshots.empty() || direct.decoded(snapshots[0]).objects.empty());
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
  EXPECT_EQ(direct.decoded(snapshots[0]).objects[0].groups, kAllGroups);
  direct.acknowledge(2, 0);
  facts.position = at(12, 9);
  direct.view().changed.push_back(facts);
  snapshots = direct.tick();
  ASSERT_EQ(snapshots.size(), 1u);
  EXPECT_EQ(direct.decoded(snapshots[0]).objects[0].groups, kMotion);
}

TEST(SnapshotSender, AnObjectThatDiedBeforeItWasSentIsNeverMentioned) {
  Direct direct(2);
  direct.note();
  direct.view().vanished.push_back({0, 1});
  const auto snapshots = direct.tick();
  ASSERT_EQ(snapshots.size(), 1u);
  const Records records = direct.decoded(snapshots[0]);
  ASSERT_EQ(records.objects.size(), 1u);
  EXPECT_EQ(records.objects[0].state.order, 2u);
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
  std::vector<SnapshotSender::Packet> again;
  for (int i = 0; i < 30 && again.empty(); ++i) {
    facts.position = facts.position + facts.velocity;
    direct.view().changed.push_back(facts);
    const auto snapshots = direct.tick();
    if (snapshots.empty()) continue;
    if (!direct.decoded(snapshots[0]).objects.empty()) {
      again = snapshots;
    } else {  // a keep-alive arrives: number 3 and those after it are acknowledged, 2 is not
      direct.acknowledge(snapshots[0].number, (std::uint64_t{1} << empty++) - 1);
    }
  }
  ASSERT_FALSE(again.empty());
  EXPECT_EQ(empty, static_cast<std::uint32_t>(SnapshotSender::kReorder));
  const ObjectRecord record = direct.decoded(again[0]).objects.at(0);
  EXPECT_EQ(record.groups, kMotion);
  // What is sent is the published model: near the true place, and in its cell for as long as it may last.
  EXPECT_LE(std::abs(record.state.motion.position.x - facts.position.x), df::kFixedOne / 2);
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
    for (const SnapshotSender::Packet& packet : direct.tick()) {
      Snapshot snapshot;
      if (arrival == Arrival::kLost || replica.read(packet.bytes, snapshot) != ReadResult::kOk) continue;
      replica.apply(snapshot);
      acks.note(packet.number);
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

TEST(SnapshotSender, AViewFollowsAnotherObjectAtOnceAlthoughTheDeathIsUnconfirmed) {
  Following scene;
  scene.tick(100, 0, Arrival::kBothWays);
  scene.becomeAnother();
  for (int i = 0; i < 20; ++i) {  // the death stays unacknowledged
    scene.tick(100 + 3 * i, 3, Arrival::kDownOnly);
    EXPECT_EQ(scene.replica.aliveCount(), 1u);
    scene.expectSameView();
  }
  scene.tick(160, 3, Arrival::kBothWays);
  scene.tick(163, 3, Arrival::kBothWays);
  EXPECT_EQ(scene.replica.aliveCount(), 1u);
  scene.expectSameView();
}

TEST(SnapshotSender, AcknowledgementsOfWhatWasNeverSentAreIgnored) {
  Direct direct(200);
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
    SnapshotSender sender;
    for (int i = 0; i < 60; ++i) {
      world.tick();
      publisher.update(world.view());
      sender.note(publisher, world.view().players[0]);
      for (const auto& packet : sender.build(publisher)) {
        ASSERT_LE(packet.bytes.size(), packet.large ? kMaxSnapshot : kMaxDatagramSnapshot);
      }
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
  EXPECT_EQ(direct.decoded(snapshots[0]).texts, (std::vector<TextRecord>{{2, 5, 0, df::GREEN, "Score 3"}}));
  EXPECT_FALSE(direct.sender.isSettled()) << "not acknowledged yet";
  direct.acknowledge(2);
  EXPECT_TRUE(direct.tick().empty());
  direct.player.texts.clear();
  snapshots = direct.tick();
  ASSERT_EQ(snapshots.size(), 1u);
  EXPECT_EQ(direct.decoded(snapshots[0]).texts.at(0).text, "");
  direct.acknowledge(3);
  EXPECT_TRUE(direct.sender.isSettled());
  EXPECT_TRUE(direct.tick().empty());
}

TEST(SnapshotSender, SendsNoMoreThanAskedAndTheRestLater) {
  Direct direct(1500);
  EXPECT_EQ(direct.tick({3, 1000, true}).size(), 3u);
  EXPECT_EQ(direct.sender.build(direct.publisher, {2, 1000, true}).size(), 2u);
  EXPECT_GT(direct.sender.build(direct.publisher).size(), 4u);
  EXPECT_TRUE(direct.sender.build(direct.publisher).empty());
}

TEST(SnapshotSender, AProbeCarriesNothingAndMayBeLost) {
  Direct direct(3);
  direct.tick();
  direct.acknowledge(1);
  const SnapshotSender::Packet probe = direct.sender.probe(direct.publisher);
  Snapshot snapshot;
  ASSERT_EQ(direct.reader().read(probe.bytes, snapshot), ReadResult::kOk);
  EXPECT_EQ(snapshot.header.number, 2u);
  EXPECT_EQ(probe.number, 2u);
  EXPECT_EQ(snapshot.header.tick, direct.publisher.tick());
  EXPECT_TRUE(snapshot.header.complete);
  EXPECT_TRUE(snapshot.records.objects.empty());
  EXPECT_TRUE(direct.sender.isSettled());
  for (std::uint32_t number = 3; number < 8; ++number) {
    while (direct.tick().empty()) {
    }
    direct.acknowledge(number, (1u << (number - 3)) - 1);  // all but the probe
  }
  EXPECT_EQ(direct.sender.loss(), 0);
  EXPECT_EQ(direct.sender.resentCount(), 0u);
}

/// A player who steers the only object by declared controls, and what his client knows.
class Steering {
 public:
  Steering() {
    m_table.rows.resize(1);
    m_table.rows[0].effect = df::ControlEffect::kDrive;
    m_table.rows[0].value = at(1, 0);
    m_facts.key = {0, 1};
    m_facts.order = 1;
    m_facts.position = at(10, 5);
    steering().p_table = std::make_shared<df::ControlTable>(m_table);
    steering().object = {0, 1};
    steering().state.steering = true;
  }

  df::SteeringFacts& steering() { return direct.player.steering; }
  const df::ControlTable& table() const { return m_table; }
  /// One tick in which the object is moved by its velocity. Returns whether the state was told.
  bool tick(df::FixedVector velocity, bool arrives = true) {
    m_facts.position = m_facts.position + velocity;
    m_facts.velocity = velocity;
    direct.view().changed.push_back(m_facts);
    steering().position = m_facts.position;
    steering().velocity = velocity;
    steering().state.x.pull = velocity.x;
    bool told = false;
    for (const SnapshotSender::Packet& packet : direct.tick()) {
      told = told || !direct.decoded(packet).controls.empty();
      Snapshot snapshot;
      if (!arrives || replica.read(packet.bytes, snapshot) != ReadResult::kOk) continue;
      replica.apply(snapshot);
      acks.note(packet.number);
    }
    direct.sender.acknowledge(acks);
    return told;
  }
  /// What the client works out is what is.
  void expectKnown() {
    const std::uint32_t now = direct.publisher.tick();
    const ControlRecord known = coast(replica.control(), replica.controlTable(), now);
    EXPECT_EQ(known.position, steering().position);
    EXPECT_EQ(known.velocity, steering().velocity);
    EXPECT_EQ(known.state, steering().state);
    const Replica::Entry* entry = replica.find(known.slot);
    ASSERT_NE(entry, nullptr);
    EXPECT_EQ(entry->generation, known.generation);
    EXPECT_EQ(entry->state.order, 1u);
  }

  Direct direct{0};
  Replica replica;
  AckWindow acks;

 private:
  df::ControlTable m_table;
  df::ObjectFacts m_facts;
};

TEST(SnapshotSender, ControlsAreToldOnceAndTheStateWhereItCannotBeWorkedOut) {
  Steering scene;
  EXPECT_TRUE(scene.tick({}));
  EXPECT_EQ(scene.replica.controlTable(), scene.table());
  EXPECT_EQ(scene.replica.controlNumber(), 1u);
  scene.expectKnown();
  for (int i = 0; i < 40; ++i) EXPECT_FALSE(scene.tick({})) << "at rest, tick " << i;
  EXPECT_TRUE(scene.tick(at(1, 0)));
  for (int i = 0; i < 30; ++i) {
    EXPECT_FALSE(scene.tick(at(1, 0))) << "straight on, tick " << i;
    scene.expectKnown();
  }
  EXPECT_TRUE(scene.tick(at(1, 0))) << "nobody coasts longer";
  EXPECT_EQ(scene.replica.controlTableNumber(), 1u) << "the table came once";
}

TEST(SnapshotSender, AnInputThatChangedNothingIsAnsweredToo) {
  Steering scene;
  scene.tick({});
  scene.direct.sender.noteInput(7, scene.direct.publisher.tick() + 1);
  EXPECT_TRUE(scene.tick({}));
  EXPECT_EQ(scene.replica.control().newest_input, 7u);
  EXPECT_FALSE(scene.tick({}));
}

TEST(SnapshotSender, ControlsThatWereLostComeAgain) {
  Steering scene;
  scene.tick({}, false);
  for (int i = 0; i < 5; ++i) scene.tick({}, false);
  bool told = false;
  for (int i = 0; i < 40; ++i) told = scene.tick(at(i % 7 == 0 ? 1 : 0, 0)) || told;
  EXPECT_TRUE(told);
  EXPECT_EQ(scene.replica.controlTable(), scene.table());
  scene.expectKnown();
}

TEST(SnapshotSender, ControlsThatEndAreToldAsATableWithoutRows) {
  Steering scene;
  scene.tick({});
  scene.steering() = {};
  scene.tick({});
  EXPECT_TRUE(scene.replica.controlTable().rows.empty());
  EXPECT_EQ(scene.replica.controlTableNumber(), 2u);
}

TEST(SnapshotSender, AShipThatTurnsCostsLittle) {
  Steering scene;
  scene.tick({});
  for (int i = 0; i < 10; ++i) scene.tick({});
  scene.direct.sender.noteInput(7, scene.direct.publisher.tick() + 1);
  const std::uint32_t before = scene.replica.controlNumber();
  BitWriter bits;
  ASSERT_TRUE(scene.tick(at(1, 0)));
  ASSERT_GT(scene.replica.controlNumber(), before);
  Origin origin;
  origin.x_bits = 7;
  origin.y_bits = 5;
  writeControlRecord(bits, scene.replica.control(), origin);
  EXPECT_LE(bits.byteCount(), 8u);
}

TEST(SnapshotSender, WhatIsLostWhileItIsOwedAnewIsNoDivergence) {
  Direct direct(1);
  direct.tick();
  direct.acknowledge(1);
  const std::uint64_t before = direct.reader().checksum();
  direct.view().vanished.push_back({0, 1});
  df::ObjectFacts heir;
  heir.key = {1, 1};
  heir.order = 2;
  heir.position = at(3, 3);
  direct.view().changed.push_back(heir);
  const auto second = direct.tick();  // a death and a birth, which do not arrive
  ASSERT_EQ(second.size(), 1u);
  const auto third = direct.sender.probe(direct.publisher).number;
  const auto fourth = direct.sender.probe(direct.publisher).number;
  const auto fifth = direct.sender.probe(direct.publisher).number;
  direct.view().vanished.push_back({1, 1});
  direct.note();  // the death of the heir is owed, and not sent yet
  const AckWindow acks{fifth, 0b1011};
  ASSERT_TRUE(acks.has(fourth) && acks.has(third) && !acks.has(second[0].number) && acks.has(1));
  direct.acknowledge(acks.newest, acks.mask);
  EXPECT_NE(direct.sender.isRight(acks, before), std::optional<bool>(false));
}

TEST(SnapshotSender, AResetTellsTheNewestInputAgain) {
  Direct direct(1);
  direct.sender.noteInput(7, 1);
  direct.tick();
  direct.sender.reset();
  direct.note();
  const auto packets = direct.sender.build(direct.publisher);
  ASSERT_FALSE(packets.empty());
  Snapshot snapshot;
  ASSERT_EQ(Replica::anew(direct.reader().newest()).read(packets[0].bytes, snapshot), ReadResult::kOk);
  EXPECT_TRUE(snapshot.header.tells_input);
  EXPECT_EQ(snapshot.header.input, 7u);
}

}  // namespace
}  // namespace naiad
