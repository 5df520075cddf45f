// Which players are let in, and which servers are trusted: passwords, pins, fingerprints.
#include <gtest/gtest.h>

#include "BusyWorld.h"
#include "Home.h"
#include "RecordingServer.h"
#include "StreamProxy.h"
#include "TestServer.h"
#include "host/auth/PasswordHash.h"
#include "shared/net/base/SafeFile.h"

namespace naiad::test {
namespace {

class TrustTest : public testing::Test {
 protected:
  static std::function<void(df::World&)> world() {
    return [](df::World& world) { populateBusyWorld(world, 5); };
  }
  bool joins(TestClient& client) {
    return serveUntil(context, {&client}, [&] { return client.joined(); });
  }
  /// The sentence that it ends with; empty if it was let in.
  std::string refusal(TestClient& client) {
    EXPECT_TRUE(
        serveUntil(context, {&client}, [&] { return client.joined() || client.connection().isOver(); }));
    if (client.joined()) return {};
    EXPECT_EQ(client.connection().state(), Connection::State::kRefused);
    return client.connection().sentence();
  }
  std::string refusal(std::uint16_t port, const ClientSetup& setup) {
    TestClient client(context, port, setup);
    return refusal(client);
  }
  /// A hash that is soon made, so that a busy machine does not make a guess late.
  static std::string quick(const std::string& password) {
    return PasswordHash::of(password, {.memory_kib = 64, .passes = 1}).text();
  }
  std::string pins() const { return readSmallFile(home.knownServers(), 10'000).value_or(""); }

  Home home;
  asio::io_context context;
};

TEST_F(TrustTest, RightWrongAndMissingPasswords) {
  HostOptions options = home.server();
  options.password = quick("xyzzy");
  TestServer server(world(), options);
  ClientSetup setup = home.player("ann");
  EXPECT_EQ(refusal(server.port(), setup), "This server wants a password.");
  setup.options.password = "plugh";
  EXPECT_EQ(refusal(server.port(), setup), "That is not this server's password.");
  EXPECT_EQ(server.counters().refused_password, 2u);
  EXPECT_EQ(server.counters().joined, 0u);
  setup.options.password = "xyzzy";
  EXPECT_EQ(refusal(server.port(), setup), "");
  EXPECT_EQ(server.counters().joined, 1u);
}

TEST_F(TrustTest, AnAddressThatGuessesTooOftenWaitsEvenWithTheRightPassword) {
  HostOptions options = home.server();
  options.password = quick("xyzzy");
  TestServer server(world(), options);
  ClientSetup setup = home.player("eve");
  for (int i = 0; i < 5; ++i) {
    setup.options.password = "guess " + std::to_string(i);
    EXPECT_EQ(refusal(server.port(), setup), "That is not this server's password.");
  }
  setup.options.password = "xyzzy";
  EXPECT_EQ(refusal(server.port(), setup), "Too many wrong passwords. Try again in a minute.");
  EXPECT_EQ(server.counters().refused_password, 6u);
  EXPECT_EQ(server.counters().joined, 0u);
}

TEST_F(TrustTest, TheFirstKeyIsPinnedAndTheSameOneIsWelcome) {
  TestServer server(world(), home.server());
  EXPECT_EQ(refusal(server.port(), home.player("ann")), "");
  const std::string pin =
      "127.0.0.1:" + std::to_string(server.port()) + " " + server.fingerprint()->text() + "\n";
  EXPECT_NE(pins().find(pin), std::string::npos) << pins();
  const std::string before = pins();
  EXPECT_EQ(refusal(server.port(), home.player("bob")), "");
  EXPECT_EQ(pins(), before);
}

TEST_F(TrustTest, AnotherKeyIsRefusedLoudly) {
  auto server = std::make_unique<TestServer>(world(), home.server());
  const std::uint16_t port = server->port();
  EXPECT_EQ(refusal(port, home.player("ann")), "");
  const std::string before = pins();
  server.reset();

  HostOptions other = home.server("another identity");
  other.port = port;
  server = std::make_unique<TestServer>(world(), other);
  const std::string sentence = refusal(port, home.player("ann"));
  EXPECT_NE(sentence.find("HAS CHANGED"), std::string::npos) << sentence;
  EXPECT_NE(sentence.find(server->fingerprint()->text()), std::string::npos) << sentence;
  EXPECT_EQ(pins(), before);
  // It has not even been greeted.
  EXPECT_EQ(server->counters().joined, 0u);

  // The host says that this is the key now.
  ClientSetup informed = home.player("ann");
  informed.trust.fingerprint = server->fingerprint();
  EXPECT_EQ(refusal(port, informed), "");
  EXPECT_EQ(refusal(port, home.player("ann")), "");
}

TEST_F(TrustTest, AGivenFingerprintCountsMost) {
  TestServer server(world(), home.server());
  ClientSetup setup = home.player("ann");
  setup.trust.fingerprint = Fingerprint::parse(std::string(64, 'a'));
  ASSERT_TRUE(setup.trust.fingerprint);
  const std::string sentence = refusal(server.port(), setup);
  EXPECT_NE(sentence.find("does not have the key that was given"), std::string::npos) << sentence;
  EXPECT_EQ(pins(), "");
  EXPECT_EQ(server.counters().joined, 0u);
  setup.trust.fingerprint = server.fingerprint();
  EXPECT_EQ(refusal(server.port(), setup), "");
}

TEST_F(TrustTest, ALinkJoinsAndTheWholeKeyIsPinned) {
  TestServer server(world(), home.server());
  ClientSetup setup = home.player("ann");
  setup.trust.link_key = ShortKey::of(*server.fingerprint());
  EXPECT_EQ(refusal(server.port(), setup), "");
  EXPECT_NE(pins().find(server.fingerprint()->text()), std::string::npos) << pins();
}

TEST_F(TrustTest, AServerWithoutTheKeyOfTheLinkIsToldNotAByte) {
  RecordingServer impostor(home.identity("another identity"));
  ClientSetup setup = home.player("ann");
  setup.options.password = "xyzzy";
  setup.trust.link_key = ShortKey::of(*Fingerprint::parse(std::string(64, 'a')));
  TestClient client(context, impostor.port(), setup);
  const std::string sentence = refusal(client);
  EXPECT_NE(sentence.find("does not have the key of the link"), std::string::npos) << sentence;
  ASSERT_TRUE(serveUntil(context, {&client}, [&] { return impostor.isDecided(1); }));
  EXPECT_EQ(impostor.heard(), "");
  EXPECT_EQ(pins(), "");
}

/// The password is the player's best secret, and the hello has it. With a pin from before, or with a key that
/// the host gave.
TEST_F(TrustTest, AServerWithAnotherKeyIsToldNotAByte) {
  RecordingServer impostor(home.identity("another identity"));
  ClientSetup setup = home.player("ann");
  setup.options.password = "xyzzy";
  {
    TestServer server(world(), home.server());
    StreamProxy proxy(context, server.port());
    TestClient ann(context, proxy.port(), setup);
    ASSERT_TRUE(joins(ann));
    proxy.setServer(impostor.port());
    proxy.cut();
    ann.connection().leave();
    TestClient again(context, proxy.port(), setup);
    EXPECT_NE(refusal(again).find("HAS CHANGED"), std::string::npos);
    ASSERT_TRUE(serveUntil(context, {&again}, [&] { return impostor.isDecided(1); }));
    EXPECT_EQ(impostor.heard(), "");
  }
  setup.trust.fingerprint = Fingerprint::parse(std::string(64, 'a'));
  TestClient informed(context, impostor.port(), setup);
  EXPECT_NE(refusal(informed), "");
  ASSERT_TRUE(serveUntil(context, {&informed}, [&] { return impostor.isDecided(2); }));
  EXPECT_EQ(impostor.heard(), "");

  // The recorder does hear what is said to it.
  setup.trust.fingerprint = impostor.fingerprint();
  auto trusting = std::make_unique<TestClient>(context, impostor.port(), setup);
  EXPECT_TRUE(serveUntil(context, {trusting.get()},
                         [&] { return impostor.heard().find("xyzzy") != std::string::npos; }));
}

TEST_F(TrustTest, AnImpostorInMidGameGetsNoToken) {
  TestServer server(world(), home.server());
  RecordingServer impostor(home.identity("another identity"));
  StreamProxy proxy(context, server.port());
  ClientSetup setup = home.player("ann");
  setup.options.password = "xyzzy";
  TestClient ann(context, proxy.port(), setup);
  ASSERT_TRUE(joins(ann));
  proxy.setServer(impostor.port());
  proxy.cut();
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return ann.connection().isOver(); }));
  EXPECT_EQ(ann.connection().state(), Connection::State::kRefused);
  EXPECT_NE(ann.connection().sentence().find("HAS CHANGED"), std::string::npos);
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return impostor.isDecided(1); }));
  EXPECT_EQ(impostor.heard(), "") << "neither token nor password";
}

}  // namespace
}  // namespace naiad::test
