// snapshot: what a client of the 1000-object world costs on the line, and the processor to encode, over a
// link of 100 ms there and back in virtual time that loses nothing.
#include <chrono>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "Line.h"
#include "LossyLink.h"
#include "Publisher.h"
#include "Replica.h"
#include "SnapshotSender.h"
#include "Suite.h"
#include "UpdateCodec.h"
#include "VirtualClock.h"
#include "net/BusyScene.h"

namespace bench {

namespace {

using namespace naiad;
using namespace std::chrono_literals;

constexpr auto kTick = 33'333us;
constexpr double kSecondsPerTick = 1.0 / 30;
/// Around a snapshot: IPv4 and UDP headers, those of the datagram, its seal, its field of flags.
constexpr std::size_t kDownOverhead = 28 + 3 + 16 + 1;
constexpr std::size_t kUpOverhead = 28 + 11 + 16 + 1;

class Client {
 public:
  Client(VirtualClock& clock, const LinkConditions& conditions, std::uint64_t seed, Resend resend)
      : m_sender(resend),
        m_link(clock, conditions, seed),
        m_server(m_link.takeEnd(LinkEnd::kServer)),
        m_client(m_link.takeEnd(LinkEnd::kClient)) {
    m_server->start([this](std::string_view bytes) { serverHears(bytes); });
    m_client->start([this](std::string_view bytes) { clientHears(bytes); });
  }

  void tick(const Publisher& publisher, const df::PlayerFacts& player, const df::Canvas& truth) {
    m_truths.emplace(publisher.tick(), truth);
    m_tick = publisher.tick();
    const auto begin = std::chrono::steady_clock::now();
    m_sender.note(publisher, player);
    const std::vector<SnapshotSender::Packet> packets = m_sender.build(publisher);
    encode += std::chrono::steady_clock::now() - begin;
    for (const SnapshotSender::Packet& packet : packets) {
      bytes_down += packet.bytes.size() + kDownOverhead;
      ++packets_down;
      m_server->send(packet.bytes);
    }
  }
  void resetFigures() {
    bytes_down = bytes_up = packets_down = 0;
    wrong = seen = 0;
    encode = {};
  }

  std::size_t bytes_down = 0;
  std::size_t bytes_up = 0;
  std::size_t packets_down = 0;
  long long wrong = 0;
  long long seen = 0;
  std::chrono::steady_clock::duration encode{};
  const SnapshotSender& sender() const { return m_sender; }

 private:
  void serverHears(std::string_view bytes) {
    const auto update = readUpdate(bytes, {m_sender.newestNumber(), m_tick, 0});
    if (!update) return void(++wrong);
    m_sender.acknowledge(update->acks);
  }
  void clientHears(std::string_view bytes) {
    Snapshot snapshot;
    if (m_replica.read(bytes, snapshot) != ReadResult::kOk) return;
    // Between snapshots the picture runs on; each tick up to this one was on the screen for a while.
    for (auto it = m_truths.begin(); it != m_truths.end() && it->first <= snapshot.header.tick;) {
      if (it->first == snapshot.header.tick) m_replica.apply(snapshot);
      if (m_replica.newest().number != 0) compare(it->second, m_replica.render(it->first));
      it = m_truths.erase(it);
    }
    if (m_replica.newest().number != snapshot.header.number) m_replica.apply(snapshot);
    m_acks.note(snapshot.header.number);
    ClientUpdate update;
    update.acks = m_acks;
    const std::string answer = writeUpdate(update);
    bytes_up += answer.size() + kUpOverhead;
    m_client->send(answer);
  }
  void compare(const df::Canvas& truth, const df::Canvas& screen) {
    wrong += countDifferences(truth, screen);
    ++seen;
  }

  SnapshotSender m_sender;
  Replica m_replica;
  AckWindow m_acks;
  std::uint32_t m_tick = 0;
  std::map<std::uint32_t, df::Canvas> m_truths;
  LossyDatagramLink m_link;
  std::unique_ptr<DatagramChannel> m_server;
  std::unique_ptr<DatagramChannel> m_client;
};

struct Scene {
  const char* world;
  BusyScene::Kind kind;
  bool all;  ///< the view is the world
  double loss;
  Resend resend;
  const char* policy;
};

void measure(const Scene& scene, bool quick) {
  const int seconds = quick ? 10 : 60;
  const int players = scene.all ? 2 : 16;
  BusyScene world(scene.kind, 1000, scene.all ? kBusyWidth : 80, scene.all ? kBusyHeight : 24, players, 1);
  VirtualClock clock;
  LinkConditions link;
  link.delay = 50ms;
  link.loss = scene.loss;
  Publisher publisher;
  std::vector<std::unique_ptr<Client>> clients;
  for (int i = 0; i < players; ++i) {
    clients.push_back(std::make_unique<Client>(clock, link, static_cast<std::uint64_t>(i), scene.resend));
  }
  std::chrono::steady_clock::duration publish{};
  // A minute to settle: coarse models of paths that never end have been replaced by then.
  const int warm_up = (quick ? 5 : 60) * 30;
  for (int i = 0; i < warm_up + seconds * 30; ++i) {
    if (i == warm_up) {
      for (auto& client : clients) client->resetFigures();
      publish = {};
    }
    world.tick();
    const auto begin = std::chrono::steady_clock::now();
    publisher.update(world.world().view());
    publish += std::chrono::steady_clock::now() - begin;
    const auto& facts = world.world().view().players;
    for (std::size_t p = 0; p < facts.size(); ++p) {
      clients[p]->tick(publisher, facts[p], world.truth(facts[p].id));
    }
    clock.advanceBy(kTick);
  }
  double down = 0;
  double up = 0;
  double packets = 0;
  double encode = 0;
  long long wrong = 0;
  for (const auto& client : clients) {
    down += static_cast<double>(client->bytes_down);
    up += static_cast<double>(client->bytes_up);
    packets += static_cast<double>(client->packets_down);
    encode += std::chrono::duration<double, std::micro>(client->encode).count();
    wrong += client->wrong;
  }
  const double client_seconds = static_cast<double>(players) * seconds;
  Line line("snapshot");
  line.add("world", std::string(scene.world))
      .add("view", std::string(scene.all ? "all" : "80x24"))
      .add("loss_percent", 100 * scene.loss)
      .add("resend", std::string(scene.policy))
      .add("kbit_s", 8 * down / 1000 / client_seconds)
      .add("kbit_s_up", 8 * up / 1000 / client_seconds)
      .add("bytes_per_packet", packets > 0 ? down / packets : 0)
      .add("packets_per_s", packets / client_seconds)
      .add("encode_us", encode / (client_seconds / kSecondsPerTick))
      .add("publish_us",
           std::chrono::duration<double, std::micro>(publish).count() / (seconds / kSecondsPerTick));
  if (scene.loss == 0) {
    line.addZero("wrong_cells", wrong);
  } else {
    line.add("wrong_cells", wrong);
  }
}

const Suite s_suite("snapshot", "bytes and microseconds per client of the 1000-object world",
                    [](const Options& options) {
                      const std::vector<Scene> scenes = {
                          {"busy1000", BusyScene::Kind::kBusy, false, 0, Resend::kOnGap, "gap"},
                          {"straight1000", BusyScene::Kind::kStraight, true, 0, Resend::kOnGap, "gap"},
                          {"still1000", BusyScene::Kind::kStill, true, 0, Resend::kOnGap, "gap"},
                          {"busy1000", BusyScene::Kind::kBusy, false, 0.02, Resend::kEveryTick, "every"},
                          {"busy1000", BusyScene::Kind::kBusy, false, 0.02, Resend::kOnGap, "gap"},
                          {"busy1000", BusyScene::Kind::kBusy, false, 0.02, Resend::kAhead, "ahead"},
                          {"busy1000", BusyScene::Kind::kBusy, false, 0.1, Resend::kEveryTick, "every"},
                          {"busy1000", BusyScene::Kind::kBusy, false, 0.1, Resend::kOnGap, "gap"},
                          {"busy1000", BusyScene::Kind::kBusy, false, 0.1, Resend::kAhead, "ahead"},
                      };
                      for (const Scene& scene : scenes) {
                        progress(std::string("snapshot ") + scene.world + " " + scene.policy);
                        measure(scene, options.quick);
                      }
                    });

}  // namespace

}  // namespace bench
