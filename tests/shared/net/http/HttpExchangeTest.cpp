// Requests to a web server that the test plays by hand, in plain TCP on loopback and in TLS.
#include <gtest/gtest.h>
#include <openssl/ssl.h>
#include <stdlib.h>

#include <array>
#include <fstream>
#include <optional>
#include <string>

#include "shared/net/http/HttpExchange.h"
#include "tests/shared/net/Loopback.h"
#include "tests/support/TempFolder.h"

namespace naiad::test {
namespace {

using End = HttpExchange::End;
using std::chrono::milliseconds;
using std::chrono::seconds;

const HttpRequest kRequest{.target = "/list", .host = "naiad.test"};

struct HttpExchangeTest : testing::Test {
  void run(StreamTarget target, std::chrono::milliseconds timeout = seconds(20),
           HttpExchange::BodyHandler on_body = nullptr) {
    ended.reset();
    exchange = std::make_shared<HttpExchange>(context, HttpLimits{.head = 1000, .body = 100});
    exchange->run(
        target, kRequest, timeout, [this](const HttpExchange::Result& result) { ended.emplace(result); },
        std::move(on_body));
  }
  StreamTarget plain() const { return {"127.0.0.1", acceptor.local_endpoint().port()}; }

  void accept() {
    std::optional<tcp::socket> socket;
    acceptor.async_accept([&](const std::error_code& error, tcp::socket made) {
      if (!error) socket.emplace(std::move(made));
    });
    ASSERT_TRUE(runUntil(context, [&] { return socket.has_value(); }));
    if (!server_context) {
      peer = std::make_unique<PlainStream>(*std::move(socket));
      return;
    }
    bool over = false;
    const auto handshake =
        std::make_shared<TlsHandshake>(std::make_unique<TlsStream>(*std::move(socket), server_context));
    handshake->run(seconds(20),
                   [&](TlsHandshake::End, std::unique_ptr<TlsStream> stream, const std::string& problem) {
                     peer = std::move(stream);
                     server_problem = problem;
                     over = true;
                   });
    ASSERT_TRUE(runUntil(context, [&] { return over; }));
  }
  void readRequest() {
    ASSERT_TRUE(peer) << server_problem;
    ASSERT_TRUE(runUntil(context, [&] {
      std::array<char, 1000> buffer;
      const auto [outcome, size] = peer->read(buffer);
      if (outcome == ByteStream::Outcome::kDone) request.append(buffer.data(), size);
      return request.ends_with("\r\n\r\n");
    }));
  }
  void answer(std::string_view bytes) {
    ASSERT_TRUE(peer);
    ASSERT_EQ(peer->write(bytes).outcome, ByteStream::Outcome::kDone);
    runReady(context);
  }
  /// Accepts a connection, reads the request, and answers with these bytes.
  void respond(std::string_view bytes) {
    accept();
    readRequest();
    answer(bytes);
  }
  End end() {
    EXPECT_TRUE(runUntil(context, [&] { return ended.has_value(); }));
    return ended ? ended->end : End::kTimedOut;
  }

  asio::io_context context;
  tcp::acceptor acceptor{context, tcp::endpoint(asio::ip::address_v4::loopback(), 0)};
  std::shared_ptr<HttpExchange> exchange;  ///< the newest
  std::shared_ptr<const TlsContext> server_context;
  std::unique_ptr<ByteStream> peer;
  std::string server_problem;
  std::string request;
  std::optional<HttpExchange::Result> ended;
};

TEST_F(HttpExchangeTest, SendsTheRequestAndReadsTheAnswerInPieces) {
  run(plain());
  accept();
  readRequest();
  EXPECT_EQ(request, "GET /list HTTP/1.1\r\nHost: naiad.test\r\n\r\n");
  for (const char c : std::string("HTTP/1.1 404 No\r\nContent-Length: 3\r\n\r\nabc")) answer({&c, 1});
  EXPECT_EQ(end(), End::kAnswered);
  EXPECT_EQ(exchange->answer().status(), 404U);
  EXPECT_EQ(exchange->answer().body(), "abc");
}

TEST_F(HttpExchangeTest, RequestsWithABodyHaveAContentLength) {
  const HttpRequest post{"POST", "/ready", "localhost", {{"Content-Type", "application/json"}}, "{}"};
  EXPECT_EQ(post.text(),
            "POST /ready HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: "
            "2\r\n\r\n{}");
}

TEST_F(HttpExchangeTest, NonHttpAndOversizedAnswersAreRefused) {
  run(plain());
  accept();
  answer("220 mail.example ESMTP\r\n\r\n");
  EXPECT_EQ(end(), End::kBadAnswer);
  run(plain());
  respond("HTTP/1.1 200 OK\r\n\r\n" + std::string(101, 'x'));
  EXPECT_EQ(end(), End::kTooLong);
}

TEST_F(HttpExchangeTest, SilentServerTimesOut) {
  run(plain(), milliseconds(100));
  accept();
  EXPECT_EQ(end(), End::kTimedOut);
  EXPECT_TRUE(runUntil(context, [&] {
    std::array<char, 1000> buffer;
    return peer->read(buffer).outcome == ByteStream::Outcome::kEnd;
  })) << "it is hung up on";
}

// Unencrypted requests stay on this machine.
TEST_F(HttpExchangeTest, UnusableTargetsAreReportedByReason) {
  const StreamTarget closed = plain();
  acceptor.close();
  for (const auto& [target, reason] : {std::pair(closed, End::kUnreachable),
                                       {StreamTarget{"192.0.2.1", 80}, End::kOtherMachine},
                                       {StreamTarget{"nothing.invalid", 80}, End::kNotFound}}) {
    run(target);
    EXPECT_EQ(end(), reason) << target.host;
  }
}

TEST_F(HttpExchangeTest, SwitchedProtocolGetsTheStreamAndEarlyBytes) {
  run(plain());
  respond("HTTP/1.1 101 Switching\r\nUpgrade: x\r\n\r\nfirst");
  ASSERT_EQ(end(), End::kAnswered);
  EXPECT_EQ(exchange->bytesBehind(), "first");
  const auto stream = exchange->releaseStream();
  ASSERT_TRUE(stream);
  EXPECT_EQ(stream->write("x").outcome, ByteStream::Outcome::kDone);
}

TEST_F(HttpExchangeTest, StreamedAnswerArrivesInPiecesWithoutTimeout) {
  std::string pieces;
  run(plain(), milliseconds(80), [&](std::string_view piece) {
    pieces += piece;
    return pieces != "ab";
  });
  accept();
  readRequest();
  asio::steady_timer later(context, milliseconds(200));  // longer than the timeout
  bool is_later = false;
  later.async_wait([&](const std::error_code&) { is_later = true; });
  ASSERT_TRUE(runUntil(context, [&] { return is_later; }));
  ASSERT_FALSE(ended);
  answer("HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n1\r\na");
  ASSERT_TRUE(runUntil(context, [&] { return pieces == "a"; }));
  answer("\r\n1\r\nb\r\n");
  EXPECT_EQ(end(), End::kStopped);
}

TEST_F(HttpExchangeTest, StreamedAnswerNeedsStatus200) {
  int pieces = 0;
  run(plain(), seconds(20), [&](std::string_view) { return ++pieces > 0; });
  respond("HTTP/1.1 500 No\r\n\r\nx");
  EXPECT_EQ(end(), End::kBadAnswer);
  EXPECT_EQ(ended->detail, "status 500");
  EXPECT_EQ(pieces, 0);
}

TEST_F(HttpExchangeTest, BodyHandlerMayCancel) {
  bool called = false;
  run(plain(), seconds(20), [&](std::string_view) {
    called = true;
    exchange->cancel();
    return true;
  });
  respond("HTTP/1.1 200 OK\r\n\r\na");
  ASSERT_TRUE(runUntil(context, [&] { return called; }));
  peer.reset();
  context.restart();
  context.run();  // returns only if nothing is left to do
  EXPECT_FALSE(ended);
}

TEST_F(HttpExchangeTest, EventLoopMayEndDuringAnExchange) {
  bool called = false;
  for (const bool connects : {false, true}) {
    asio::io_context other;
    const auto mine = std::make_shared<HttpExchange>(other);
    mine->run(plain(), kRequest, seconds(20), [&](const HttpExchange::Result&) { called = true; });
    if (connects) runReady(other);
  }
  EXPECT_FALSE(called);
}

/// Makes the system trust an additional authority.
struct HttpsExchange : HttpExchangeTest {
  HttpsExchange() {
    std::ofstream(folder / "trusted.pem") << authority.certificate;
    setenv("SSL_CERT_FILE", (folder / "trusted.pem").c_str(), 1);
    client_context = TlsContext::forWebClient();
    serve(TestIdentity::make("localhost", &authority));
  }
  ~HttpsExchange() override { unsetenv("SSL_CERT_FILE"); }
  void serve(const TestIdentity& identity) {
    server_context = TlsContext::forWebServer(identity.certificate, identity.key);
  }
  StreamTarget https(const std::string& host = "localhost") const {
    return {host, acceptor.local_endpoint().port(), client_context};
  }

  TempFolder folder;
  TestIdentity authority = TestIdentity::make("authority.test");
  std::shared_ptr<const TlsContext> client_context;
};

TEST_F(HttpsExchange, ServerWithAValidCertificateGetsTheRequest) {
  run(https());
  respond("HTTP/1.1 200 OK\r\nContent-Length: 2\r\n\r\nok");
  EXPECT_EQ(end(), End::kAnswered);
  EXPECT_EQ(exchange->answer().body(), "ok");
}

TEST_F(HttpsExchange, OlderTlsIsRefused) {
  SSL_CTX_set_min_proto_version(server_context->get(), TLS1_1_VERSION);
  SSL_CTX_set_max_proto_version(server_context->get(), TLS1_1_VERSION);
  SSL_CTX_set_security_level(server_context->get(), 0);
  run(https());
  accept();
  EXPECT_EQ(end(), End::kUntrusted);
}

TEST_F(HttpsExchange, ServerWithAnInvalidCertificateGetsNoRequest) {
  const TestIdentity stranger = TestIdentity::make("localhost");
  const TestIdentity other = TestIdentity::make("other.test", &authority);
  for (const TestIdentity* const identity : {&stranger, &other}) {
    serve(*identity);
    run(https());
    accept();
    EXPECT_EQ(end(), End::kUntrusted);
    EXPECT_NE(ended->detail, "");
    if (!peer) continue;
    std::array<char, 1000> buffer;
    EXPECT_NE(peer->read(buffer).outcome, ByteStream::Outcome::kDone);
  }
}

TEST_F(HttpsExchange, BodyThatEndsWithoutCloseNotifyIsTruncated) {
  run(https());
  respond("HTTP/1.1 200 OK\r\n\r\nhalf");
  peer->socket().close();
  EXPECT_EQ(end(), End::kBadAnswer);
}

}  // namespace
}  // namespace naiad::test
