// The lobby that ships: a player walks into one of its doors, and is in the room behind it. Real processes
// and sockets, keys as they are pressed.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "RoomsFixture.h"

namespace naiad::test {
namespace {

constexpr int kDoorColumn = 10;  ///< of the first door, in its middle
constexpr int kDoorRow = 6;
constexpr int kFirstRow = 2;  ///< where players appear
constexpr int kRows = 24;
constexpr std::chrono::milliseconds kMostToMove{300};

class LobbyDoors : public RoomsFixture {
 protected:
  using Place = std::pair<int, int>;

  static std::string named(TestClient& client) { return client.session().welcome().room; }
  /// Of a player who stands in these rows; nothing if none does.
  static std::optional<Place> walker(TestClient& client, int first, int last) {
    const df::Canvas picture = client.session().replica().render(client.newestTick());
    for (int y = first; y <= last; ++y) {
      const std::size_t x = picture.rowText(y).find('@');
      if (x != std::string::npos) return Place(static_cast<int>(x), y);
    }
    return std::nullopt;
  }
  /// The player is in that room, and sees it: themselves, and the sign of the door back.
  static bool isIn(TestClient& client, const std::string& room, const std::string& other) {
    return client.joined() && named(client) == room && walker(client, kFirstRow, kFirstRow) &&
           row(client, kDoorRow - 2).find(other) != std::string::npos;
  }
  /// One step, of which the lobby takes one every second tick.
  void step(TestClient& client, df::Keyboard::Key key) {
    const auto before = walker(client, kFirstRow, kRows - 1);
    ASSERT_TRUE(before);
    press(client, key);
    ASSERT_TRUE(serve([&] { return walker(client, kFirstRow, kRows - 1) != before; }));
    const std::uint32_t moved = client.newestTick();
    ASSERT_TRUE(serve([&] { return client.newestTick() >= moved + 4; }));
  }
  /// To where the next step leads into the door.
  void walkToDoor(TestClient& client) {
    while (!HasFatalFailure() && walker(client, kFirstRow, kDoorRow - 1)->first > kDoorColumn)
      step(client, df::Keyboard::LEFTARROW);
    while (!HasFatalFailure() && walker(client, kFirstRow, kDoorRow - 1)->second < kDoorRow - 1)
      step(client, df::Keyboard::DOWNARROW);
  }
  /// From the step into the door until the other room is on the screen.
  std::optional<std::chrono::milliseconds> enterDoor(TestClient& client, const std::string& to,
                                                     const std::string& from) {
    press(client, df::Keyboard::DOWNARROW);
    const auto took = timeUntil(context, clients, [&] { return isIn(client, to, from); });
    if (!took) return std::nullopt;
    return std::chrono::duration_cast<std::chrono::milliseconds>(*took);
  }
};

TEST_F(LobbyDoors, APlayerWalksThroughADoorAndBack) {
  start({"hall=lobby", "yard=lobby"});
  auto bob = connect("bob", "yard");
  ASSERT_TRUE(serve([&] { return bob->joined() && walker(*bob, kFirstRow, kFirstRow); })) << server->log();
  while (!HasFatalFailure() && walker(*bob, kFirstRow, kRows - 1)->second <= kDoorRow + 1)
    step(*bob, df::Keyboard::DOWNARROW);  // out of where others appear
  auto ann = connect("ann", "hall");
  ASSERT_TRUE(serve([&] { return isIn(*ann, "hall", "yard"); })) << server->log();
  const ClientSession* const p_session = &ann->session();
  for (const auto& [to, from] : {std::pair("yard", "hall"), std::pair("hall", "yard")}) {
    walkToDoor(*ann);
    ASSERT_FALSE(HasFatalFailure()) << to;
    const auto took = enterDoor(*ann, to, from);
    ASSERT_TRUE(took) << to << server->log();
    RecordProperty(std::string("ms_to_") + to, static_cast<int>(took->count()));
    EXPECT_LE(*took, kMostToMove) << to;
  }
  EXPECT_EQ(&ann->session(), p_session) << "without reconnecting";
  EXPECT_EQ(ann->session().counters().bad_messages, 0u);
  EXPECT_EQ(named(*bob), "yard");
}

}  // namespace
}  // namespace naiad::test
