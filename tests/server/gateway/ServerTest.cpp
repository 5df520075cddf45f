// Browsers that play on a real dfserver through the gateway.
#include <gtest/gtest.h>

#include "GatewayRun.h"
#include "WebClient.h"
#include "shared/net/stream/Fingerprint.h"
#include "tests/loopback/BusyWorld.h"
#include "tests/loopback/TestServer.h"

namespace naiad::test {
namespace {

class GatewayServer : public testing::Test {
 protected:
  HostOptions optionsOf() const {
    HostOptions options = fastOptions();
    options.insecure = false;
    options.identity = home.path("identity");
    options.visitors = home.path("visitors");
    options.grace = 60;
    return options;
  }

  GatewayHome home;
  TestServer server{[](df::World& world) { populateBusyWorld(world, 5); }, optionsOf()};
  GatewayRun gateway{home.settings(ShortKey::of(*server.fingerprint()))};
};

TEST_F(GatewayServer, BrowsersPlayAndSeeTheWorld) {
  WebClient ann(gateway.port());
  WebClient bob(gateway.port());
  ASSERT_TRUE(ann.join("ann"));
  ASSERT_TRUE(bob.join("bob"));
  wire::ClientMessage chat;
  chat.mutable_chat()->set_text("hello from a browser");
  chat.set_number(1);
  ann.sendMessage(chat);
  bool heard = false;
  bool seen = false;
  while (!heard || !seen) {
    const auto message = bob.message();
    ASSERT_TRUE(message);
    heard = heard || (message->has_chat() && message->chat().text() == "hello from a browser");
    seen = seen || message->has_snapshot();
  }
  server.stop("The test is over.");
  EXPECT_EQ(ann.waitForClose(), 1000) << "it said goodbye";
}

TEST_F(GatewayServer, ASecondWebSocketIsASecondStream) {
  WebClient first(gateway.port());
  ASSERT_TRUE(first.play());
  first.sendMessage(WebClient::hello("ann"));
  const auto welcome = first.message();
  ASSERT_TRUE(welcome && welcome->has_welcome());
  EXPECT_TRUE(welcome->welcome().second_stream());
  WebClient second(gateway.port());
  ASSERT_TRUE(second.play());
  auto hello = WebClient::hello("ann");
  hello.mutable_hello()->set_resume_token(welcome->welcome().resume_token());
  hello.mutable_hello()->set_second_stream(true);
  second.sendMessage(hello);
  const auto again = second.message();
  ASSERT_TRUE(again && again->has_welcome());
  EXPECT_EQ(again->welcome().player(), welcome->welcome().player());
  EXPECT_EQ(server.counters().joined, 1u);
  EXPECT_EQ(gateway.counters().played, 2u);
}

}  // namespace
}  // namespace naiad::test
