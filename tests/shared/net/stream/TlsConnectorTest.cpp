// Facts that a TLS client learns about a server, and servers that it rejects.
#include <gtest/gtest.h>

#include <asio/write.hpp>
#include <fstream>
#include <map>
#include <utility>
#include <vector>

#include "TlsFixture.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;

struct TlsConnectorTest : TlsFixture {
  /// Connects as if `host` were the name of this machine.
  void joinAs(const std::string& host, TcpConnector& by) {
    calls = 0;
    by.connect(host, {{asio::ip::make_address("127.0.0.1"), listener->port()}}, 20s, done());
    EXPECT_TRUE(runUntilDone());
  }
  std::string inFile(const std::string& content) {
    const std::string path = testing::TempDir() + "trusted-" + std::to_string(getpid()) + ".pem";
    std::ofstream(path) << content;
    return path;
  }
};

TEST_F(TlsConnectorTest, LearnsTheKeyOfASelfSignedServer) {
  listen();
  join();
  ASSERT_TRUE(connector.peerIdentity());
  EXPECT_FALSE(connector.peerIdentity()->chain_verifies);
  EXPECT_EQ(connector.peerIdentity()->chain_problem, "self-signed certificate");
  const auto facts = connector.peerIdentity();
  join();
  EXPECT_EQ(connector.peerIdentity()->key, facts->key);
  connector.cancel();
  EXPECT_FALSE(connector.peerIdentity());
}

TEST_F(TlsConnectorTest, ChainVerifiesOnlyForItsOwnName) {
  const TestIdentity authority = TestIdentity::make("authority.test");
  const TestIdentity server = TestIdentity::make("game.test", &authority);
  tls.context = TlsContext::forServer(server.certificate, server.key);
  listen();
  const std::string trusted = inFile(authority.certificate);
  TcpConnector trusting(context, {}, TlsContext::forClient(trusted));
  std::remove(trusted.c_str());
  for (const auto& [host, verifies] : {std::pair("game.test", true), std::pair("GAME.test.", true),
                                       std::pair("other.test", false), std::pair("127.0.0.1", false)}) {
    joinAs(host, trusting);
    ASSERT_TRUE(trusting.peerIdentity()) << error;
    EXPECT_EQ(trusting.peerIdentity()->chain_verifies, verifies) << host;
    EXPECT_EQ(trusting.peerIdentity()->chain_problem.empty(), verifies) << host;
  }
  joinAs("game.test", connector);  // this connector does not trust the authority
  EXPECT_FALSE(connector.peerIdentity()->chain_verifies);
}

TEST_F(TlsConnectorTest, SniHasHostNamesButNoAddresses) {
  auto context_with_ears = TlsContext::forServer(testIdentity().certificate, testIdentity().key);
  std::string heard;
  SSL_CTX_set_tlsext_servername_arg(context_with_ears->get(), &heard);
  SSL_CTX_set_tlsext_servername_callback(
      context_with_ears->get(), +[](SSL* ssl, int*, void* ears) {
        const char* name = SSL_get_servername(ssl, TLSEXT_NAMETYPE_host_name);
        *static_cast<std::string*>(ears) = name ? name : "nothing";
        return SSL_TLSEXT_ERR_OK;
      });
  tls.context = context_with_ears;
  listen();
  joinAs("game.test", connector);
  EXPECT_EQ(heard, "game.test");
  joinAs("127.0.0.1", connector);
  EXPECT_EQ(heard, "nothing");
}

// A table of what players read if a server closes the connection, or sends something, before TLS.
TEST_F(TlsConnectorTest, ErrorTellsWhatCameInsteadOfTls) {
  const std::string closed =
      " closed the connection: your address may be banned there, or no Naiad server runs there.";
  const std::string other = " does not answer as a Naiad server (it does not speak TLS).";
  const std::map<std::string, std::string> answers{
      {"", closed}, {"SSH-2.0-OpenSSH_9.2\r\n", other}, {"HTTP/1.1 400 Bad Request\r\n\r\n", other}};
  for (const auto& [answer, text] : answers) {
    tcp::acceptor server(context, {asio::ip::address_v4::loopback(), 0});
    const std::uint16_t port = server.local_endpoint().port();
    std::vector<tcp::socket> kept;
    server.async_accept([&, sent = answer](const std::error_code&, tcp::socket socket) {
      if (sent.empty()) return;  // closes the connection
      asio::write(socket, asio::buffer(sent));
      kept.push_back(std::move(socket));
    });
    calls = 0;
    connector.connect("127.0.0.1", port, 10s, done());
    ASSERT_TRUE(runUntilDone());
    EXPECT_EQ(error, "127.0.0.1:" + std::to_string(port) + text);
    EXPECT_EQ(connector.closedDuringHandshake(), answer.empty());
  }
}

TEST_F(TlsConnectorTest, ServerWithoutOurAlpnIsRefused) {
  auto forgetful = TlsContext::forServer(testIdentity().certificate, testIdentity().key);
  SSL_CTX_set_alpn_select_cb(
      forgetful->get(),
      +[](SSL*, const unsigned char**, unsigned char*, const unsigned char*, unsigned, void*) {
        return SSL_TLSEXT_ERR_NOACK;
      },
      nullptr);
  tls.context = forgetful;
  listen();
  connector.connect("127.0.0.1", listener->port(), 10s, done());
  ASSERT_TRUE(runUntilDone());
  EXPECT_FALSE(channel);
  EXPECT_NE(error.find("(it does not speak naiad/1)"), std::string::npos) << error;
}

TEST_F(TlsConnectorTest, SilentServerEndsInATimeout) {
  const tcp::acceptor silent(context, {asio::ip::address_v4::loopback(), 0});
  const std::uint16_t port = silent.local_endpoint().port();
  connector.connect("127.0.0.1", port, 100ms, done());
  ASSERT_TRUE(runUntilDone());
  EXPECT_EQ(error, "No answer from 127.0.0.1:" + std::to_string(port) + " within 100 ms.");
}

TEST_F(TlsConnectorTest, SilentAddressTimesOutAndTheNextIsTried) {
  listen();
  const tcp::acceptor silent(context, {asio::ip::address_v4::loopback(), 0});
  const tcp::endpoint good(asio::ip::address_v4::loopback(), listener->port());
  std::vector<tcp::endpoint> addresses(10, good);
  addresses[0] = silent.local_endpoint();
  connector.connect("game.test", addresses, 3s, done());
  ASSERT_TRUE(runUntilDone());
  EXPECT_TRUE(channel) << error;
}

TEST_F(TlsConnectorTest, RefusingAddressIsSkipped) {
  const std::uint16_t closed = TcpListener(context, "127.0.0.1", 0, [](auto) {}).port();
  listen();
  const auto here = asio::ip::address_v4::loopback();
  connector.connect("game.test", {{here, closed}, {here, listener->port()}}, 20s, done());
  ASSERT_TRUE(runUntilDone());
  EXPECT_TRUE(channel) << error;
}

TEST_F(TlsConnectorTest, AttemptCancelledDuringHandshakeStaysSilent) {
  const tcp::acceptor silent(context, {asio::ip::address_v4::loopback(), 0});
  connector.connect("127.0.0.1", silent.local_endpoint().port(), 1h,
                    [](auto, const auto&) { FAIL() << "cancelled"; });
  runReady(context);
  runReady(context);
  connector.cancel();
  EXPECT_TRUE(runUntil(context, [&] { return context.stopped(); }));
}

}  // namespace
}  // namespace naiad::test
