// Newcomers to a round that a killed server left: they see the game within a second, with an id and a color
// that no other player has. The world is the engine's, the journal is in memory, and the test advances the
// time.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <ostream>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "engine/managers/DisplayManager.h"
#include "engine/world/Capture.h"
#include "engine/world/EventPlayer.h"
#include "engine/world/Object.h"
#include "engine/world/Views.h"
#include "host/world/WorldInProcess.h"
#include "tests/server/host/rooms/HostRooms.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;
using test::Client;
using test::helloOf;

struct Pawn : df::Object {
  explicit Pawn(int column = 0) {
    setPosition(df::Vector(column, 5));
    setSolidness(df::SPECTRAL);
    if (column == 0) registerInterest(df::JOIN_EVENT);
  }
  int eventHandler(const df::Event* p_e) override {
    const auto* p_join = dynamic_cast<const df::EventJoin*>(p_e);
    if (p_join != nullptr) new Pawn(static_cast<int>(p_join->getPlayer()));
    return p_join != nullptr ? 1 : 0;
  }
  int draw() override { return DM.drawCh(getPosition(), '@', df::CYAN); }
};

/// A world of the engine that answers a turn later, like one in another process.
class LateWorld : public WorldPort {
 public:
  explicit LateWorld(df::World& world) : m_world(world) {}
  bool isReady() const override { return m_turns.empty(); }
  void tick(const SentTurn& turn) override { m_turns.push_back(turn); }
  void answer() {
    while (!m_turns.empty()) {
      const SentTurn turn = std::move(m_turns.front());
      m_turns.pop_front();
      applyTurn(turn.turn, m_world);
      m_world.tick();
      m_answer = popAnswer(turn.turn, m_world);
      reportTick();
    }
  }
  std::uint32_t nextTick() const override {
    return static_cast<std::uint32_t>(m_world.getStepCount()) + 1 +
           static_cast<std::uint32_t>(m_turns.size());
  }
  std::uint32_t ticksBefore() const override { return 0; }
  const df::WorldView& view() const override { return m_world.picture().view(); }

 private:
  df::World& m_world;
  std::deque<SentTurn> m_turns;
};

/// A server that begins a round or resumes that of `records`, until its destruction, which is a kill.
class ResumingServer : public test::HostRooms {
 public:
  ResumingServer(std::string records, bool is_late, int places, SessionTable::Clock::time_point begin)
      : m_records(std::move(records)) {
    now = begin;
    new Pawn;
    options.max_players = places;
    options.max_per_address = 32;
    options.grace = 1;
    rooms.setWorlds([this, is_late](asio::io_context&) { return makeRound(is_late); });
    rooms.setOnRound([](Room&) {},
                     [this](Room& room, const std::vector<PersistedSession>& persisted) {
                       admission().restoreSessions(room, persisted);
                     });
    admission();
    for (int i = 0; i < 10'000 && rooms.recovering(); ++i) tick();
  }
  ~ResumingServer() override {
    world.shutDown();  // deletes the Objects
  }

  Client& greet(const std::string& name, const std::string& token = "") {
    wire::Hello hello = helloOf(name);
    hello.set_resume_token(token);
    hello.set_new_process(!token.empty());
    return HostRooms::greet(hello, "192.0.2." + std::to_string(clients.size() + 1) + ":1");
  }
  void tick() {
    now += 33ms;
    ++counters.ticks;
    sessions.forEach([this](Session& session) { session.checkDeadlines(now); });
    rooms.checkWorlds(now);
    admission().evaluateWaiting();
    rooms.beginTicks();
    m_p_port->answer();
    sessions.sweep();
  }
  void play(int ticks) {
    while (ticks-- > 0) tick();
  }
  std::string records() const {
    std::string all = m_records;
    m_journal->ring().peek(all, 1 << 20);
    return all;
  }

 private:
  std::unique_ptr<Round> makeRound(bool is_late) {
    auto port = std::make_unique<LateWorld>(world);
    m_p_port = port.get();
    Round::JournalBinding book = test::ringJournal();
    m_journal = book.journal;
    if (!m_records.empty()) {
      auto round = std::make_shared<UnfinishedRound>(DfrHeader(), m_records);
      if (is_late) round->dropSessions();
      book.recovery = std::make_unique<RoundRecovery>(round);
      book.on_recovered = [](std::uint32_t, const std::string& problem) { EXPECT_EQ(problem, ""); };
    }
    return std::make_unique<Round>(std::move(port), std::move(book));
  }

  const std::string m_records;
  LateWorld* m_p_port = nullptr;
  std::shared_ptr<Journal> m_journal;
};

/// A way to resume a round. Three players play it first.
struct ResumeWay {
  const char* p_name;
  bool leave_before = false;  ///< the players leave before the first kill
  bool in_last_tick = false;  ///< one more is welcomed just before each kill, and not yet in the world
  std::vector<bool> late;     ///< per kill: the next server starts later than the grace time
  bool come_back = false;
  bool leave_after = false;  ///< the returned players leave again
  int wait = 0;              ///< ticks until the newcomers come
  int places = 16;
};

std::ostream& operator<<(std::ostream& out, const ResumeWay& way) {
  return out << way.p_name;
}

class ResumedRound : public testing::TestWithParam<ResumeWay> {
 protected:
  /// Returns the ids of all players in the world, and expects each to have a session of this id.
  static std::set<std::uint32_t> idsOf(const ResumingServer& server) {
    std::set<std::uint32_t> ids;
    for (const df::PlayerFacts& player : server.world.picture().view().players) {
      EXPECT_NE(server.rooms.findPlayer(player.id), nullptr) << player.id << " is a ghost";
      ids.insert(player.id);
    }
    return ids;
  }
  static bool seesGame(const Client& client) {
    for (const wire::ServerMessage& message : client.sent) {
      if (message.has_snapshot()) return true;
    }
    return false;
  }
};

TEST_P(ResumedRound, NewcomersSeeItAndAreUnique) {
  const ResumeWay& way = GetParam();
  auto server = std::make_unique<ResumingServer>("", false, 16, SessionTable::Clock::now());
  std::vector<std::pair<std::string, std::string>> tokens;
  for (const char* p_name : {"Ann", "Bob", "Cid"}) {
    const Client& client = server->greet(p_name);
    ASSERT_TRUE(client.isWelcome());
    tokens.emplace_back(p_name, client.welcome().resume_token());
  }
  server->play(40);
  for (Client& client : server->clients) {
    if (way.leave_before) ResumingServer::leave(client);
  }
  server->play(5);
  for (const bool is_late : way.late) {
    if (way.in_last_tick) server->greet("Dan");
    const std::string records = server->records();
    const auto now = server->now;
    server.reset();
    server = std::make_unique<ResumingServer>(records, is_late, way.places, now);
    ASSERT_FALSE(server->rooms.recovering());
  }
  std::vector<Client*> players;
  for (const auto& [name, token] : tokens) {
    if (!way.come_back) continue;
    players.push_back(&server->greet(name, token));
    ASSERT_TRUE(players.back()->isWelcome()) << name;
    EXPECT_EQ(players.back()->welcome().name(), name);
  }
  server->play(2);
  if (way.leave_after) {
    for (Client* p_client : std::exchange(players, {})) ResumingServer::leave(*p_client);
  }
  if (way.places == 3) {
    EXPECT_EQ(server->greet("Eve").refusal(), wire::Refused::FULL);
    ResumingServer::leave(*players.back());
    players.pop_back();
  }
  server->play(way.wait);
  for (const char* p_name : {"Ann", "Fay", "Gus"}) {
    if (players.size() == 3 && way.places == 3) break;
    players.push_back(&server->greet(p_name));
    ASSERT_TRUE(players.back()->isWelcome()) << p_name;
  }
  server->play(30);
  std::set<std::uint32_t> ids;
  std::set<std::uint32_t> colors;
  std::set<std::string> names;
  for (const Client* p_client : players) {
    const wire::Welcome& welcome = p_client->welcome();
    EXPECT_TRUE(seesGame(*p_client)) << welcome.name() << ", player " << welcome.player();
    EXPECT_TRUE(ids.insert(welcome.player()).second) << welcome.player();
    EXPECT_TRUE(colors.insert(welcome.color()).second) << welcome.color();
    EXPECT_TRUE(names.insert(welcome.name()).second) << welcome.name();
  }
  const std::set<std::uint32_t> in_world = idsOf(*server);
  for (const std::uint32_t id : ids) EXPECT_TRUE(in_world.contains(id)) << id;
}

INSTANTIATE_TEST_SUITE_P(
    Ways, ResumedRound,
    testing::Values(
        ResumeWay{.p_name = "BesideThoseWhoReturned", .late = {false}, .come_back = true},
        ResumeWay{.p_name = "BeforeTheOthersReturn", .late = {false}},
        ResumeWay{.p_name = "AfterAllLeft", .late = {false}, .come_back = true, .leave_after = true},
        ResumeWay{.p_name = "AfterTheGraceTime", .late = {false}, .wait = 60},
        ResumeWay{.p_name = "Later", .late = {true}},
        ResumeWay{.p_name = "LaterAndKilledAgain", .late = {true, false}},
        ResumeWay{.p_name = "LaterEachTime", .late = {true, true, true}},
        ResumeWay{.p_name = "KilledTwice", .late = {false, false}, .come_back = true},
        ResumeWay{.p_name = "WithoutPlayers", .leave_before = true, .late = {false, true}},
        ResumeWay{
            .p_name = "WelcomedInTheLastTick", .in_last_tick = true, .late = {false}, .come_back = true},
        ResumeWay{.p_name = "WelcomedInTheLastTickAndLater", .in_last_tick = true, .late = {true, false}},
        ResumeWay{.p_name = "FullServer", .late = {false}, .come_back = true, .places = 3}),
    [](const auto& one) { return std::string(one.param.p_name); });

}  // namespace
}  // namespace naiad
