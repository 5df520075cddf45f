// The WebSockets of dfclient and dfbot work with an independent server, Debian's python3-websockets.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <asio/io_context.hpp>
#include <memory>
#include <optional>
#include <string>

#include "client/session/GatewayStreamOpener.h"
#include "tests/shared/net/Loopback.h"
#include "tests/shared/net/Recorder.h"
#include "tests/support/RunProgram.h"
#include "tests/support/RunningProgram.h"
#include "tests/support/TempFolder.h"

namespace naiad::test {
namespace {

constexpr const char* kPeer = NAIAD_SOURCE_DIR "/tests/client/session/websocket-peer";

class WebSocketPeer : public testing::Test {
 protected:
  void SetUp() override {
    if (runProgram("/usr/bin/python3 -c 'import websockets' 2>/dev/null").first != 0)
      GTEST_SKIP() << "/usr/bin/python3 has no module websockets (Debian: python3-websockets)";
  }
  void TearDown() override { unsetenv("SSL_CERT_FILE"); }

  void start(const std::string& subprotocol = "naiad.1", const std::string& scheme = "http",
             const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{kPeer, subprotocol};
    words.insert(words.end(), more.begin(), more.end());
    peer = std::make_unique<RunningProgram>(words);
    ASSERT_TRUE(peer->prints("port ") && peer->prints("\n")) << peer->printed();
    origin = scheme + "://localhost:" + std::to_string(std::stoi(peer->printed().substr(5)));
  }
  void open() {
    GatewayStreamOpener streams(context, *GatewayAddress::parse(origin));
    streams.open([this](std::unique_ptr<ReliableChannel> made, const std::string& message) {
      channel = std::move(made);
      error = message;
    });
    ASSERT_TRUE(runUntil(context, [&] { return error.has_value(); }));
    if (channel) channel->start(recorder.callbacks());
  }
  /// Sends a message and returns the answer.
  std::string ask(const std::string& message) {
    recorder.frames.clear();
    channel->send(message);
    EXPECT_TRUE(runUntil(context, [&] { return !recorder.frames.empty() || recorder.closed; }));
    return recorder.frames.empty() ? "nothing" : recorder.frames.front();
  }

  TempFolder folder;
  std::unique_ptr<RunningProgram> peer;
  std::string origin;
  asio::io_context context;
  Recorder recorder;
  std::optional<std::string> error;
  std::unique_ptr<ReliableChannel> channel;
};

TEST_F(WebSocketPeer, FramesOfAllKindsAreUnderstood) {
  start();
  open();
  ASSERT_TRUE(channel) << *error;
  EXPECT_TRUE(peer->prints("open /play " + origin + " naiad.1\n")) << peer->printed();
  for (const std::size_t size : {1, 125, 126, 4096}) {
    const std::string message(size, 'm');
    EXPECT_EQ(ask(message), message);
  }
  EXPECT_EQ(ask("ping"), "pong came");
  EXPECT_EQ(ask("fragments"), "one two");
  EXPECT_EQ(ask("large"), std::string(16384, 'x'));
  channel->close();
  EXPECT_TRUE(runUntil(context, [&] { return recorder.closed.has_value(); }));
  EXPECT_EQ(recorder.closed, CloseReason::kLocal);
  EXPECT_TRUE(peer->prints("closed 1000\n")) << peer->printed();
}

TEST_F(WebSocketPeer, AnotherSubprotocolIsRefused) {
  start("chat");
  open();
  EXPECT_FALSE(channel);
  EXPECT_EQ(error, "Cannot join through the gateway (wrong subprotocol).");
}

TEST_F(WebSocketPeer, TlsAcceptsASystemTrustedCertificate) {
  const std::string certificate = folder / "certificate.pem";
  const std::string key = folder / "key.pem";
  ASSERT_EQ(runProgram("openssl req -x509 -newkey rsa:2048 -nodes -days 2 -subj /CN=localhost -addext "
                       "subjectAltName=DNS:localhost -keyout " +
                       key + " -out " + certificate + " 2>/dev/null")
                .first,
            0);
  setenv("SSL_CERT_FILE", certificate.c_str(), 1);
  start("naiad.1", "https", {certificate, key});
  open();
  ASSERT_TRUE(channel) << *error;
  EXPECT_EQ(ask("hello"), "hello");
  EXPECT_EQ(ask("large"), std::string(16384, 'x'));
  EXPECT_EQ(channel->exportSecret("label", "", 32), "");
}

}  // namespace
}  // namespace naiad::test
