// games: the shipped games with four players pressing random keys. Measures their speed without clients, and
// the server's cost per player with clients over a link of 100 ms round trip, in virtual time.
#include <chrono>
#include <cstdio>
#include <map>
#include <memory>
#include <string>

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
#include "net/LinkedClient.h"
#include "tests/server/games/RandomPlayers.h"

namespace bench {
namespace {

using namespace naiad;
using namespace std::chrono_literals;

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
  double microseconds = 0;  ///< server time for the tick, publishing and encoding
  double bytes = 0;         ///< bytes sent to the clients
  double player_ticks = 0;
};

Cost costOfPlayers(const GameModule& game, int ticks) {
  Cost cost;
  const Stage stage(game, [&](df::World& world) {
    VirtualClock clock;
    LinkConditions link;
    link.delay = 50ms;
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
      std::map<std::uint32_t, std::unique_ptr<LinkedClient>> here;
      for (const df::PlayerFacts& facts : world.picture().view().players) {
        std::unique_ptr<LinkedClient>& p_client = here[facts.id];
        p_client = std::move(clients[facts.id]);
        if (p_client == nullptr)
          p_client = std::make_unique<LinkedClient>(clock, link, facts.id, Resend::kOnGap);
        p_client->tick(publisher, facts);
        cost.microseconds += std::chrono::duration<double, std::micro>(p_client->encode).count();
        cost.bytes += static_cast<double>(p_client->bytes_down);
        cost.player_ticks += 1;
        p_client->resetFigures();
      }
      clients = std::move(here);
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
      .add("cpu_us_per_player_tick", cost.microseconds / cost.player_ticks)
      .add("kbit_s_per_player", 8 * cost.bytes / 1000 / seconds)
      .add("hash", std::string(hash));
}

const Suite s_suite("games", "the games that ship: ticks per second, and what a player costs",
                    [](const Options& options) {
                      for (const std::string& name : GameModule::available()) {
                        progress("games " + name);
                        measure(name, options.quick);
                      }
                    });

}  // namespace
}  // namespace bench
