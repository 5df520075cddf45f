// Passwords decide which players may join; pins and fingerprints decide which servers are trusted.
#include <gtest/gtest.h>

#include "LoopbackFixture.h"
#include "RecordingServer.h"
#include "StreamProxy.h"
#include "host/auth/PasswordHash.h"
#include "shared/net/base/SafeFile.h"

namespace naiad::test {
namespace {

class TrustTest : public LoopbackFixture {
 protected:
  std::string refusal(TestClient& client) {
    const std::string message = LoopbackFixture::refusal(client);
    EXPECT_TRUE(client.joined() || client.connection().state() == Connection::State::kRefused);
    return message;
  }
  std::string refusal(std::uint16_t port, const ClientSetup& setup) {
    TestClient client(context, port, setup);
    return refusal(client);
  }
  /// Returns a cheap hash, so that even on a busy machine password checks take little time.
  static std::string quick(const std::string& password) {
    return PasswordHash::of(password, {.memory_kib = 64, .passes = 1}).text();
  }
  std::string pins() const { return readSmallFile(home.knownServers(), 10'000).value_or(""); }
};

TEST_F(TrustTest, OnlyTheRightPasswordJoins) {
  HostOptions options = home.server();
  options.password = quick("xyzzy");
  TestServer server(busyWorld(5), options);
  ClientSetup setup = home.player("ann");
  EXPECT_EQ(refusal(server.port(), setup), "This server requires a password.");
  setup.options.password = "plugh";
  EXPECT_EQ(refusal(server.port(), setup), "That is not this server's password.");
  EXPECT_EQ(server.counters().refused_password, 2u);
  EXPECT_EQ(server.counters().joined, 0u);
  setup.options.password = "xyzzy";
  EXPECT_EQ(refusal(server.port(), setup), "");
  EXPECT_EQ(server.counters().joined, 1u);
}

TEST_F(TrustTest, RepeatedGuessesBlockEvenTheRightPassword) {
  HostOptions options = home.server();
  options.password = quick("xyzzy");
  TestServer server(busyWorld(5), options);
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

TEST_F(TrustTest, FirstKeyIsPinnedAndAcceptedAgain) {
  TestServer server(busyWorld(5), home.server());
  EXPECT_EQ(refusal(server.port(), home.player("ann")), "");
  const std::string pin =
      "127.0.0.1:" + std::to_string(server.port()) + " " + server.fingerprint()->text() + "\n";
  EXPECT_TRUE(has(pins(), pin));
  const std::string before = pins();
  EXPECT_EQ(refusal(server.port(), home.player("bob")), "");
  EXPECT_EQ(pins(), before);
}

TEST_F(TrustTest, ChangedKeyIsRefusedWithAWarning) {
  auto server = std::make_unique<TestServer>(busyWorld(5), home.server());
  const std::uint16_t port = server->port();
  EXPECT_EQ(refusal(port, home.player("ann")), "");
  const std::string before = pins();
  server.reset();

  HostOptions other = home.server("another identity");
  other.port = port;
  server = std::make_unique<TestServer>(busyWorld(5), other);
  const std::string message = refusal(port, home.player("ann"));
  EXPECT_TRUE(has(message, "HAS CHANGED"));
  EXPECT_TRUE(has(message, server->fingerprint()->text()));
  EXPECT_EQ(pins(), before);
  // The client did not join, because it had not sent a hello.
  EXPECT_EQ(server->counters().joined, 0u);

  // The host has told ann the new fingerprint, so she trusts it.
  ClientSetup informed = home.player("ann");
  informed.trust.fingerprint = server->fingerprint();
  EXPECT_EQ(refusal(port, informed), "");
  EXPECT_EQ(refusal(port, home.player("ann")), "");
}

TEST_F(TrustTest, GivenFingerprintMustMatch) {
  TestServer server(busyWorld(5), home.server());
  ClientSetup setup = home.player("ann");
  setup.trust.fingerprint = Fingerprint::parse(std::string(64, 'a'));
  ASSERT_TRUE(setup.trust.fingerprint);
  const std::string message = refusal(server.port(), setup);
  EXPECT_TRUE(has(message, "does not have the given key"));
  EXPECT_EQ(pins(), "");
  EXPECT_EQ(server.counters().joined, 0u);
  setup.trust.fingerprint = server.fingerprint();
  EXPECT_EQ(refusal(server.port(), setup), "");
}

TEST_F(TrustTest, ALinkJoinsAndTheWholeKeyIsPinned) {
  TestServer server(busyWorld(5), home.server());
  ClientSetup setup = home.player("ann");
  setup.trust.link_key = ShortKey::of(*server.fingerprint());
  EXPECT_EQ(refusal(server.port(), setup), "");
  EXPECT_TRUE(has(pins(), server.fingerprint()->text()));
}

TEST_F(TrustTest, ServerWithoutTheLinksKeyReceivesNoBytes) {
  RecordingServer impostor(home.identity("another identity"));
  ClientSetup setup = home.player("ann");
  setup.options.password = "xyzzy";
  setup.trust.link_key = ShortKey::of(*Fingerprint::parse(std::string(64, 'a')));
  TestClient client(context, impostor.port(), setup);
  const std::string message = refusal(client);
  EXPECT_TRUE(has(message, "does not have the key in the link"));
  ASSERT_TRUE(serveUntil(context, {&client}, [&] { return impostor.isDecided(1); }));
  EXPECT_EQ(impostor.heard(), "");
  EXPECT_EQ(pins(), "");
}

/// The password is a secret, and the hello contains it. Tested with a pin from an earlier session and with a
/// key given by the host.
TEST_F(TrustTest, ServerWithAnotherKeyReceivesNoBytes) {
  RecordingServer impostor(home.identity("another identity"));
  ClientSetup setup = home.player("ann");
  setup.options.password = "xyzzy";
  {
    TestServer server(busyWorld(5), home.server());
    StreamProxy proxy(context, server.port());
    TestClient ann(context, proxy.port(), setup);
    ASSERT_TRUE(joins(ann));
    proxy.setServer(impostor.port());
    proxy.cut();
    ann.connection().leave();
    TestClient again(context, proxy.port(), setup);
    EXPECT_TRUE(has(refusal(again), "HAS CHANGED"));
    ASSERT_TRUE(serveUntil(context, {&again}, [&] { return impostor.isDecided(1); }));
    EXPECT_EQ(impostor.heard(), "");
  }
  setup.trust.fingerprint = Fingerprint::parse(std::string(64, 'a'));
  TestClient informed(context, impostor.port(), setup);
  EXPECT_NE(refusal(informed), "");
  ASSERT_TRUE(serveUntil(context, {&informed}, [&] { return impostor.isDecided(2); }));
  EXPECT_EQ(impostor.heard(), "");

  // Checks the recorder itself: it records bytes when the client trusts it.
  setup.trust.fingerprint = impostor.fingerprint();
  auto trusting = std::make_unique<TestClient>(context, impostor.port(), setup);
  EXPECT_TRUE(serveUntil(context, {trusting.get()},
                         [&] { return impostor.heard().find("xyzzy") != std::string::npos; }));
}

TEST_F(TrustTest, AnImpostorInMidGameGetsNoToken) {
  TestServer server(busyWorld(5), home.server());
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
  EXPECT_TRUE(has(ann.connection().message(), "HAS CHANGED"));
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return impostor.isDecided(1); }));
  EXPECT_EQ(impostor.heard(), "") << "neither token nor password";
}

}  // namespace
}  // namespace naiad::test
