// The lobby's answers to hellos and to other frames.
#include <gtest/gtest.h>

#include <string>

#include "SamplePresence.h"
#include "naiad.pb.h"
#include "server/directory/Lobby.h"
#include "shared/net/base/Limits.h"
#include "shared/values/SplitMix64.h"

namespace naiad {
namespace {

Presence lobbyServer(const std::string& id) {
  return test::presenceOf(id, 0, 2);
}

wire::ClientMessage hello(const std::string& game = "", std::uint32_t protocol = 4) {
  wire::ClientMessage message;
  message.mutable_hello()->set_magic(kHelloMagic);
  message.mutable_hello()->set_protocol(protocol);
  message.mutable_hello()->set_player_name("ann");
  message.mutable_hello()->set_game(game);
  return message;
}

wire::Refused answerTo(const wire::ClientMessage& message, FleetRegistry& servers) {
  const auto answer = replyToHello(message.SerializeAsString(), servers);
  wire::ServerMessage said;
  EXPECT_TRUE(answer && said.ParseFromString(answer->frame));
  return said.refused();
}

TEST(LobbyReplyTest, RedirectNamesTheRoomSeparatelyAndInTheMessage) {
  FleetRegistry servers;
  Presence server = lobbyServer("a");
  server.rooms = {{"hall", "lobby", 0, 2}, {"duel", "tron", 0, 2}};
  test::handleHeartbeat(servers, server);
  const wire::Refused refused = answerTo(hello("tron"), servers);
  EXPECT_EQ(refused.reason(), wire::Refused::REDIRECT);
  EXPECT_EQ(refused.redirect(), linkOf(server)) << "as clients know it that know no rooms";
  EXPECT_EQ(refused.redirect_room(), "duel");
  EXPECT_NE(refused.message().find(linkOf(server, "duel")), std::string::npos) << refused.message();
  wire::ClientMessage wish = hello();
  wish.mutable_hello()->set_room("duel");
  EXPECT_EQ(answerTo(wish, servers).redirect_room(), "duel");
  wish.mutable_hello()->set_room("cellar");
  EXPECT_EQ(answerTo(wish, servers).reason(), wire::Refused::GAME);
  EXPECT_NE(answerTo(wish, servers).message().find("cellar"), std::string::npos);
}

TEST(LobbyReplyTest, PlayersGetABusyReplyWhenServersAreFull) {
  FleetRegistry servers;
  test::handleHeartbeat(servers, lobbyServer("a"));
  answerTo(hello(), servers);
  answerTo(hello(), servers);
  const wire::Refused refused = answerTo(hello(), servers);
  EXPECT_EQ(refused.reason(), wire::Refused::BUSY);
  EXPECT_EQ(refused.redirect(), "");
}

TEST(LobbyReplyTest, UnknownGameOrProtocolIsRefusedWithTheReason) {
  FleetRegistry servers;
  test::handleHeartbeat(servers, lobbyServer("a"));
  EXPECT_EQ(answerTo(hello("maze"), servers).reason(), wire::Refused::GAME);
  EXPECT_NE(answerTo(hello("maze"), servers).message().find("maze"), std::string::npos);
  EXPECT_EQ(answerTo(hello("", 5), servers).reason(), wire::Refused::GAME);
  EXPECT_EQ(answerTo(hello("\033[2J"), servers).message().find('\033'), std::string::npos);
  Presence newer = lobbyServer("b");
  newer.protocol = 5;
  test::handleHeartbeat(servers, newer);
  EXPECT_EQ(answerTo(hello("", 5), servers).reason(), wire::Refused::REDIRECT)
      << "it knows each version's servers";
}

TEST(LobbyReplyTest, InvalidHelloGetsNoReplyAndReservesNoSlot) {
  FleetRegistry servers;
  test::handleHeartbeat(servers, lobbyServer("a"));
  wire::ClientMessage other = hello();
  other.mutable_hello()->set_magic(7);
  EXPECT_FALSE(replyToHello(other.SerializeAsString(), servers));
  other.mutable_leave();
  EXPECT_FALSE(replyToHello(other.SerializeAsString(), servers));
  EXPECT_FALSE(replyToHello("", servers));
  SplitMix64 random(5);
  for (int i = 0; i < 2'000; ++i) {
    std::string bytes(random.next() % 200, '\0');
    for (char& c : bytes) c = static_cast<char>(random.next());
    EXPECT_FALSE(replyToHello(bytes, servers));
  }
  EXPECT_EQ(answerTo(hello(), servers).reason(), wire::Refused::REDIRECT);
  EXPECT_EQ(answerTo(hello(), servers).reason(), wire::Refused::REDIRECT) << "both places are free";
}

}  // namespace
}  // namespace naiad
