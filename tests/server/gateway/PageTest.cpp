// The gateway's replies to HTTP requests, and to bytes that are not HTTP.
#include <gtest/gtest.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <zlib.h>

#include <asio/connect.hpp>
#include <fstream>
#include <random>

#include "GatewayRun.h"
#include "WebClient.h"
#include "host/auth/ServerIdentity.h"
#include "tests/support/Text.h"

namespace naiad::test {
namespace {

/// Returns an arbitrary key, because no test here connects to a server.
ShortKey anyKey() {
  return *ShortKey::parse("aaaaaaaaaaaaaaaaaaaaaaaaaa");
}

std::string unpacked(const std::string& gzip) {
  z_stream stream{};
  inflateInit2(&stream, 15 + 16);
  std::string text(std::size_t{1} << 20, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(gzip.data()));
  stream.avail_in = static_cast<uInt>(gzip.size());
  stream.next_out = reinterpret_cast<Bytef*>(text.data());
  stream.avail_out = static_cast<uInt>(text.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  text.resize(stream.total_out);
  inflateEnd(&stream);
  return text;
}

void expectGuarded(const std::optional<HttpReply>& reply, int status) {
  ASSERT_TRUE(reply) << status;
  EXPECT_EQ(reply->status, status);
  const auto& headers = reply->headers;
  const auto value = [&headers](const char* name) {
    return headers.contains(name) ? headers.at(name) : std::string();
  };
  EXPECT_EQ(
      value("content-security-policy"),
      "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; font-src 'self'; img-src "
      "'self'; connect-src 'self'; manifest-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors "
      "'none'")
      << status;
  EXPECT_EQ(value("x-content-type-options"), "nosniff") << status;
  EXPECT_EQ(value("referrer-policy"), "no-referrer") << status;
  EXPECT_EQ(value("cross-origin-opener-policy"), "same-origin") << status;
  EXPECT_EQ(value("cross-origin-resource-policy"), "same-origin") << status;
  EXPECT_EQ(value("cache-control"), "no-cache") << status;
  EXPECT_EQ(value("server").find("Beast"), std::string::npos) << status;
}

class GatewayPage : public testing::Test {
 protected:
  GatewayHome home;
  GatewaySettings settings = home.settings(anyKey());
};

/// A gateway with these settings, and a browser.
class ServedPage : public GatewayPage {
 protected:
  GatewayRun gateway{settings};
  WebClient browser{gateway.port()};
};

TEST_F(ServedPage, FilesHaveContentTypesAndSupportConditionalRequests) {
  const auto index = browser.ask("/");
  ASSERT_TRUE(index);
  EXPECT_EQ(index->status, 200);
  EXPECT_EQ(index->body, indexText());
  EXPECT_EQ(index->headers.at("content-type"), "text/html; charset=utf-8");
  const auto wasm = browser.ask("/client.wasm?v=1");
  ASSERT_TRUE(wasm);
  EXPECT_EQ(wasm->body, wasmBytes());
  EXPECT_EQ(wasm->headers.at("content-type"), "application/wasm");
  EXPECT_EQ(browser.ask("/font.woff2")->headers.at("content-type"), "font/woff2");
  const auto again = browser.ask("/", "If-None-Match: \"other\", W/" + index->headers.at("etag") + "\r\n");
  ASSERT_TRUE(again);
  EXPECT_EQ(again->status, 304);
  EXPECT_EQ(again->headers.at("etag"), index->headers.at("etag"));
  EXPECT_EQ(browser.ask("/", "If-None-Match: \"other\"\r\n")->status, 200);
  EXPECT_EQ(gateway.counters().connections, 1u) << "one connection for all of them";
}

TEST_F(ServedPage, FilesArePackedForBrowsersThatUnpack) {
  const auto packed = browser.ask("/", "Accept-Encoding: br, GZIP;q=0.5\r\n");
  ASSERT_TRUE(packed);
  EXPECT_EQ(packed->headers.at("content-encoding"), "gzip");
  EXPECT_EQ(packed->headers.at("vary"), "Accept-Encoding");
  EXPECT_LT(packed->body.size(), indexText().size() / 4);
  EXPECT_EQ(unpacked(packed->body), indexText());
  EXPECT_EQ(
      browser.ask("/", "Accept-Encoding: gzip\r\nIf-None-Match: " + packed->headers.at("etag") + "\r\n")
          ->status,
      304);
  EXPECT_EQ(browser.ask("/", "If-None-Match: " + packed->headers.at("etag") + "\r\n")->status, 200)
      << "another form of it";
  for (const char* const none : {"", "Accept-Encoding: br\r\n", "Accept-Encoding: gzip;q=0\r\n"})
    EXPECT_EQ(browser.ask("/", none)->body, indexText()) << none;
  EXPECT_EQ(browser.ask("/font.woff2", "Accept-Encoding: gzip\r\n")->body, "a font");
}

TEST_F(ServedPage, HeadHasNoBody) {
  browser.get("/client.wasm", "", "HEAD");
  const auto head = browser.reply(false);
  ASSERT_TRUE(head);
  EXPECT_EQ(head->headers.at("content-length"), std::to_string(wasmBytes().size()));
  EXPECT_EQ(browser.ask("/")->body, indexText()) << "nothing of a body came before it";
}

TEST_F(ServedPage, ServerSaysItsNameAndKey) {
  const auto server = WebClient(gateway.port()).ask("/server");
  ASSERT_TRUE(server);
  EXPECT_EQ(server->headers.at("content-type"), "application/json");
  EXPECT_EQ(server->body, "{\"name\": \"A \\\"game\\\"\", \"key\": \"aaaaaaaaaaaaaaaaaaaaaaaaaa\"}\n");
}

TEST_F(ServedPage, EveryAnswerHasTheHeadersThatGuardThePage) {
  expectGuarded(browser.ask("/"), 200);
  expectGuarded(browser.ask("/", "If-None-Match: *\r\n"), 304);
  expectGuarded(browser.ask("/server"), 200);
  expectGuarded(browser.ask("/nothing"), 404);
  expectGuarded(browser.ask("/play"), 426);
  const auto alone = [this](const std::string& bytes) {
    WebClient client(gateway.port());
    client.send(bytes);
    return client.reply();
  };
  expectGuarded(alone("GARBAGE\r\n\r\n"), 400);
  expectGuarded(alone("GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n"), 421);
  expectGuarded(alone("GET / HTTP/1.0\r\nHost: localhost\r\n\r\n"), 505);
  expectGuarded(alone("GET / HTTP/1.1\r\nX: " + std::string(9000, 'x')), 431);
  WebClient other(gateway.port());
  other.get("/", "", "DELETE");
  const auto refusal = other.reply();
  expectGuarded(refusal, 405);
  EXPECT_EQ(refusal->headers.at("connection"), "close") << "as it does";
  WebClient play(gateway.port());
  play.requestPlay();
  expectGuarded(play.reply(false), 101);
  WebClient stranger(gateway.port());
  stranger.requestPlay("Origin: https://evil.example\r\n");
  expectGuarded(stranger.reply(), 403);
}

TEST_F(ServedPage, OnlyItsOwnFilesAreThere) {
  for (const char* const path :
       {"/../secret.txt", "/%2e%2e/secret.txt", "/page/../../secret.txt", "/.hidden", "/folder/other.js",
        "/folder", "//", "/index.html/", "/INDEX.HTML", "http://127.0.0.1/../secret.txt", "*", "/..%00/"}) {
    const auto reply = WebClient(gateway.port()).ask(path);
    ASSERT_TRUE(reply) << path;
    EXPECT_EQ(reply->status, 404) << path;
  }
}

TEST_F(GatewayPage, UnknownHostHeaderIsRejected) {
  settings.origins.push_back(*WebOrigin::parse("https://play.example"));
  GatewayRun gateway(settings);
  const std::string port = std::to_string(gateway.port());
  const auto statusFor = [&gateway](const std::string& hosts) {
    WebClient client(gateway.port());
    client.send("GET / HTTP/1.1\r\n" + hosts + "\r\n");
    const auto reply = client.reply();
    return reply ? reply->status : 0;
  };
  for (const std::string& good :
       {"127.0.0.1:" + port, "localhost:" + port, "LOCALHOST:" + port, "[::1]:" + port,
        std::string("play.example"), std::string("play.example:443")})
    EXPECT_EQ(statusFor("Host: " + good + "\r\n"), 200) << good;
  for (const std::string& bad :
       {std::string("evil.example"), "evil.example:" + port, std::string("127.0.0.1"),
        std::string("play.example.evil.example"), "play.example:" + port, std::string()})
    EXPECT_EQ(statusFor("Host: " + bad + "\r\n"), 421) << bad;
  EXPECT_EQ(statusFor(""), 421);
  EXPECT_EQ(statusFor("Host: localhost:" + port + "\r\nHost: evil.example\r\n"), 421);
}

TEST_F(ServedPage, GarbageGetsAnErrorOrNothing) {
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    WebClient client(gateway.port());
    std::string bytes;
    if (i % 2 == 1) bytes = "GET / HTTP/1.1\r\nHost: localhost\r\n";
    for (int n = 0; n < 300; ++n) bytes.push_back(static_cast<char>(random()));
    client.send(bytes + "\r\n\r\n");
    const auto reply = client.reply();
    EXPECT_TRUE(!reply || reply->status >= 400);
    EXPECT_TRUE(client.waitForHangup());
  }
  EXPECT_EQ(WebClient(gateway.port()).ask("/")->status, 200);
}

TEST_F(ServedPage, RequestBodyIsRejected) {
  for (const char* const lines :
       {"Content-Length: 5\r\n", "Transfer-Encoding: chunked\r\n", "Content-Length: 99999999999\r\n"}) {
    WebClient client(gateway.port());
    client.get("/", lines);
    client.send("GET /secret HTTP/1.1\r\n\r\n");
    const auto reply = client.reply();
    ASSERT_TRUE(reply);
    EXPECT_TRUE(reply->status == 400 || reply->status == 413) << reply->status;
    EXPECT_TRUE(client.waitForHangup()) << "what follows is no second request";
  }
}

TEST_F(GatewayPage, SlowRequestHeadTimesOut) {
  settings.head_timeout = std::chrono::milliseconds(300);
  GatewayRun gateway(settings);
  WebClient silent(gateway.port());
  WebClient slow(gateway.port());
  const auto begin = std::chrono::steady_clock::now();
  slow.send("GET / HTTP/1.1\r\n");
  while (!slow.isHungUp()) {
    ASSERT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30));
    slow.send("X");  // slow bytes do not extend the time limit
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_TRUE(silent.waitForHangup());
  EXPECT_EQ(gateway.counters().timeouts, 2u);
}

TEST_F(ServedPage, RequestsOfOneConnectionAreBounded) {
  int answers = 0;
  while (const auto reply = browser.ask("/server")) {
    ++answers;
    EXPECT_EQ(reply->headers.contains("connection"), answers == 100);
  }
  EXPECT_EQ(answers, 100);
}

TEST_F(GatewayPage, GatewayWithoutCertificateMustListenOnLoopback) {
  settings.address = "0.0.0.0";
  EXPECT_TRUE(
      has(errorOf<GatewayError>([this] { GatewayRun gateway(settings); }), "only loopback addresses"));
}

TEST_F(GatewayPage, HttpsUsesHttp11Tls13AndReloadableCertificate) {
  settings.head_timeout = std::chrono::seconds(30);  // a handshake in an instrumented build is slow
  const std::string key = makeKeyPem();
  settings.certificate = home.path("web.pem");
  settings.key = home.path("web.key");
  std::ofstream(settings.certificate) << makeCertificatePem(key, std::chrono::system_clock::now());
  std::ofstream(settings.key) << key;
  GatewayRun gateway(settings);
  asio::io_context context;
  asio::ip::tcp::socket socket(context);
  socket.connect({asio::ip::address_v4::loopback(), gateway.port()});
  const std::unique_ptr<SSL_CTX, void (*)(SSL_CTX*)> tls(SSL_CTX_new(TLS_client_method()), SSL_CTX_free);
  static constexpr unsigned char kOffers[] = "\x02h2\x08http/1.1";
  SSL_CTX_set_alpn_protos(tls.get(), kOffers, sizeof kOffers - 1);
  const std::unique_ptr<SSL, void (*)(SSL*)> ssl(SSL_new(tls.get()), SSL_free);
  SSL_set_fd(ssl.get(), socket.native_handle());
  ASSERT_EQ(SSL_connect(ssl.get()), 1);
  EXPECT_EQ(SSL_version(ssl.get()), TLS1_3_VERSION);
  const unsigned char* chosen = nullptr;
  unsigned int size = 0;
  SSL_get0_alpn_selected(ssl.get(), &chosen, &size);
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(chosen), size), "http/1.1");
  const std::string request =
      "GET /client.wasm HTTP/1.1\r\nHost: localhost:" + std::to_string(gateway.port()) +
      "\r\nConnection: close\r\n\r\n";
  SSL_write(ssl.get(), request.data(), static_cast<int>(request.size()));
  std::string answer;
  char bytes[4096];
  for (int got = 0; (got = SSL_read(ssl.get(), bytes, sizeof bytes)) > 0;)
    answer.append(bytes, static_cast<std::size_t>(got));
  EXPECT_NE(answer.find("Strict-Transport-Security: max-age="), std::string::npos) << answer.substr(0, 1000);
  EXPECT_TRUE(answer.ends_with(wasmBytes()));
  EXPECT_FALSE(WebClient(gateway.port()).ask("/")) << "no plain HTTP on that port";
  std::ofstream(settings.key) << "damaged";
  gateway.reloadCertificate();
  EXPECT_NE(gateway.lines().back().find("cannot reload the certificate"), std::string::npos);
  std::ofstream(settings.key) << key;
  gateway.reloadCertificate();
  EXPECT_EQ(gateway.lines().back(), "certificate reloaded");
}

}  // namespace
}  // namespace naiad::test
