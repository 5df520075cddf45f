// Servers that disconnect a client in its handshake, as with too many connections from one address.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "LoopbackFixture.h"
#include "host/auth/ServerIdentity.h"
#include "shared/net/stream/TcpListener.h"

namespace naiad::test {
namespace {

class HungUp : public LoopbackFixture {
 protected:
  /// Joins a server that accepts handshakes from the `first`-th on, drops earlier ones, and never sends
  /// anything.
  TestClient& joinWhereAnswered(int first) {
    TlsListenerOptions tls;
    tls.context =
        ServerIdentity::loadOrMake(home.identity("identity"), std::chrono::system_clock::now()).tls();
    tls.try_handshake = [this, first](const AddressPrefix&) { return ++asked >= first; };
    listener = std::make_unique<TcpListener>(
        context, "127.0.0.1", 0, [this](auto channel) { accepted.push_back(std::move(channel)); },
        TcpOptions(), tls);
    client = std::make_unique<TestClient>(context, listener->port(), home.player("ann"));
    return *client;
  }

  std::unique_ptr<TcpListener> listener;
  std::vector<std::unique_ptr<ReliableChannel>> accepted;
  std::unique_ptr<TestClient> client;
  int asked = 0;
};

TEST_F(HungUp, ANewcomerTriesAgain) {
  TestClient& ann = joinWhereAnswered(3);
  EXPECT_TRUE(serveUntil(context, {&ann}, [&] { return !accepted.empty(); })) << ann.connection().message();
  EXPECT_EQ(asked, 3);
  EXPECT_EQ(ann.connection().state(), Connection::State::kJoining);
}

TEST_F(HungUp, UnansweredClientGivesUpAfterAFewRetries) {
  TestClient& ann = joinWhereAnswered(1'000'000);
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return ann.connection().isOver(); }));
  EXPECT_EQ(ann.connection().state(), Connection::State::kUnreachable);
  EXPECT_TRUE(has(ann.connection().message(),
                  " closed the connection: your address may be banned there, or no Naiad server"));
  EXPECT_GT(asked, 1);
  EXPECT_LE(asked, 6);
}

}  // namespace
}  // namespace naiad::test
