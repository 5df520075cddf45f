#include <gtest/gtest.h>

#include <asio/write.hpp>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "TlsFixture.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;
using namespace std::string_literals;

struct TcpConnectorTest : ConnectFixture {
  /// Returns a port of 127.0.0.1 without a listener.
  std::uint16_t closedPort() {
    return TcpListener(context, "127.0.0.1", 0, [](auto) {}).port();
  }
  TcpConnector connector{context};
};

TEST_F(TcpConnectorTest, DeliversAWorkingChannel) {
  for (const std::string host : {"127.0.0.1", "localhost", "::1"}) {
    const bool is_ipv6 = host == "::1";
    if (is_ipv6 && !haveIPv6Loopback()) GTEST_SKIP() << "no IPv6 loopback on this machine";
    std::unique_ptr<ReliableChannel> accepted;
    TcpListener listener(context, is_ipv6 ? host : "127.0.0.1", 0,
                         [&](auto made) { accepted = std::move(made); });
    connect(connector, host, listener.port());
    ASSERT_TRUE(runUntil(context, [&] { return accepted != nullptr; })) << host;
    ASSERT_TRUE(channel) << error;
    EXPECT_EQ(error, "");
    EXPECT_EQ(channel->peerAddress(), listener.address());
    Recorder recorder;
    accepted->start(recorder.callbacks());
    channel->send("hello");
    EXPECT_TRUE(runUntil(context, [&] { return !recorder.frames.empty(); }));
  }
}

TEST_F(TcpConnectorTest, UnreachableHostsGiveAClearError) {
  const std::uint16_t port = closedPort();
  const std::string unknown = std::string(70, 'x') + ".invalid";  // too long for a DNS query
  const std::string far = " is another machine: without encryption only loopback addresses are allowed.";
  for (const auto& [host, sentence] :
       {std::pair{"127.0.0.1"s,
                  "Nothing listens on 127.0.0.1:" + std::to_string(port) + " (connection refused)."},
        {"192.0.2.1", "192.0.2.1" + far},
        {"2001:db8::1", "2001:db8::1" + far},
        {unknown, "The host name \"" + unknown + "\" could not be found ("}}) {
    connect(connector, host, port);
    EXPECT_FALSE(channel) << host;
    EXPECT_EQ(host == unknown ? error.substr(0, sentence.size()) : error, sentence);
  }
}

TEST_F(TcpConnectorTest, SilenceEndsInATimeout) {
  // With a full backlog, the kernel leaves further connections unanswered.
  tcp::acceptor acceptor(context, tcp::v4());
  acceptor.bind({asio::ip::address_v4::loopback(), 0});
  acceptor.listen(1);
  std::vector<tcp::socket> fill;
  for (int i = 0; i < 16; ++i)
    fill.emplace_back(context).async_connect(acceptor.local_endpoint(), [](const std::error_code&) {});
  const std::uint16_t port = acceptor.local_endpoint().port();
  connect(connector, "127.0.0.1", port, 250ms);
  if (channel) GTEST_SKIP() << "this kernel accepts connections beyond a full backlog";
  EXPECT_EQ(error, "No answer from 127.0.0.1:" + std::to_string(port) + " within 250 ms.");
}

TEST_F(TcpConnectorTest, CancelledAttemptStaysSilent) {
  TcpListener listener(context, "127.0.0.1", 0, [](auto) {});
  connector.connect("127.0.0.1", listener.port(), 10s, [](auto, const auto&) { FAIL() << "cancelled"; });
  connector.cancel();
  connector.connect("127.0.0.1", listener.port(), 10s, [](auto, const auto&) { FAIL() << "replaced"; });
  connector.connect("127.0.0.1", listener.port(), 10s, done());
  EXPECT_TRUE(runUntilDone());
  EXPECT_TRUE(channel) << error;
}

TEST_F(TcpConnectorTest, MayBeDestroyedInItsCallback) {
  TcpListener listener(context, "127.0.0.1", 0, [](auto) {});
  auto mortal = std::make_unique<TcpConnector>(context);
  mortal->connect("127.0.0.1", listener.port(), 10s, [&](auto made, const std::string&) {
    mortal.reset();
    channel = std::move(made);
    ++calls;
  });
  EXPECT_TRUE(runUntilDone());
  EXPECT_TRUE(channel);
}

TEST_F(TcpConnectorTest, RetriesFromItsCallbackUntilTheServerReturns) {
  const std::uint16_t port = closedPort();
  std::unique_ptr<TcpListener> listener;
  TcpConnector::Done again = [&](std::unique_ptr<ReliableChannel> made, const std::string&) {
    channel = std::move(made);
    if (channel) return;
    if (++calls == 3) listener = std::make_unique<TcpListener>(context, "127.0.0.1", port, [](auto) {});
    connector.connect("127.0.0.1", port, 10s, again);
  };
  connector.connect("127.0.0.1", port, 10s, again);
  EXPECT_TRUE(runUntil(context, [&] { return channel != nullptr; }));
  EXPECT_EQ(calls, 3);
}

struct RestrictedConnector : ConnectFixture {
  /// Tries to connect. Returns the error; empty if it succeeds.
  std::string connectError(const std::string& host,
                           const std::function<bool(const asio::ip::address&)>& allowed) {
    TcpConnector connector(context, {}, TlsContext::forClient());
    connector.restrict(allowed);
    connect(connector, host, std::uint16_t{1}, 5s);
    return error;
  }
};

TEST_F(RestrictedConnector, NameResolvingToAForbiddenAddressIsRefused) {
  int asked = 0;
  const auto none = [&asked](const asio::ip::address&) {
    ++asked;
    return false;
  };
  for (const std::string host : {"127.0.0.1", "localhost", "::1"}) {
    const std::string problem = connectError(host, none);
    EXPECT_NE(problem.find("more private network"), std::string::npos) << problem;
  }
  EXPECT_GE(asked, 3) << "after the name was looked up";
  EXPECT_NE(connectError("127.0.0.1", {}).find("connection refused"), std::string::npos);
}

struct TlsConnectorTest : TlsFixture {
  /// Connects as if `host` were the name of this machine.
  void joinAs(const std::string& host, TcpConnector& by) {
    connect(by, host, std::vector<tcp::endpoint>{{asio::ip::make_address("127.0.0.1"), listener->port()}});
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
    connect(connector, "127.0.0.1", port);
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
  connect(connector, "127.0.0.1", listener->port());
  EXPECT_FALSE(channel);
  EXPECT_NE(error.find("(it does not speak naiad/1)"), std::string::npos) << error;
}

TEST_F(TlsConnectorTest, SilentServerEndsInATimeout) {
  const tcp::acceptor silent(context, {asio::ip::address_v4::loopback(), 0});
  const std::uint16_t port = silent.local_endpoint().port();
  connect(connector, "127.0.0.1", port, 100ms);
  EXPECT_EQ(error, "No answer from 127.0.0.1:" + std::to_string(port) + " within 100 ms.");
}

TEST_F(TlsConnectorTest, AddressThatIsSilentOrRefusesIsSkipped) {
  listen();
  const tcp::acceptor silent(context, {asio::ip::address_v4::loopback(), 0});
  const tcp::endpoint good(asio::ip::address_v4::loopback(), listener->port());
  const tcp::endpoint closed(good.address(), TcpListener(context, "127.0.0.1", 0, [](auto) {}).port());
  for (const tcp::endpoint& bad : {silent.local_endpoint(), closed}) {
    std::vector<tcp::endpoint> addresses(10, good);
    addresses[0] = bad;
    connect(connector, "game.test", addresses, 3s);
    EXPECT_TRUE(channel) << error;
  }
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
