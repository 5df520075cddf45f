// A game as a real process, and clients in it.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "GameProgram.h"
#include "LoopbackFixture.h"

namespace naiad::test {

class ProgramFixture : public LoopbackFixture {
 protected:
  /// Ends the program that runs, and starts one. The parameters are those of GameProgram.
  void launch(const std::string& name, std::map<std::string, std::string> environment = {},
              const std::vector<std::string>& arguments = {}, int errors = -1) {
    game.reset();
    game = std::make_unique<GameProgram>(name, std::move(environment), arguments, errors);
    ASSERT_NE(game->port(), 0) << game->log();
  }
  /// Begins to join. The client must outlive all calls of serve().
  std::unique_ptr<TestClient> connect(const ClientSetup& setup) {
    auto client = std::make_unique<TestClient>(context, game->port(), setup);
    clients.push_back(client.get());
    return client;
  }
  std::unique_ptr<TestClient> join(const ClientSetup& setup) {
    auto client = connect(setup);
    EXPECT_TRUE(serve([&] { return client->joined() && isPlaying(*client); }))
        << client->connection().message() << game->log();
    return client;
  }
  std::unique_ptr<TestClient> join(const std::string& name) { return join(home.player(name)); }
  /// True if the client, which has joined, shows the game.
  virtual bool isPlaying(TestClient& /*client*/) const { return true; }
  bool serve(const std::function<bool()>& done) { return serveUntil(context, clients, done); }
  /// Returns true once the program's log contains this text, false after the time limit of serveUntil().
  bool waitForLog(const std::string& part) {
    return serve([&] { return game->log().find(part) != std::string::npos; });
  }
  /// Returns true once the client has seen `count` more ticks, false after the time limit of serveUntil().
  bool waitForTicks(TestClient& client, std::uint32_t count = 100) {
    const std::uint32_t from = client.newestTick();
    return serve([&] { return client.newestTick() > from + count; });
  }
  bool isDismissed(TestClient& client, const std::string& message) {
    return serve([&] { return client.connection().state() == Connection::State::kEnded; }) &&
           client.connection().message() == message;
  }
  /// True if this line is in the client's chat.
  static bool heard(TestClient& client, const std::string& line) {
    return std::ranges::any_of(client.session().chat(),
                               [&](const ChatEntry& entry) { return entry.text == line; });
  }
  static std::string row(TestClient& client, int y = 12) {
    return client.session().replica().render(client.newestTick()).rowText(y);
  }

  std::unique_ptr<GameProgram> game;
  std::vector<TestClient*> clients;
};

}  // namespace naiad::test
