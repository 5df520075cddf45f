// Suites of the network in virtual time: snapshot, screen and games.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "ElapsedTime.h"
#include "ResultLine.h"
#include "Suite.h"
#include "engine/world/Capture.h"
#include "engine/world/Player.h"
#include "engine/world/Runner.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldLog.h"
#include "engine/world/WorldStore.h"
#include "host/settings/GameModule.h"
#include "net/BusyScene.h"
#include "net/LinkedClient.h"
#include "shared/values/SplitMix64.h"
#include "tests/server/games/RandomPlayers.h"

namespace bench {
namespace {

using namespace naiad;
using namespace std::chrono_literals;

/// Sums over clients since their last resetFigures().
struct Traffic {
  double down = 0;  ///< bytes
  double up = 0;
  double packets = 0;
  double encode_us = 0;

  void add(const LinkedClient& client) {
    down += static_cast<double>(client.bytes_down);
    up += static_cast<double>(client.bytes_up);
    packets += static_cast<double>(client.packets_down);
    encode_us += std::chrono::duration<double, std::micro>(client.encode).count();
  }
};

const std::pair<Resend, const char*> kPolicies[] = {
    {Resend::kEveryTick, "every"}, {Resend::kOnGap, "gap"}, {Resend::kAhead, "ahead"}};

// snapshot: bytes per client of the 1000-object world and the processor time to encode them, over a lossless
// link of 100 ms round trip in virtual time.

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
  const LinkConditions link{.delay = 50ms, .loss = scene.loss};
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
  Traffic sum;
  long long wrong = 0;
  for (const auto& client : clients) {
    sum.add(client->linked());
    wrong += client->wrong();
  }
  const double client_seconds = static_cast<double>(players) * seconds;
  Line line("snapshot");
  line.add("world", std::string(scene.world))
      .add("view", std::string(scene.all ? "all" : "80x24"))
      .add("loss_percent", 100 * scene.loss)
      .add("resend", std::string(scene.policy))
      .add("kbit_s", 8 * sum.down / 1000 / client_seconds)
      .add("kbit_s_up", 8 * sum.up / 1000 / client_seconds)
      .add("bytes_per_packet", sum.packets > 0 ? sum.down / sum.packets : 0)
      .add("packets_per_s", sum.packets / client_seconds)
      .add("encode_us", sum.encode_us / (client_seconds * 30))
      .add("publish_us", std::chrono::duration<double, std::micro>(publish).count() / (seconds * 30));
  scene.loss == 0 ? line.addZero("wrong_cells", wrong) : line.add("wrong_cells", wrong);
}

const Suite s_snapshot(
    "snapshot", "bytes and microseconds per client of the 1000-object world", [](const Options& options) {
      std::vector<Scene> scenes = {
          {"busy1000", BusyScene::Kind::kBusy, false, 0, Resend::kOnGap, "gap"},
          {"straight1000", BusyScene::Kind::kStraight, true, 0, Resend::kOnGap, "gap"},
          {"still1000", BusyScene::Kind::kStill, true, 0, Resend::kOnGap, "gap"}};
      for (const double loss : {0.02, 0.1}) {
        for (const auto& [resend, policy] : kPolicies)
          scenes.push_back({"busy1000", BusyScene::Kind::kBusy, false, loss, resend, policy});
      }
      for (const Scene& scene : scenes) {
        progress(std::string("snapshot ") + scene.world + " " + scene.policy);
        measure(scene, options.quick);
      }
    });

// screen: share of a player's picture that differs from the server's at an equal instant, and the cost in
// bytes and processor time, for several network conditions. The 1000-object world in an 80 by 24 view, over a
// line in virtual time. At 1000 random instants the client's picture is compared with the truth of the
// server's newest tick. docs/bench.md explains the keys.

/// Share of different cells, among the cells that are not blank in at least one of the two pictures.
struct Share {
  long long wrong = 0;
  long long all = 0;
  void add(const df::Canvas& a, const df::Canvas& b) {
    for (int y = 0; y < a.height(); ++y) {
      for (int x = 0; x < a.width(); ++x) {
        if (a.at(x, y).ch == U' ' && b.at(x, y).ch == U' ') continue;
        ++all;
        wrong += a.at(x, y) == b.at(x, y) ? 0 : 1;
      }
    }
  }
  double percent() const {
    return all > 0 ? 100.0 * static_cast<double>(wrong) / static_cast<double>(all) : 0;
  }
};

struct Case {
  std::chrono::milliseconds round_trip;
  double loss;
  Resend resend;
  const char* policy;
  bool ahead;
};

void measure(const Case& c, bool quick) {
  constexpr int kPlayers = 8;
  const int instants = quick ? 100 : 1000;
  BusyScene scene(BusyScene::Kind::kBusy, 80, 24, kPlayers);
  VirtualClock clock;
  const LinkConditions link{.delay = c.round_trip / 2, .loss = c.loss};
  Publisher publisher;
  std::vector<std::unique_ptr<LinkedClient>> clients;
  for (int i = 0; i < kPlayers; ++i) {
    clients.push_back(std::make_unique<LinkedClient>(clock, link, static_cast<std::uint64_t>(i), c.resend));
  }
  // Number of ticks whose pictures are kept: the newest one that can have arrived at the client, and all
  // later ones.
  const auto kept = static_cast<std::size_t>(link.delay / kTickLength) + 2;
  std::vector<std::deque<df::Canvas>> truths(kPlayers);
  // Ideal clients, which receive everything at once, and copies of their replicas from the last ticks.
  std::vector<std::unique_ptr<LinkedClient>> ideals;
  std::vector<std::deque<Replica>> known(kPlayers);
  for (int i = 0; i < kPlayers; ++i) {
    ideals.push_back(std::make_unique<LinkedClient>(clock, LinkConditions{}, 1, Resend::kOnGap));
  }
  SplitMix64 random(1);
  Share seen;
  Share floor;
  Share still;
  constexpr int kWarmUp = 300;
  for (int i = 0; i < kWarmUp + instants; ++i) {
    if (i == kWarmUp) {
      for (auto& client : clients) client->resetFigures();
    }
    scene.tick();
    publisher.update(scene.world().picture().view());
    const auto& facts = scene.world().picture().view().players;
    for (std::size_t p = 0; p < facts.size(); ++p) {
      clients[p]->tick(publisher, facts[p]);
      ideals[p]->tick(publisher, facts[p]);
      truths[p].push_front(scene.truth(facts[p].id));
      if (truths[p].size() > kept) truths[p].pop_back();
    }
    // A random instant between this tick and the next.
    const std::chrono::microseconds offset(random.below(static_cast<std::uint64_t>(kTickLength.count())));
    clock.advanceBy(offset);
    for (std::size_t p = 0; p < facts.size(); ++p) {
      known[p].push_front(ideals[p]->replica());
      if (known[p].size() > kept) known[p].pop_back();
    }
    for (std::size_t p = 0; i >= kWarmUp && p < facts.size(); ++p) {
      LinkedClient& client = *clients[p];
      client.displayClock().setDelay(c.ahead ? link.delay : 0us);
      const std::uint32_t drawn =
          std::max(client.displayClock().displayTick(client.now()), client.displayClock().newestTick());
      seen.add(truths[p].front(), client.replica().render(drawn));
      const std::int64_t age = (link.delay - offset + kTickLength - 1us) / kTickLength;
      const auto newest = static_cast<std::size_t>(std::max<std::int64_t>(age, 0));
      floor.add(truths[p].front(), known[p][newest].render(publisher.tick()));
      still.add(truths[p].front(), truths[p][newest]);
    }
    clock.advanceBy(kTickLength - offset);
  }
  Traffic sum;
  for (const auto& client : clients) sum.add(*client);
  const double ticks = static_cast<double>(kPlayers) * instants;
  Line("screen")
      .add("rtt_ms", static_cast<int>(c.round_trip / 1ms))
      .add("loss_percent", 100 * c.loss)
      .add("resend", std::string(c.policy))
      .add("ahead", c.ahead ? 1 : 0)
      .add("wrong_percent", seen.percent())
      .add("floor_percent", floor.percent())
      .add("still_percent", still.percent())
      .add("kbit_s", 8 * sum.down / 1000 / (ticks / 30))
      .add("cpu_us", sum.encode_us / ticks);
}

const Suite s_screen("screen", "wrong cells on a player's screen, against bytes and microseconds",
                     [](const Options& options) {
                       for (const auto round_trip : {0ms, 50ms, 100ms, 200ms}) {
                         for (const bool ahead : {false, true})
                           measure(Case{round_trip, 0, Resend::kAhead, "ahead", ahead}, options.quick);
                       }
                       for (const double loss : {0.02, 0.1}) {
                         for (const auto& [resend, policy] : kPolicies)
                           measure(Case{100ms, loss, resend, policy, false}, options.quick);
                       }
                     });

// games: the shipped games with four players pressing random keys. Measures their speed without clients, and
// the server's cost per player with clients over a link of 100 ms round trip, in virtual time.

constexpr std::size_t kPlayers = 4;
constexpr std::uint64_t kSeed = 7;

/// Runs a game's main() in its own world, and calls `play` where the game would run its loop.
class Stage : public df::Runner {
 public:
  template <class Play>
  Stage(const GameModule& game, Play play) : m_play(play) {
    df::World world;
    const df::World::Scope scope(world);
    world.log().setSink([](const std::string&) {});
    world.setSeed(kSeed);
    for (const std::string& folder : game.resourceFolders()) world.extras().resources.addFolder(folder);
    world.setRunner(this);
    if (game.main() != 0) throw std::runtime_error("the game " + game.name() + " did not run");
  }
  void run(df::World& world) override { m_play(world); }

 private:
  std::function<void(df::World&)> m_play;
};

/// Returns the ticks per second of this thread's processor time, which includes the bots' keys and joins.
double ticksPerSecond(const GameModule& game, int ticks) {
  double nanoseconds = 0;
  const Stage stage(game, [&](df::World& world) {
    RandomPlayers players(world, kSeed, kPlayers);
    const double begin = cpuNanoseconds();
    for (int t = 0; t < ticks; ++t) {
      players.play();
      world.tick();
    }
    nanoseconds = cpuNanoseconds() - begin;
  });
  return ticks / (nanoseconds / 1e9);
}

/// Returns a hash of all players' pictures in 1,000 ticks.
std::uint64_t hashOf(const GameModule& game) {
  PictureHash hash;
  const Stage stage(game, [&](df::World& world) {
    RandomPlayers players(world, kSeed, kPlayers);
    for (int t = 0; t < 1000; ++t) {
      players.play();
      world.tick();
      for (const std::uint32_t player : players.players()) hash.add(world.picture().renderPlayer(player));
    }
  });
  return hash.value();
}

struct Cost {
  double microseconds = 0;  ///< server time for the tick and publishing
  Traffic traffic{};
  double player_ticks = 0;
};

Cost costOfPlayers(const GameModule& game, int ticks) {
  Cost cost;
  const Stage stage(game, [&](df::World& world) {
    VirtualClock clock;
    const LinkConditions link{.delay = 50ms};
    Publisher publisher;
    RandomPlayers players(world, kSeed, kPlayers);
    std::map<std::uint32_t, std::unique_ptr<LinkedClient>> clients;
    world.store().setWatched(true);
    for (int t = 0; t < ticks; ++t) {
      players.play();
      const double begin = cpuNanoseconds();
      world.tick();
      publisher.update(world.picture().view());
      cost.microseconds += (cpuNanoseconds() - begin) / 1e3;
      for (const df::PlayerFacts& facts : world.picture().view().players) {
        std::unique_ptr<LinkedClient>& p_client = clients[facts.id];
        if (p_client == nullptr)
          p_client = std::make_unique<LinkedClient>(clock, link, facts.id, Resend::kOnGap);
        p_client->tick(publisher, facts);
        cost.traffic.add(*p_client);
        cost.player_ticks += 1;
        p_client->resetFigures();
      }
      clock.advanceBy(kTickLength);
    }
  });
  return cost;
}

void measure(const std::string& name, bool quick) {
  const GameModule game(name);
  const int ticks = quick ? 1000 : 9000;
  const double speed = ticksPerSecond(game, ticks);
  const Cost cost = costOfPlayers(game, ticks);
  char hash[32];
  std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(hashOf(game)));
  const double seconds = cost.player_ticks / 30;
  Line("games")
      .add("name", name)
      .add("ticks_per_s", speed)
      .add("cpu_us_per_player_tick", (cost.microseconds + cost.traffic.encode_us) / cost.player_ticks)
      .add("kbit_s_per_player", 8 * cost.traffic.down / 1000 / seconds)
      .add("hash", std::string(hash));
}

const Suite s_games("games", "the games that ship: ticks per second, and what a player costs",
                    [](const Options& options) {
                      for (const std::string& name : GameModule::available()) {
                        progress("games " + name);
                        measure(name, options.quick);
                      }
                    });

}  // namespace
}  // namespace bench
