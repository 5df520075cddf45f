// All ways in which players leave: what the log says, and which players the next server would restore if this
// one was killed now.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "host/journal/UnfinishedRound.h"
#include "host/loop/HostClients.h"
#include "host/loop/HostControls.h"
#include "host/loop/HostEndpoint.h"
#include "host/ops/HostAdmin.h"
#include "tests/server/host/rooms/HostRooms.h"
#include "tests/support/TempFolder.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;
using test::Client;

/// A host with two rooms, whose rounds are recorded, and without a network.
class Building {
 public:
  explicit Building(const std::function<void(HostOptions&)>& change)
      : context(optionsOf(change), "hall", [this](const LogEvent& event) { log.push_back(event); }),
        endpoint(context, [](std::unique_ptr<ReliableChannel>) {}),
        clients(context, endpoint, [] {}) {
    clients.setRooms({plan("hall"), plan("attic")});
    clients.rooms().open(world);
  }

  Client& join(const std::string& name) {
    Client& client = ends.emplace_back();
    clients.add(std::make_unique<test::FakeChannel>(client));
    wire::Hello hello = test::helloOf(name);
    hello.set_rooms(true);
    client.greet(hello);
    EXPECT_TRUE(client.isWelcome()) << name;
    return client;
  }
  void update() {
    now = std::max(now, HostClients::Clock::now());
    clients.update(now);
  }
  /// Calls update() every 100 ms of this time, which does not really pass.
  void pass(std::chrono::milliseconds time, const std::function<void()>& each = {}) {
    for (const auto end = now + time; now <= end; now += 100ms) {
      if (each) each();
      update();
    }
  }
  /// Returns the players that would be restored in a room if the server was killed now.
  std::set<std::string> restored(const std::string& room) {
    EXPECT_TRUE(writer->drain(60s));
    std::set<std::string> names;
    const UnfinishedRound round((folder / (room + ".dfr")).string());
    for (const auto& [player, session] : round.sessions()) names.insert(session.name);
    return names;
  }
  void kick(const Client& client, const std::string& sentence) {
    client.ping();
    admin.kickPlayer(clients.rooms().findPlayer(client.welcome().player())->id(), sentence);
  }

  const test::TempFolder folder;
  std::shared_ptr<JournalWriter> writer = std::make_shared<JournalWriter>();
  std::vector<LogEvent> log;
  std::map<std::string, test::FakeWorld*> worlds;
  std::deque<Client> ends;
  df::World world;
  const df::World::Scope scope{world};
  HostContext context;
  HostEndpoint endpoint;
  HostClients clients;
  HostControls controls{context, endpoint, clients};
  HostScores scores{{context, endpoint, clients, controls}};
  HostAdmin admin{{context, endpoint, clients, controls}, scores};
  HostClients::Clock::time_point now = HostClients::Clock::now();

 private:
  static HostOptions optionsOf(const std::function<void(HostOptions&)>& change) {
    HostOptions options;
    options.insecure = true;
    options.address = "127.0.0.1";
    options.port = 0;
    options.grace = 5;
    if (change) change(options);
    return options;
  }
  RoomConfig plan(const std::string& name) {
    return {.name = name, .game = name, .max_players = 8, .ready = {}, .new_world = [this, name](auto&) {
              Round::JournalBinding book;
              book.writer = writer;
              book.journal = std::make_shared<Journal>(
                  std::make_unique<JournalFileSink>((folder / (name + ".dfr")).string()), DfrHeader(),
                  DfrFacts(), 1 << 20, false);
              writer->add(book.journal);
              auto port = std::make_unique<test::FakeWorld>();
              worlds[name] = port.get();
              return std::make_unique<Round>(std::move(port), std::move(book));
            }};
  }
};

struct Way {
  std::string name;
  std::function<void(Building&, Client&)> leave;
  std::string reason;  ///< words of the log; empty: the player leaves only the room
  std::function<void(HostOptions&)> options = {};
};

void PrintTo(const Way& way, std::ostream* p_out) {
  *p_out << way.name;
}

const Way kWays[] = {
    {"quit", [](Building&, Client& eve) { eve.leave(); }, "quit"},
    {"kick",
     [](Building& house, Client& eve) { house.kick(eve, "You were removed from the game: \"spam\""); },
     R"(dismissed with "You were removed from the game: \"spam\"")"},
    {"ban", [](Building& house, Client& eve) { house.kick(eve, "You are banned from this server."); },
     R"(dismissed with "You are banned from this server.")"},
    {"inactive",
     [](Building& house, Client& eve) {
       house.ends.front().drop();  // a player without a connection does not count as inactive
       for (const auto end = house.now + 30s; !eve.closed && house.now < end;) house.update();
     },
     R"(dismissed with "Disconnected: no input for 1s.")", [](HostOptions& o) { o.inactive_kick = 1; }},
    {"game_over",
     [](Building& house, Client& eve) {
       eve.ping();
       house.worlds["hall"]->next.leavers = {eve.welcome().player()};
       house.clients.rooms().beginTicks();
     },
     R"(dismissed with "The game is over for you.")"},
    {"invalid_message",
     [](Building&, Client& eve) {
       eve.ping();
       eve.callbacks.on_frame("\xff\xff");
     },
     "invalid message"},
    {"invalid_frame", [](Building&, Client& eve) { eve.callbacks.on_closed(CloseReason::kProtocol); },
     "invalid message"},
    {"message_flood",
     [](Building&, Client& eve) {
       for (int i = 0; i < 1100; ++i) eve.ping();
     },
     "too many messages at once"},
    {"key_flood",
     [](Building&, Client& eve) {
       for (std::uint32_t i = 1; i <= 65; ++i) eve.key(i, 1);
     },
     "too many keys at once"},
    {"no_reconnect",
     [](Building& house, Client& eve) {
       eve.ping();
       eve.drop();
       house.pass(8s);
     },
     "did not reconnect in time"},
    {"disconnected",
     [](Building&, Client& eve) {
       eve.ping();
       eve.drop();
     },
     "connection lost", [](HostOptions& o) { o.grace = 0; }},
    {"silent", [](Building& house, Client&) { house.pass(17s, [&] { house.ends.front().ping(); }); },
     "silent for too long", [](HostOptions& o) { o.grace = 0; }},
    {"slow_connection",
     [](Building& house, Client& eve) {
       eve.unsent = 100'000;
       house.pass(12s, [&] {
         eve.ping();
         house.ends.front().ping();
       });
     },
     "connection too slow"},
    {"overflow", [](Building&, Client& eve) { eve.callbacks.on_closed(CloseReason::kOverflow); },
     "too many bytes queued"},
    {"room_change",
     [](Building& house, Client& eve) {
       eve.enter("attic");
       house.update();
     },
     ""},
};

class Leaving : public testing::TestWithParam<Way> {};

TEST_P(Leaving, FormerPlayersAreLoggedAndNotRestored) {
  const Way& way = GetParam();
  Building house{way.options};
  house.join("Ann");
  Client& eve = house.join("Eve");
  EXPECT_EQ(house.restored("hall"), (std::set<std::string>{"Ann", "Eve"}));
  way.leave(house, eve);
  house.update();  // the connection may still be open
  EXPECT_EQ(house.restored("hall"), std::set<std::string>{"Ann"});

  std::vector<LogEvent> found;
  std::ranges::copy_if(house.log, std::back_inserter(found), [&eve](const LogEvent& event) {
    return event.name == std::string("left") && event.text.starts_with(eve.address + " \"Eve\"");
  });
  ASSERT_EQ(found.size(), way.reason.empty() ? 0u : 1u);
  for (const LogEvent& event : found) {
    EXPECT_EQ(event.text, eve.address + " \"Eve\" left: " + way.reason);
    const std::pair<std::string, std::string> reason{"reason", way.reason};
    EXPECT_EQ(std::count(event.fields.begin(), event.fields.end(), reason), 1);
  }

  house.clients.rooms().beginTicks();
  house.update();
  EXPECT_EQ(house.restored("hall"), std::set<std::string>{"Ann"});
  if (way.reason.empty()) {
    EXPECT_EQ(house.restored("attic"), std::set<std::string>{"Eve"});
  }
}

INSTANTIATE_TEST_SUITE_P(Ways, Leaving, testing::ValuesIn(kWays),
                         [](const auto& way) { return way.param.name; });

}  // namespace
}  // namespace naiad
