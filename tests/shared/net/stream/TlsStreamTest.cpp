// Events after the handshake on an encrypted stream that plain streams do not have, and the secrets that both
// ends export.
#include <gtest/gtest.h>

#include <set>

#include "TlsFixture.h"
#include "shared/net/stream/Framing.h"

namespace naiad::test {
namespace {

using namespace std::string_literals;

/// A channel whose peer is OpenSSL, operated by the test.
struct TlsStreamTest : TlsFixture {
  void SetUp() override {
    listen();
    socket = knock();
    client.shakeHands(context, socket);
    ASSERT_TRUE(client.done());
    ASSERT_TRUE(runUntil(context, [&] { return accepted.size() == 1; }));
    accepted[0]->start(recorder.callbacks());
  }
  void clientSends(const std::string& payload) {
    std::string framed;
    appendFrame(framed, payload);
    ASSERT_EQ(SSL_write(client.ssl(), framed.data(), static_cast<int>(framed.size())),
              static_cast<int>(framed.size()));
    asio::write(socket, asio::buffer(client.advance()));
  }
  /// Reads until the client has received `size` bytes, and returns them.
  std::string clientReads(std::size_t size) {
    std::string got;
    EXPECT_TRUE(runUntil(context, [&] {
      std::array<char, 4096> in;
      const int read = client.read(socket, in.data(), in.size());
      if (read > 0) got.append(in.data(), static_cast<std::size_t>(read));
      return got.size() >= size;
    }));
    return got;
  }
  bool runUntilClosed() {
    return runUntil(context, [&] { return recorder.closed.has_value(); });
  }

  Recorder recorder;
  RawTls client;
  tcp::socket socket{context};
};

TEST_F(TlsStreamTest, ForgedRecordIsAProtocolError) {
  clientSends("genuine");
  asio::write(socket, asio::buffer("\x17\x03\x03\x00\x20"s + std::string(32, 'x')));
  EXPECT_TRUE(runUntilClosed());
  EXPECT_EQ(recorder.frames, std::vector{"genuine"s});
  EXPECT_EQ(recorder.closed, CloseReason::kProtocol);
}

TEST_F(TlsStreamTest, PlainBytesAfterHandshakeAreAProtocolError) {
  asio::write(socket, asio::buffer("\x05\0hello"s));
  EXPECT_TRUE(runUntilClosed());
  EXPECT_EQ(recorder.closed, CloseReason::kProtocol);
}

TEST_F(TlsStreamTest, PartialRecordLeavesTheLoopIdle) {
  asio::write(socket, asio::buffer("\x17\x03\x03\x00\x20"s + std::string(10, 'x')));
  for (int i = 0; i < 5; ++i) runReady(context);  // would not return if the loop were busy
  context.restart();
  EXPECT_EQ(context.poll(), 0u);
  EXPECT_FALSE(recorder.closed);
}

TEST_F(TlsStreamTest, KeysMayBeUpdatedInBothDirections) {
  for (int i = 0; i < 5; ++i) {
    ASSERT_EQ(SSL_key_update(client.ssl(), SSL_KEY_UPDATE_REQUESTED), 1);
    clientSends("up" + std::to_string(i));
    EXPECT_TRUE(runUntil(context, [&] { return recorder.frames.size() == static_cast<std::size_t>(i) + 1; }));
    accepted[0]->send("down");
    EXPECT_EQ(clientReads(6), "\x04\0down"s);
  }
  EXPECT_FALSE(recorder.closed);
}

TEST_F(TlsStreamTest, SecretMatchesOpenSslExport) {
  std::string expected(40, '\0');
  ASSERT_EQ(SSL_export_keying_material(client.ssl(), reinterpret_cast<unsigned char*>(expected.data()),
                                       expected.size(), "EXPERIMENTAL-naiad", 18,
                                       reinterpret_cast<const unsigned char*>("abc"), 3, 1),
            1);
  EXPECT_EQ(accepted[0]->exportSecret("EXPERIMENTAL-naiad", "abc", 40), expected);
}

TEST_F(TlsStreamTest, CloseSendsCloseNotify) {
  accepted[0]->send("bye");
  accepted[0]->close();
  EXPECT_EQ(clientReads(5), "\x03\0bye"s);
  EXPECT_TRUE(runUntil(context, [&] {
    char byte = 0;
    client.read(socket, &byte, 1);
    return (SSL_get_shutdown(client.ssl()) & SSL_RECEIVED_SHUTDOWN) != 0;
  }));
}

constexpr std::string_view kLabel = "EXPERIMENTAL-naiad-datagram";

/// Expects secrets that are equal at both ends and different for each use.
void expectSecrets(const ReliableChannel& near, const ReliableChannel& far, std::set<std::string>& seen) {
  for (const auto& [label, text, bytes] :
       {std::tuple(kLabel, "one", 88), std::tuple(kLabel, "two", 88), std::tuple(kLabel, "", 88),
        std::tuple(std::string_view("EXPERIMENTAL-other"), "one", 88), std::tuple(kLabel, "one", 32)}) {
    const std::string secret = near.exportSecret(label, text, static_cast<std::size_t>(bytes));
    EXPECT_EQ(secret.size(), static_cast<std::size_t>(bytes));
    EXPECT_EQ(secret, near.exportSecret(label, text, static_cast<std::size_t>(bytes)));
    EXPECT_EQ(secret, far.exportSecret(label, text, static_cast<std::size_t>(bytes)));
    EXPECT_TRUE(seen.insert(secret.substr(0, 32)).second) << label << ' ' << text << ' ' << bytes;
  }
}

TEST(ExportSecret, BothTlsEndsShareAUniqueSecret) {
  asio::io_context context;
  std::set<std::string> seen;
  for (int connection = 0; connection < 2; ++connection) {
    const ChannelPair pair(context, Kind::kTls);
    expectSecrets(*pair.near, *pair.far, seen);
  }
}

TEST(ExportSecret, IsEmptyWithoutEncryptionAndAfterTheEnd) {
  asio::io_context context;
  const ChannelPair plain(context, Kind::kPlain);
  EXPECT_EQ(plain.near->exportSecret(kLabel, "one", 32), "");
  ChannelPair pair(context, Kind::kTls);
  Recorder recorder;
  pair.far->start(recorder.callbacks());
  pair.near.reset();
  EXPECT_TRUE(runUntil(context, [&] { return recorder.closed.has_value(); }));
  EXPECT_EQ(recorder.closed, CloseReason::kPeer);
  EXPECT_EQ(pair.far->exportSecret(kLabel, "one", 32), "");
}

}  // namespace
}  // namespace naiad::test
