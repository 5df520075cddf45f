// dfserver without any journal option is killed, and its players lose nothing. Real processes.
#include <signal.h>

#include <map>
#include <memory>
#include <string>

#include "RoomsFixture.h"

namespace naiad::test {
namespace {

/// Two servers that share one state folder, like two servers of one user do by default.
class DefaultJournal : public RoomsFixture {
 protected:
  struct Server {
    std::string key;
    std::uint16_t port = 0;
    std::unique_ptr<GameProgram> program = nullptr;
    std::unique_ptr<TestClient> player = nullptr;
    const ClientSession* p_before = nullptr;  ///< the player's session when the server was killed
  };

  std::unique_ptr<GameProgram> startOne(const std::string& key, std::uint16_t port = 0) const {
    return std::make_unique<GameProgram>(
        "dfserver", std::map<std::string, std::string>{{"NAIAD_GAME", kRoomModule},
                                                       {"NAIAD_JOURNAL", ""},
                                                       {"NAIAD_PORT", std::to_string(port)},
                                                       {"NAIAD_IDENTITY", home.identity(key)},
                                                       {"NAIAD_STATE", state()},
                                                       {"NAIAD_WORLD_ENVIRONMENT", "ROOM_REPEATS"},
                                                       {"ROOM_REPEATS", "1"},
                                                       {"DRAGONFLY_CONFIG", home.identity("none")}});
  }
  void start(Server& one) const {
    one.program.reset();
    one.program = startOne(one.key, one.port);
    one.port = one.program->port();
    ASSERT_NE(one.port, 0) << one.program->log();
  }
  void join(Server& one) {
    one.player = std::make_unique<TestClient>(context, one.port, home.player(one.key));
    one.player->keepPictures(false);
    clients.push_back(one.player.get());
    ASSERT_TRUE(serve([&] { return one.player->joined() && shown(*one.player).process > 0; }))
        << one.program->log();
  }
  static void kill(Server& one) {
    one.program->signal(SIGKILL);
    one.program->wait();
    one.p_before = &one.player->session();
  }
  bool isBack(const Server& one) const {
    TestClient& client = *one.player;
    return client.joined() && &client.session() != one.p_before && client.newestTick() > 0 &&
           shown(client).process > 0;
  }
  std::string state() const { return home.identity("state"); }
};

// The servers are killed soon after the start, possibly before a file of the round exists.
TEST_F(DefaultJournal, TwoKilledServersOfOneUserRecover) {
  Server servers[2] = {{"ann"}, {"bob"}};
  for (Server& one : servers) {
    start(one);
    join(one);
  }
  type(*servers[0].player, 2);
  type(*servers[1].player, 3);
  const std::uint32_t ids[2] = {servers[0].player->player(), servers[1].player->player()};
  for (Server& one : servers) kill(one);
  for (Server& one : servers) start(one);
  ASSERT_TRUE(serve([&] { return isBack(servers[0]) && isBack(servers[1]); }))
      << servers[0].program->log() << servers[1].program->log();
  EXPECT_EQ(shown(*servers[0].player).keys, 2) << servers[0].program->log();
  EXPECT_EQ(shown(*servers[1].player).keys, 3) << servers[1].program->log();
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(servers[i].player->player(), ids[i]);
    EXPECT_TRUE(serve([&] { return has(servers[i].program->log(), "reconnected to the recovered round"); }));
  }
  clients.clear();
}

}  // namespace
}  // namespace naiad::test
