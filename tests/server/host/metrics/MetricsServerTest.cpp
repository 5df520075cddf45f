// The HTTP server for metrics, with real sockets: its answers, and the requests and connections it rejects.
#include <gtest/gtest.h>

#include <chrono>
#include <list>
#include <string>
#include <string_view>

#include "host/metrics/MetricsServer.h"
#include "shared/values/SplitMix64.h"
#include "tests/support/Text.h"
#include "tests/support/net/HttpClient.h"

namespace naiad::test {
namespace {

class MetricsServerTest : public testing::Test {
 protected:
  MetricsServer server{*MetricsAddress::parse("127.0.0.1:0"), *MetricsHosts::parse("game.internal"),
                       [](std::string_view path) -> MetricsServer::Response {
                         if (path == "/metrics") return {200, "n 1\n", "text/x-test"};
                         if (path == "/big") return {200, std::string(1 << 20, 'x')};
                         return {404, "nothing\n"};
                       }};

  HttpClient::Reply ask(const std::string& request) {
    HttpClient client(server.port());
    client.send(request);
    return client.reply();
  }
};

TEST_F(MetricsServerTest, AnswersAGet) {
  const auto reply = HttpClient::get(server.port(), "/metrics");
  EXPECT_EQ(reply.status, 200);
  EXPECT_EQ(reply.body, "n 1\n");
  EXPECT_NE(reply.head.find("Content-Type: text/x-test\r\n"), std::string::npos) << reply.head;
  EXPECT_NE(reply.head.find("Content-Length: 4\r\n"), std::string::npos) << reply.head;
  EXPECT_NE(reply.head.find("Connection: close\r\n"), std::string::npos) << reply.head;
  EXPECT_EQ(HttpClient::get(server.port(), "/metrics?a=b").body, "n 1\n");
  EXPECT_EQ(HttpClient::get(server.port(), "/metrics/").status, 404);
  EXPECT_EQ(HttpClient::get(server.port(), "/").status, 404);
}

TEST_F(MetricsServerTest, ALargeAnswerArrivesWhole) {
  EXPECT_EQ(HttpClient::get(server.port(), "/big").body.size(), std::size_t{1} << 20);
}

TEST_F(MetricsServerTest, OtherMethodsGet405WithAllowHeader) {
  for (const char* method : {"POST", "PUT", "HEAD", "DELETE", "OPTIONS", "TRACE"}) {
    const auto reply =
        ask(std::string(method) + " /metrics HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\n\r\nhello");
    EXPECT_EQ(reply.status, 405) << method;
    EXPECT_NE(reply.head.find("Allow: GET\r\n"), std::string::npos) << reply.head;
  }
  // A huge body is announced, but never read.
  EXPECT_EQ(ask("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999999999\r\n\r\n").status, 405);
}

TEST_F(MetricsServerTest, UnknownHostNameIsForbidden) {
  const auto with = [this](const std::string& lines) {
    return ask("GET /metrics HTTP/1.1\r\n" + lines + "\r\n").status;
  };
  EXPECT_EQ(with("Host: localhost\r\n"), 200);
  EXPECT_EQ(with("Host: GAME.internal:9100\r\n"), 200);
  EXPECT_EQ(with("Host: evil.example\r\n"), 403);
  EXPECT_EQ(with("Host: evil.example:" + std::to_string(server.port()) + "\r\n"), 403);
  EXPECT_EQ(with(""), 403);
  EXPECT_EQ(with("Host: localhost\r\nHost: evil.example\r\n"), 403);
}

TEST_F(MetricsServerTest, InvalidHttpIsABadRequest) {
  for (const char* request : {"hello\r\n\r\n", "GET\r\n\r\n", "GET /metrics\r\n\r\n", "\r\n\r\n\r\n",
                              "GET / HTTP/9.9\r\n\r\n", "GET /metrics HTTP/1.1\r\nHost localhost\r\n\r\n",
                              "\x16\x03\x01\x02\x05\x01\xfc\x03\x03"
                              "0123456789\r\n\r\n"}) {
    EXPECT_EQ(ask(request).status, 400) << request;
  }
}

TEST_F(MetricsServerTest, RequestHeadAboveFourKibIsABadRequest) {
  const std::string before = "GET /metrics HTTP/1.1\r\nHost: localhost\r\nX: ";
  const std::string after = "\r\n\r\n";
  const std::size_t room = MetricsServer::kMaxHead - before.size() - after.size();
  EXPECT_EQ(ask(before + std::string(room - 64, 'x') + after).status, 200);
  EXPECT_EQ(ask(before + std::string(room + 64, 'x') + after).status, 400);
  EXPECT_EQ(ask(before + std::string(100'000, 'x')).status, 400);
}

TEST_F(MetricsServerTest, RandomBytesChangeNothing) {
  SplitMix64 random(7);
  for (int i = 0; i < 200; ++i) {
    std::string bytes(random.below(300), ' ');
    for (char& c : bytes) c = static_cast<char>(random.below(256));
    HttpClient client(server.port());
    client.send(bytes);
  }
  EXPECT_EQ(HttpClient::get(server.port(), "/metrics").body, "n 1\n");
}

TEST_F(MetricsServerTest, HundredSilentConnectionsDoNotBlockScrapers) {
  std::list<HttpClient> silent;
  for (int i = 0; i < 100; ++i) silent.emplace_back(server.port()).send("GET /metrics HTTP/1.1\r\n");
  for (int i = 0; i < 10; ++i) EXPECT_EQ(HttpClient::get(server.port(), "/metrics").body, "n 1\n");
  // The oldest connections are closed long before their timeout.
  EXPECT_EQ(silent.front().readAll(), "");
  EXPECT_TRUE(silent.front().isHungUp());
}

TEST_F(MetricsServerTest, HundredUnclosedConnectionsDoNotBlockScrapers) {
  std::list<HttpClient> clients;
  for (int i = 0; i < 100; ++i) {
    clients.emplace_back(server.port()).send("GET /metrics HTTP/1.1\r\nHost: localhost\r\n\r\n");
    ASSERT_EQ(HttpClient::get(server.port(), "/metrics").body, "n 1\n") << i;
  }
}

TEST_F(MetricsServerTest, UnfinishedRequestHeadTimesOut) {
  HttpClient client(server.port());
  client.send("GET /metrics HTTP/1.1\r\nHost: localh");
  const auto began = std::chrono::steady_clock::now();
  EXPECT_EQ(client.readAll(), "");
  EXPECT_TRUE(client.isHungUp());
  EXPECT_GE(std::chrono::steady_clock::now() - began,
            MetricsServer::kRequestTimeout - std::chrono::seconds(1));
}

TEST_F(MetricsServerTest, PortInUseErrorNamesThePort) {
  const std::string taken = "127.0.0.1:" + std::to_string(server.port());
  const auto listenThere = [&taken] {
    const MetricsServer other(*MetricsAddress::parse(taken), *MetricsHosts::parse(""),
                              [](std::string_view) { return MetricsServer::Response{}; });
  };
  EXPECT_TRUE(has(errorOf<MetricsError>(listenThere), std::to_string(server.port())));
}

}  // namespace
}  // namespace naiad::test
