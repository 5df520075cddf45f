// A server with rooms, as a real process, and clients in them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "ProgramFixture.h"

namespace naiad::test {

/// The module of rooms/game.cpp.
inline constexpr const char* kRoomModule = NAIAD_BINARY_DIR "/../lib/room_module.so";

/// Values that this game draws.
struct Shown {
  int process = 0;  ///< 0: not drawn yet
  int keys = 0;
  int ticks = 0;
};

class RoomsFixture : public ProgramFixture {
 protected:
  /// Starts a server with rooms given as NAME[=GAME][,SETTINGS]. A room without a game plays rooms/game.cpp.
  void start(const std::vector<std::string>& rooms, std::vector<std::string> arguments = {},
             const std::map<std::string, std::string>& environment = {}) {
    for (const std::string& room : rooms) {
      const std::size_t comma = std::min(room.find(','), room.size());
      const bool has_game = room.find('=') < comma;
      arguments.push_back("--room=" +
                          (has_game ? room : room.substr(0, comma) + "=" + kRoomModule + room.substr(comma)));
    }
    launch("dfserver", environment, arguments);
  }
  std::unique_ptr<TestClient> connect(const std::string& name, const std::string& room) {
    ClientSetup setup = home.player(name);
    setup.options.room = room;
    auto client = ProgramFixture::connect(setup);
    client->keepPictures(false);
    return client;
  }
  /// Joins a room that plays rooms/game.cpp.
  std::unique_ptr<TestClient> join(const std::string& name, const std::string& room) {
    auto client = connect(name, room);
    EXPECT_TRUE(serve([&] { return client->joined() && shown(*client).process > 0; })) << game->log();
    return client;
  }
  static Shown shown(TestClient& client) {
    const std::string text = row(client);
    const auto process = numberAfter(text, "process=");
    const auto keys = numberAfter(text, "keys=");
    const auto ticks = numberAfter(text, "ticks=");
    if (!process || !keys || !ticks || text.find(';') == std::string::npos) return {};
    return {*process, *keys, *ticks};
  }
  /// Presses a key this many times and waits for each to arrive.
  void type(TestClient& client, int count) {
    for (int keys = shown(client).keys; count > 0; --count) {
      press(client, df::Keyboard::X);
      ++keys;
      ASSERT_TRUE(serve([&] { return shown(client).keys == keys; }));
    }
  }
  const RoomLine* roomInList(TestClient& client, const std::string& name) {
    client.session().refreshRooms(std::chrono::steady_clock::now());
    const auto& rooms = client.session().rooms();
    const auto found = std::ranges::find_if(rooms, [&](const RoomLine& room) { return room.name == name; });
    return found != rooms.end() ? &*found : nullptr;
  }
};

}  // namespace naiad::test
