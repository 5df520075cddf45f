// Passwords decide which players may join; pins and fingerprints decide which servers are trusted.
#include <gtest/gtest.h>

#include "LoopbackFixture.h"
#include "RecordingServer.h"
#include "StreamProxy.h"

namespace naiad::test {
namespace {

class TrustTest : public LoopbackFixture {
 protected:
  std::string refusal(TestClient& client) {
    const std::string message = LoopbackFixture::refusal(client);
    EXPECT_TRUE(client.joined() || client.connection().state() == Connection::State::kRefused);
    return message;
  }
};

/// The password is a secret, and the hello contains it. Tested with a pin from an earlier session, with the
/// key of a link, and with a key given by the host.
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
    ASSERT_TRUE(serve(again, [&] { return impostor.isDecided(1); }));
    EXPECT_EQ(impostor.heard(), "");
  }
  const auto expectRefusal = [&](const char* sentence, int connections) {
    TestClient client(context, impostor.port(), setup);
    EXPECT_TRUE(has(refusal(client), sentence));
    EXPECT_TRUE(serve(client, [&] { return impostor.isDecided(connections); }));
    EXPECT_EQ(impostor.heard(), "");
  };
  const auto other = Fingerprint::parse(std::string(64, 'a'));
  setup.trust.link_key = ShortKey::of(*other);
  expectRefusal("does not have the key in the link", 2);
  setup.trust.link_key.reset();
  setup.trust.fingerprint = other;
  expectRefusal("does not have the given key", 3);

  // Checks the recorder itself: it records bytes when the client trusts it.
  setup.trust.fingerprint = impostor.fingerprint();
  auto trusting = std::make_unique<TestClient>(context, impostor.port(), setup);
  EXPECT_TRUE(serve(*trusting, [&] { return impostor.heard().find("xyzzy") != std::string::npos; }));
}

}  // namespace
}  // namespace naiad::test
