// A level load: hundreds of births in one tick, over a connection of one megabit per second.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "SimulatedWorld.h"
#include "host/snapshot/SnapshotSender.h"
#include "shared/replica/Replica.h"
#include "tests/support/net/LossyLink.h"
#include "tests/support/net/VirtualClock.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

constexpr auto kTick = 33'333us;
constexpr auto kDelay = 50ms;
/// The limits that Session uses for datagrams.
constexpr PacketLimits kLimits{4, kMaxDatagramSnapshot, true};
/// Overhead of IP and UDP and of the seal per datagram, in bytes.
constexpr std::size_t kPacketBytes = 28 + 28;

/// A client on a connection of its own, whose queue drops datagrams when it is full.
class Client {
 public:
  Client(VirtualClock& clock, std::uint64_t seed)
      : m_clock(clock),
        m_link(clock, conditions(), seed),
        m_server_end(m_link.takeEnd(LinkEnd::kServer)),
        m_client_end(m_link.takeEnd(LinkEnd::kClient)) {
    m_client_end->start([this](std::string_view packet) { receive(packet.substr(kPacketBytes)); });
    m_server_end->start([this](std::string_view packet) { acknowledge(packet); });
  }

  void tick(const Publisher& publisher, const df::PlayerFacts& player) {
    m_sender.applyTick(publisher, player);
    for (const SnapshotSender::Packet& packet : m_sender.build(publisher, kLimits)) {
      EXPECT_FALSE(packet.large);
      ++packets;
      bytes += packet.bytes.size() + kPacketBytes;
      m_sent_at[packet.number % m_sent_at.size()] = m_clock.now();
      m_server_end->send(std::string(kPacketBytes, '\0') + packet.bytes);
    }
  }
  std::uint64_t dropped() const { return m_link.counters(LinkEnd::kServer).dropped; }
  std::size_t known() const { return m_sender.knownCount(); }

  Replica replica;
  std::size_t packets = 0;
  std::size_t bytes = 0;
  VirtualClock::Time complete_at{};  ///< time when the replica first had `wanted` objects
  std::size_t wanted = 0;
  std::chrono::microseconds latest{0};  ///< delay of the slowest snapshot

 private:
  static LinkConditions conditions() {
    LinkConditions line;
    line.delay = kDelay;
    line.rate = 1'000'000 / 8;
    line.queue = 16'384;
    return line;
  }
  void receive(std::string_view packet) {
    Snapshot snapshot;
    ASSERT_EQ(replica.read(packet, snapshot), ReadResult::kOk);
    replica.apply(snapshot);
    m_acks.addReceived(snapshot.header.number);
    const auto delay = m_clock.now() - m_sent_at[snapshot.header.number % m_sent_at.size()];
    latest = std::max(latest, std::chrono::duration_cast<std::chrono::microseconds>(delay));
    if (wanted != 0 && replica.aliveCount() >= wanted && complete_at == VirtualClock::Time{})
      complete_at = m_clock.now();
    m_client_end->send("ack");
  }
  void acknowledge(std::string_view) { m_sender.acknowledge(m_acks); }

  VirtualClock& m_clock;
  SnapshotSender m_sender;
  LossyDatagramLink m_link;
  std::unique_ptr<DatagramChannel> m_server_end;
  std::unique_ptr<DatagramChannel> m_client_end;
  AckWindow m_acks;
  std::array<VirtualClock::Time, 256> m_sent_at{};
};

/// A world of moving objects with two players: one looks at an empty area into which a level of 700 objects
/// is loaded, the other at a small village.
class LevelLoad {
 public:
  LevelLoad() {
    m_view.boundary = {cells(0, 0), cells(400, 200)};
    for (std::uint32_t i = 0; i < 2; ++i) {
      df::PlayerFacts player;
      player.id = i + 1;
      player.view_corner = i == 0 ? cells(0, 0) : cells(200, 100);
      m_view.players.push_back(player);
    }
    for (std::uint32_t i = 0; i < 30; ++i) bear(cells(205 + 2 * i, 105 + i % 15), {});
  }
  static df::FixedVector cells(std::int32_t x, std::int32_t y) {
    return {df::fromCells(x), df::fromCells(y)};
  }
  void load(int count) {
    for (int i = 0; i < count; ++i) {  // no object leaves the view within ten ticks
      const auto speed = [this] {
        return static_cast<df::Fixed>(m_rng.below(df::kFixedOne)) - df::kFixedOne / 2;
      };
      const df::FixedVector at{static_cast<df::Fixed>(m_rng.below(64 * df::kFixedOne)) + df::fromCells(8),
                               static_cast<df::Fixed>(m_rng.below(16 * df::kFixedOne)) + df::fromCells(4)};
      bear(at, i % 5 == 0 ? df::FixedVector{} : df::FixedVector{speed(), speed() / 2});
    }
  }
  void tick() {
    ++m_view.tick;
    m_publisher.update(m_view);
    m_view.changed.clear();
    for (std::size_t i = 0; i < clients.size(); ++i) clients[i]->tick(m_publisher, m_view.players[i]);
    clock.advanceBy(kTick);
    for (df::ObjectFacts& thing : m_things) {
      if (thing.velocity == df::FixedVector{}) continue;
      thing.position = thing.position + thing.velocity;
      m_view.changed.push_back(thing);
    }
  }

  VirtualClock clock;
  std::vector<std::unique_ptr<Client>> clients;

 private:
  void bear(df::FixedVector at, df::FixedVector velocity) {
    df::ObjectFacts thing;
    thing.key = {static_cast<std::uint32_t>(m_things.size()), 1};
    thing.order = m_things.size() + 1;
    thing.position = at;
    thing.velocity = velocity;
    m_things.push_back(thing);
    m_view.changed.push_back(thing);
  }

  df::WorldView m_view;
  Publisher m_publisher;
  std::vector<df::ObjectFacts> m_things;
  SplitMix64 m_rng{700};
};

TEST(LevelLoad, Sends700BirthsInThreeTicksWithoutDelayingOthers) {
  LevelLoad scene;
  for (std::uint64_t i = 0; i < 2; ++i) scene.clients.push_back(std::make_unique<Client>(scene.clock, i));
  Client& loading = *scene.clients[0];
  Client& other = *scene.clients[1];
  for (int i = 0; i < 30; ++i) scene.tick();
  const auto usual = other.latest;
  const std::size_t before = loading.packets;
  const std::size_t bytes_before = loading.bytes;

  scene.load(700);
  const auto loaded = scene.clock.now();
  loading.wanted = 700;
  for (int i = 0; i < 12; ++i) scene.tick();
  ASSERT_NE(loading.complete_at, VirtualClock::Time{}) << loading.replica.aliveCount();
  const auto took = std::chrono::duration_cast<std::chrono::microseconds>(loading.complete_at - loaded);
  std::printf("births took %.1f ms beyond the delay, %zu bytes in %zu packets\n",
              static_cast<double>((took - kDelay).count()) / 1000, loading.bytes - bytes_before,
              loading.packets - before);
  EXPECT_LE(took, kDelay + 3 * kTick);
  EXPECT_EQ(loading.dropped(), 0u);
  EXPECT_LE(other.latest, usual + 1ms) << "the other client's snapshots are not late";
  EXPECT_GT(other.packets, 0u);
}

}  // namespace
}  // namespace naiad
