// Games written as two programs that use the published engine's NetworkManager. Only the server program is
// run, and the world's players are its connections.

#include "engine/managers/Config.h"
#include "engine/published/EventNetworks.h"
#include "engine/published/NetworkManager.h"
#include "engine/published/NetworkNode.h"
#include "tests/server/engine/Probe.h"
#include "tests/server/games/HostedGame.h"

int orchard_main(int argc, char* argv[]);

namespace df::test {
namespace {

class NetworkServerTest : public WorldTest {
 protected:
  /// Runs the game; `script` is the host's part while the game's main() is in GM.run().
  int play(const std::string& role, const std::string& host, const std::function<void()>& script) {
    naiad::TestRunner runner([&script](World&) { script(); });
    world.setRunner(&runner);
    std::string program = "orchard";
    std::string first = role;
    std::string second = host;
    char* words[] = {program.data(), first.data(), second.data(), nullptr};
    const int result = orchard_main(host.empty() ? 2 : 3, words);
    world.setRunner(nullptr);
    return result;
  }
  void point(std::uint32_t player, int x, int y) {
    world.input().mouse(player, MOVED, Mouse::UNDEFINED_MOUSE_BUTTON, x, y);
    world.tick();
  }
  /// Returns column and row of the first `ch` in the picture; (-1,-1) if not found.
  Vector shown(char ch) const {
    const Canvas canvas = world.picture().render({});
    for (int y = 0; y < canvas.height(); ++y) {
      for (int x = 0; x < canvas.width(); ++x) {
        if (canvas.at(x, y).ch == static_cast<char32_t>(ch)) return Vector(x, y);
      }
    }
    return Vector(-1, -1);
  }
};

TEST_F(NetworkServerTest, ServerHalfOfATwoProgramGameServesPlayers) {
  bool played = false;
  EXPECT_EQ(play("server", "",
                 [&] {
                   world.input().setGameOverLeaves(true);
                   const std::uint32_t ann = joined("ann", CYAN);
                   EXPECT_EQ(WM.objectsOfType("Hand").getCount(), 0) << "it waits for two";
                   const std::uint32_t bob = world.input().join("bob", RED);
                   ticks(2);
                   ASSERT_EQ(WM.objectsOfType("Hand").getCount(), 2);
                   point(ann, 11, 9);
                   point(bob, 50, 20);
                   EXPECT_EQ(shown('A'), Vector(11, 9));
                   EXPECT_EQ(shown('B'), Vector(50, 20));
                   point(bob, 50, 6);
                   EXPECT_EQ(WM.objectsOfType("Apple").getCount(), 6);
                   EXPECT_NE(world.picture().render({}).rowText(1).find("Player 1 10"), std::string::npos);
                   pressedBy({ann}, Keyboard::SPACE);
                   EXPECT_EQ(shown('A'), Vector(40, 12));
                   EXPECT_EQ(shown('B'), Vector(50, 6));
                   // handleClose() calls setGameOver(), but ann continues because bob has already left.
                   left(bob);
                   EXPECT_FALSE(GM.getGameOver());
                   const std::uint32_t cy = world.input().join("cy", RED);
                   ticks(2);
                   point(cy, 30, 15);
                   EXPECT_EQ(shown('B'), Vector(30, 15)) << "who comes later has the free socket";
                   played = true;
                 }),
            0);
  EXPECT_TRUE(played);
  EXPECT_EQ(logged("players that join are this server's connections"), 1);
  EXPECT_EQ(logged("the game's own messages are not sent"), 1);
  EXPECT_EQ(logged("is removed from the game"), 0);
}

TEST_F(NetworkServerTest, ClientHalfReportsItIsNotNeeded) {
  EXPECT_EQ(play("client", "example.org", [&] { EXPECT_TRUE(GM.getGameOver()); }), 0);
  EXPECT_EQ(logged("NetworkManager::connect: games need no sockets here"), 1);
}

TEST_F(NetworkServerTest, PlayersBeyondTheLimitWatch) {
  NM.setServer();
  NM.setMaxConnections(1);
  Probe probe("probe", &received);
  for (const auto& type :
       {NETWORK_EVENT, NETWORK_ACCEPT_EVENT, NETWORK_CLOSE_EVENT, NETWORK_KEYBOARD_EVENT, KEYBOARD_EVENT})
    probe.registerInterest(type);
  const std::uint32_t ann = world.input().join("ann", CYAN);
  const std::uint32_t bob = world.input().join("bob", RED);
  ticks(2);
  EXPECT_EQ(received, (std::vector<std::string>{"probe:df-network-accept", "probe:df-network"}));
  EXPECT_EQ(NM.getNumConnections(), 1);
  EXPECT_EQ(NM.getSocket(0), 0);
  EXPECT_EQ(NM.getSocket(1), -1);
  received.clear();
  pressedBy({ann, bob}, Keyboard::A);
  EXPECT_EQ(received, (std::vector<std::string>{"probe:df-keyboard-network", "probe:df-keyboard"}));
  received.clear();
  left(ann);
  EXPECT_EQ(received, (std::vector<std::string>{"probe:df-network-close", "probe:df-network"}));
  received.clear();
  world.tick();
  EXPECT_EQ(received, (std::vector<std::string>{"probe:df-network-accept", "probe:df-network"}))
      << "bob comes in";
  EXPECT_EQ(NM.close(0), 0);
  EXPECT_EQ(NM.close(0), -1);
  world.tick();
  EXPECT_FALSE(NM.isConnected()) << "whose connection was closed watches";
}

TEST_F(NetworkServerTest, KeyWithoutNetworkListenerIsSentAsLocalKey) {
  NM.setServer();
  Probe quitter("quitter", &received);
  quitter.registerInterest(KEYBOARD_EVENT);
  Probe hand("hand", &received);
  hand.registerInterest(NETWORK_MSE_EVENT);
  const std::uint32_t ann = world.input().join("ann", CYAN);
  ticks(2);
  world.input().key(ann, Keyboard::Q, KEY_PRESSED);
  world.input().mouse(ann, CLICKED, Mouse::LEFT, 3, 4);
  world.tick();
  EXPECT_EQ(received, (std::vector<std::string>{"quitter:df-keyboard", "hand:df-mouse-network"}));
}

TEST_F(NetworkServerTest, PlayingServerUsesTheFirstPlayerAsLocal) {
  Config::getInstance().loadConfig("server_plays:true,");
  NM.setServer();
  Probe hero("hero", &received);
  hero.registerInterest(KEYBOARD_EVENT);
  hero.registerInterest(NETWORK_KEYBOARD_EVENT);
  const std::uint32_t ann = world.input().join("ann", CYAN);
  const std::uint32_t bob = world.input().join("bob", RED);
  ticks(2);
  EXPECT_EQ(NM.getNumConnections(), 1);
  pressedBy({ann, bob}, Keyboard::A);
  EXPECT_EQ(received, (std::vector<std::string>{"hero:df-keyboard", "hero:df-keyboard-network"}));
}

TEST_F(NetworkServerTest, SpectatorsDoNotSteerTheServersPlayer) {
  Config::getInstance().loadConfig("server_plays:true,");
  NM.setServer();
  NM.setMaxConnections(1);
  Probe hero("hero", &received);
  hero.registerInterest(KEYBOARD_EVENT);
  hero.registerInterest(MSE_EVENT);
  const std::uint32_t ann = world.input().join("ann", CYAN);
  const std::uint32_t bob = world.input().join("bob", RED);
  const std::uint32_t cy = world.input().join("cy", GREEN);
  ticks(2);
  world.input().key(bob, Keyboard::A, KEY_PRESSED);
  world.input().key(cy, Keyboard::A, KEY_PRESSED);
  world.input().mouse(cy, CLICKED, Mouse::LEFT, 3, 4);
  world.tick();
  EXPECT_TRUE(received.empty());
  pressedBy({ann}, Keyboard::A);
  EXPECT_EQ(received, (std::vector<std::string>{"hero:df-keyboard"}));
}

TEST_F(NetworkServerTest, SynchronisedObjectCountsAsWritten) {
  NM.setServer();
  NetworkNode node;
  Probe apple("apple", nullptr, Vector(3, 4));
  EXPECT_EQ(node.sendMessage(SYNC_OBJECT, &apple), 0) << "no player is connected";
  EXPECT_TRUE(apple.isModified(POSITION));
  world.input().join("ann", CYAN);
  ticks(2);
  EXPECT_EQ(node.sendMessage(SYNC_OBJECT, &apple), 1);
  EXPECT_FALSE(apple.isModified(POSITION));
  apple.setPosition(Vector(5, 5));
  EXPECT_TRUE(apple.isModified(POSITION));
  EXPECT_EQ(node.sendMessage(SYNC_OBJECT, &apple, 0u, 7), -1) << "no such socket";
  NM.setServer(false);
  EXPECT_EQ(node.sendMessage(SYNC_OBJECT, &apple), -1);
  EXPECT_FALSE(NM.isConnected());
}

}  // namespace
}  // namespace df::test
