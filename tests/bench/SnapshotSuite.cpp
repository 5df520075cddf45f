// snapshot: bytes per client of the 1000-object world and the processor time to encode them, over a lossless
// link of 100 ms round trip in virtual time.
#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "ResultLine.h"
#include "Suite.h"
#include "engine/world/Capture.h"
#include "net/BusyScene.h"
#include "net/LinkedClient.h"

namespace bench {
namespace {

using namespace naiad;
using namespace std::chrono_literals;

constexpr double kSecondsPerTick = 1.0 / 30;

/// A client, and the errors of its pictures, tick by tick.
class Client {
 public:
  Client(VirtualClock& clock, const LinkConditions& conditions, std::uint64_t seed, Resend resend)
      : m_linked(clock, conditions, seed, resend) {
    m_linked.on_snapshot = [this](const Snapshot& snapshot) { compareUntil(snapshot.header.tick); };
  }

  void tick(const Publisher& publisher, const df::PlayerFacts& player, const df::Canvas& truth) {
    m_truths.emplace(publisher.tick(), truth);
    m_linked.tick(publisher, player);
  }
  void resetFigures() {
    m_linked.resetFigures();
    m_wrong = 0;
  }
  const LinkedClient& linked() const { return m_linked; }
  long long wrong() const { return m_wrong; }

 private:
  // Compares the ticks before `tick`. The client extrapolates between snapshots, so it showed each of them as
  // its replica draws it now.
  void compareUntil(std::uint32_t tick) {
    auto it = m_truths.begin();
    for (; it != m_truths.end() && it->first < tick; it = m_truths.erase(it)) {
      if (m_linked.replica().newest().number == 0) continue;
      m_wrong += countDifferences(it->second, m_linked.replica().render(it->first));
    }
  }

  LinkedClient m_linked;
  std::map<std::uint32_t, df::Canvas> m_truths;  ///< true pictures that are not compared yet
  long long m_wrong = 0;
};

struct Scene {
  const char* world;
  BusyScene::Kind kind;
  bool all;  ///< the view is the whole world
  double loss;
  Resend resend;
  const char* policy;
};

void measure(const Scene& scene, bool quick) {
  const int seconds = quick ? 10 : 60;
  const int players = scene.all ? 2 : 16;
  BusyScene world(scene.kind, scene.all ? kBusyWidth : 80, scene.all ? kBusyHeight : 24, players);
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
  // One minute of warm-up, after which coarse motion models of endless paths have been replaced.
  const int warm_up = 60 * 30;
  for (int i = 0; i < warm_up + seconds * 30; ++i) {
    if (i == warm_up) {
      for (auto& client : clients) client->resetFigures();
      publish = {};
    }
    world.tick();
    const auto begin = std::chrono::steady_clock::now();
    publisher.update(world.world().picture().view());
    publish += std::chrono::steady_clock::now() - begin;
    const auto& facts = world.world().picture().view().players;
    for (std::size_t p = 0; p < facts.size(); ++p) {
      clients[p]->tick(publisher, facts[p], world.truth(facts[p].id));
    }
    clock.advanceBy(kTickLength);
  }
  double down = 0;
  double up = 0;
  double packets = 0;
  double encode = 0;
  long long wrong = 0;
  for (const auto& client : clients) {
    down += static_cast<double>(client->linked().bytes_down);
    up += static_cast<double>(client->linked().bytes_up);
    packets += static_cast<double>(client->linked().packets_down);
    encode += std::chrono::duration<double, std::micro>(client->linked().encode).count();
    wrong += client->wrong();
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
