// naiad_capacity_server: hosts busy1000 for any number of players on one core, and reports its figures.
//
//   naiad_capacity_server CORE IDENTITY-DIRECTORY MAX-PLAYERS
//
// Prints `listening ADDRESS --fingerprint …`. On stdin: `begin` starts a measurement; `end` prints its
// figures, a line for each picture of a checked player, and `done`; the end of the input stops it.
#include <cstdio>
#include <iostream>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include "../../net/BusyScene.h"
#include "../Common.h"
#include "engine/events/EventKeyboard.h"
#include "engine/events/EventStep.h"
#include "engine/managers/DisplayManager.h"
#include "engine/managers/WorldManager.h"
#include "engine/world/Capture.h"
#include "engine/world/EventPlayer.h"
#include "engine/world/Object.h"
#include "engine/world/Player.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "host/loop/Host.h"
#include "host/loop/HostEndpoint.h"
#include "shared/program/ProcessSetup.h"
#include "tests/bench/Guarded.h"

namespace {

using namespace bench::capacity;

constexpr double kSpeed = 0.3;

/// A player's object. It moves back and forth at 0.3 cells per tick.
class Runner : public df::Object {
 public:
  Runner() {
    setType("Runner");
    setSolidness(df::SPECTRAL);
    setPosition(df::Vector(WM.randomInt(bench::kBusyWidth), WM.randomInt(bench::kBusyHeight)));
    head(WM.randomInt(2) == 0 ? -1 : 1);
    registerInterest(df::STEP_EVENT);
  }
  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() != df::STEP_EVENT) return 0;
    const double next = getPosition().getX() + getVelocity().getX();
    if (next < 0 || next > bench::kBusyWidth - 1) head(next < 0 ? 1 : -1);
    return 1;
  }
  int draw() override { return DM.drawCh(getPosition(), '@', df::YELLOW); }
  void head(int direction) { setVelocity(df::Vector(kSpeed * direction, 0)); }
};

/// Gives each player a Runner, and passes on keys: one Object receives all keys, because thousands of Runners
/// that each receive all would be slow.
class Usher : public df::Object {
 public:
  Usher() {
    setType("Usher");
    setSolidness(df::SPECTRAL);
    setVisible(false);
    registerInterest(df::JOIN_EVENT);
    registerInterest(df::LEAVE_EVENT);
    registerInterest(df::KEYBOARD_EVENT);
  }
  int eventHandler(const df::Event* p_e) override {
    if (const auto* p_key = dynamic_cast<const df::EventKeyboard*>(p_e)) {
      const auto found = m_runners.find(p_key->getPlayer());
      if (found == m_runners.end()) return 0;
      found->second->head(p_key->getKey() == df::Keyboard::LEFTARROW ? -1 : 1);
      return 1;
    }
    if (const auto* p_join = dynamic_cast<const df::EventJoin*>(p_e)) {
      auto* p_runner = new Runner;
      m_runners[p_join->getPlayer()] = p_runner;
      WM.getPlayer(p_join->getPlayer())->setObject(p_runner);
      return 1;
    }
    if (const auto* p_leave = dynamic_cast<const df::EventLeave*>(p_e)) {
      const auto found = m_runners.find(p_leave->getPlayer());
      if (found == m_runners.end()) return 0;
      WM.markForDelete(found->second);
      m_runners.erase(found);
      return 1;
    }
    return 0;
  }

 private:
  std::unordered_map<std::uint32_t, Runner*> m_runners;
};

/// Checksum of a checked player's screen at a tick.
struct Picture {
  std::uint32_t tick;
  std::uint32_t player;
  std::uint64_t sum;
};

/// Used only on the host's thread.
class Measurement {
 public:
  explicit Measurement(naiad::Host& host) : m_host(host) {}
  void begin() {
    m_before = m_host.context().counters;
    m_host.endpoint().network().resetTickTimes();
    m_pictures.clear();
  }
  void observe(const df::World& world) {
    const auto& view = world.picture().view();
    for (const df::PlayerFacts& player : view.players) {
      if (!isChecked(player.id, view.tick) || !player.name.starts_with(kCheckedName)) continue;
      m_pictures.push_back({view.tick, player.id, pictureSum(world.picture().renderPlayer(player.id))});
    }
  }
  void end() {
    const naiad::Counters& now = m_host.context().counters;
    const naiad::TickTimes& times = m_host.endpoint().network().tickTimes();
    std::printf("figures ticks=%llu late_ticks=%llu tick_p50_us=%lld tick_p99_us=%lld\n",
                static_cast<unsigned long long>(now.ticks - m_before.ticks),
                static_cast<unsigned long long>(now.late_ticks - m_before.late_ticks),
                static_cast<long long>(times.quantile(0.5).count()),
                static_cast<long long>(times.quantile(0.99).count()));
    for (const Picture& picture : m_pictures) {
      std::printf("picture %u %u %llx\n", picture.tick, picture.player,
                  static_cast<unsigned long long>(picture.sum));
    }
    std::printf("done\n");
    std::fflush(stdout);
  }

 private:
  naiad::Host& m_host;
  naiad::Counters m_before;
  std::vector<Picture> m_pictures;
};

int serve(const std::string& identity, int most) {
  naiad::HostOptions options;
  options.port = 0;
  options.identity = identity;
  options.max_players = options.max_per_address = most;  // streams come from one address, datagrams from many
  options.grace = 0;                                     // frees the slots of bots that left after a trial
  naiad::Host host(options, "capacity", [](const std::string& line) {
    const bool routine = line.find("\" left: ") != std::string::npos ||
                         line.find(" joined with ") != std::string::npos ||
                         line.find(" lines about players were not logged") != std::string::npos;
    if (!routine) std::cerr << "server: " << line << "\n";
  });
  Measurement measurement(host);
  host.setObserver([&](df::World& world) { measurement.observe(world); });
  std::printf("listening %s\n", host.endpoint().joinArguments().c_str());
  std::fflush(stdout);
  std::thread control([&] {
    for (std::string line; std::getline(std::cin, line);) {
      if (line == "begin") host.post([&](df::World&) { measurement.begin(); });
      if (line == "end") host.post([&](df::World&) { measurement.end(); });
    }
    host.stop("The measurement is over.");
  });
  df::World world;
  const df::World::Scope scope(world);
  world.setSeed(1);
  world.views().setWindow(80, 24);
  new Usher;
  bench::populateBusy(bench::BusyScene::Kind::kBusy);
  host.run(world);
  world.shutDown();
  control.join();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  if (!pinTo(std::stoi(argv[1]))) return 3;
  return bench::guarded("naiad_capacity_server", [&] { return serve(argv[2], std::stoi(argv[3])); });
}
