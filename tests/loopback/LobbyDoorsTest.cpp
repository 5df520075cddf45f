// The shipped lobby: a player walks into one of its doors and is then in the room behind it. Real processes
// and sockets, with keys as if pressed.
#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include "LobbyFixture.h"
#include "tests/support/Sanitizers.h"

namespace naiad::test {
namespace {

constexpr std::chrono::milliseconds kMaxMoveTime{300};

class LobbyDoors : public LobbyFixture {
 protected:
  static std::string named(TestClient& client) { return client.session().welcome().room; }
  /// True if the client is in `room` and shows the player and the sign of the door to `other`.
  static bool isIn(TestClient& client, const std::string& room, const std::string& other) {
    return client.joined() && named(client) == room && walker(client, kFirstRow, kFirstRow) &&
           row(client, kDoorRow - 2).find(other) != std::string::npos;
  }
  /// Steps into the door to room `to`. Returns the time until that room is on the screen.
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
    step(*bob, df::Keyboard::DOWNARROW);  // moves bob away from the row where players appear
  auto ann = connect("ann", "hall");
  ASSERT_TRUE(serve([&] { return isIn(*ann, "hall", "yard"); })) << server->log();
  const ClientSession* const p_session = &ann->session();
  for (const auto& [to, from] : {std::pair("yard", "hall"), std::pair("hall", "yard")}) {
    walkToDoor(*ann);
    ASSERT_FALSE(HasFatalFailure()) << to;
    const auto took = enterDoor(*ann, to, from);
    ASSERT_TRUE(took) << to << server->log();
    RecordProperty(std::string("ms_to_") + to, static_cast<int>(took->count()));
    EXPECT_LE(*took, kSlowness * kMaxMoveTime) << to;
  }
  EXPECT_EQ(&ann->session(), p_session) << "without reconnecting";
  EXPECT_EQ(ann->session().counters().bad_messages, 0u);
  EXPECT_EQ(named(*bob), "yard");
}

}  // namespace
}  // namespace naiad::test
