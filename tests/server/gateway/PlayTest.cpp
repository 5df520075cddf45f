// The gateway's handling of WebSockets, and browsers that play on a real dfserver through it.
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <asio/local/stream_protocol.hpp>
#include <atomic>
#include <thread>

#include "FakeGame.h"
#include "WebClient.h"
#include "shared/net/base/Limits.h"
#include "shared/net/stream/Fingerprint.h"
#include "shared/program/ProcessSetup.h"
#include "tests/loopback/BusyWorld.h"
#include "tests/loopback/TestServer.h"
#include "tests/support/Text.h"

namespace naiad::test {
namespace {

class GatewayPlay : public GatewayFixture {
 protected:
  static bool echoes(WebClient& browser, const std::string& text) {
    browser.sendFrame(2, text);
    const auto answer = browser.frame();
    return answer && answer->opcode == 2 && answer->payload == text;
  }
  /// Opens a WebSocket, calls `send`, and returns the close code. `plays`: first sends a hello and waits for
  /// its echo.
  static int codeAfter(std::uint16_t port, bool plays, const std::function<void(WebClient&)>& send) {
    WebClient browser(port);
    if (!browser.play() || (plays && !echoes(browser, "hello"))) return -2;
    send(browser);
    return browser.waitForClose();
  }
  int statusOf(std::uint16_t port, const std::string& changes) {
    WebClient browser(port);
    browser.requestPlay(changes);
    const auto reply = browser.reply();
    return reply ? reply->status : 0;
  }
  static void ignore(ReliableChannel&, const std::string&) {}
};

TEST_F(GatewayPlay, EachWebSocketMessageIsOneFrame) {
  start();
  WebClient browser(gateway->port());
  ASSERT_TRUE(browser.play());
  for (const std::size_t size : {1u, 125u, 126u, 1024u})
    EXPECT_TRUE(echoes(browser, std::string(size, 'a'))) << size;
  EXPECT_TRUE(echoes(browser, std::string(kMaxClientFrame, 'b'))) << "after the first one";
  game->broadcast(std::string(kMaxServerFrame, 'c'));
  game->broadcast("d");
  EXPECT_EQ(browser.frame()->payload, std::string(kMaxServerFrame, 'c'));
  EXPECT_EQ(browser.frame()->payload, "d");
  browser.sendFrame(2, "in ", false);
  browser.sendFrame(0, "three", false);
  browser.sendFrame(9, "ping");
  browser.sendFrame(0, " parts");
  EXPECT_EQ(browser.frame()->opcode, 10);
  EXPECT_EQ(browser.frame()->payload, "in three parts");
}

TEST_F(GatewayPlay, InvalidMessagesCloseWithTheMatchingCode) {
  start();
  const std::uint16_t port = gateway->port();
  const std::string large(kMaxClientFrame + 1, 'x');
  const std::string large_hello(kMaxHelloFrame + 1, 'x');
  EXPECT_EQ(codeAfter(port, false, [](WebClient& b) { b.sendFrame(1, "text"); }), 1003);
  EXPECT_EQ(codeAfter(port, false, [&](WebClient& b) { b.sendFrame(2, large_hello); }), 1009);
  EXPECT_EQ(codeAfter(port, false, [](WebClient& b) { b.sendFrame(2, ""); }), 1008);
  EXPECT_EQ(game->handshakes(), 0u) << "the game heard of none of them";
  EXPECT_EQ(codeAfter(port, true, [&](WebClient& b) { b.sendFrame(2, large); }), 1009);
  EXPECT_EQ(codeAfter(port, true, [&](WebClient& b) { b.sendFrame(2, std::string(1 << 20, 'x')); }), 1009);
  EXPECT_EQ(codeAfter(port, true, [](WebClient& b) { b.sendFrame(2, "x", true, false); }), 1002)
      << "unmasked";
  EXPECT_EQ(codeAfter(port, true, [](WebClient& b) { b.sendFrame(3, "x"); }), 1002) << "reserved";
  EXPECT_EQ(codeAfter(port, true, [](WebClient& b) { b.sendFrame(0, "x"); }), 1002) << "goes on with nothing";
  EXPECT_EQ(codeAfter(port, true, [](WebClient& b) { b.sendFrame(9, std::string(126, 'x')); }), 1002);
  EXPECT_EQ(codeAfter(port, true,
                      [&](WebClient& b) {
                        b.sendFrame(2, "x", false);
                        for (int i = 0; i < 100; ++i) b.sendFrame(0, std::string(100, 'x'), false);
                      }),
            1009);
  const std::string huge = std::string("\x82\xff\x7f\xff\xff\xff\xff\xff\xff\xff", 10) + "mask";
  const int code = codeAfter(port, true, [&](WebClient& b) { b.send(huge); });
  EXPECT_TRUE(code == 1009 || code == 1002) << code;
  for (const std::string& frame : game->frames()) EXPECT_EQ(frame, "hello") << "nothing of all that";
}

TEST_F(GatewayPlay, WebSocketIsOpenedOnlyFromAllowedOrigins) {
  start({}, [](GatewaySettings& settings) {
    settings.origins.push_back(*WebOrigin::parse("https://play.example"));
  });
  const std::uint16_t port = gateway->port();
  EXPECT_EQ(statusOf(port, "Origin: https://play.example\r\nHost: play.example\r\n"), 101);
  EXPECT_EQ(statusOf(port, "Origin: https://evil.example\r\n"), 403);
  EXPECT_EQ(statusOf(port, "Origin: null\r\n"), 403);
  EXPECT_EQ(statusOf(port, "Origin: http://play.example\r\n"), 403);
  EXPECT_EQ(statusOf(port, "Origin: https://play.example.evil.example\r\n"), 403);
  EXPECT_EQ(statusOf(port, "Host: evil.example\r\n"), 421) << "whatever leads that name to this machine";
  EXPECT_EQ(statusOf(port, "Sec-WebSocket-Protocol: chat\r\n"), 400);
  EXPECT_EQ(statusOf(port, "Sec-WebSocket-Version: 8\r\n"), 426);
  WebClient elsewhere(port);
  elsewhere.send("GET /server HTTP/1.1\r\nHost: localhost:" + std::to_string(port) +
                 "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nOrigin: https://play.example\r\n\r\n");
  EXPECT_EQ(elsewhere.reply()->status, 404);
  EXPECT_EQ(game->visitors().size(), 0u);
  bool quoted = false;
  for (const std::string& line : gateway->lines())
    quoted = quoted || line.find("https://evil.example") != line.npos;
  EXPECT_TRUE(quoted);
}

TEST_F(GatewayPlay, ClientAddressComesFromTheSocketNotTheHeaders) {
  start();
  WebClient browser(gateway->port(), "127.0.0.7");
  browser.requestPlay(
      "X-Forwarded-For: 192.0.2.9\r\nForwarded: for=192.0.2.9\r\nX-Real-IP: 192.0.2.9\r\nTrue-Client-IP: "
      "192.0.2.9\r\n");
  ASSERT_EQ(browser.reply(false)->status, 101);
  ASSERT_TRUE(echoes(browser, "hello"));
  ASSERT_EQ(game->visitors().size(), 1u);
  EXPECT_TRUE(game->visitors()[0].starts_with("127.0.0.7:")) << game->visitors()[0];
  WebClient liar(gateway->port());
  liar.send("PROXY TCP4 192.0.2.9 192.0.2.1 4000 80\r\nGET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_GE(liar.reply()->status, 400);
  WebClient second(gateway->port());
  second.send(std::string("\r\n\r\n\0\r\nQUIT\n\x21\x11\0\x0c", 16) + "aaaabbbbccdd");
  EXPECT_TRUE(second.waitForHangup());
  EXPECT_EQ(game->visitors().size(), 1u);
}

TEST_F(GatewayPlay, ServerWithAWrongKeyReceivesNothing) {
  FakeGame impostor(home.path("other"), home.path("visitors"));
  const auto real = ServerIdentity::loadOrMake(home.path("identity"), std::chrono::system_clock::now());
  gateway = std::make_unique<GatewayRun>(home.settings(ShortKey::of(real.fingerprint())));
  WebClient browser(gateway->port());
  ASSERT_TRUE(browser.play());
  browser.sendMessage(RawClient::hello("ann"));
  EXPECT_EQ(browser.waitForClose(), 4001);
  EXPECT_TRUE(waitUntil([&] { return impostor.handshakes() == 1 && impostor.connections() == 0; }))
      << "it was connected, and hung up on";
  EXPECT_TRUE(impostor.frames().empty());
  EXPECT_EQ(gateway->counters().wrong_keys, 1u);
}

TEST_F(GatewayPlay, GatewayRetriesWhenTheServerDropsConnections) {
  start();
  game->hangUpOn(3);
  WebClient browser(gateway->port());
  ASSERT_TRUE(browser.play());
  EXPECT_TRUE(echoes(browser, "hello"));
  EXPECT_EQ(game->visitors().size(), 4u);
  EXPECT_EQ(gateway->counters().unreachable, 0u);
}

TEST_F(GatewayPlay, CloseCodeTellsHowTheServerEnded) {
  start({}, [](GatewaySettings& settings) { settings.connect_timeout = std::chrono::seconds(2); });
  WebClient before(gateway->port());
  ASSERT_TRUE(before.play() && echoes(before, "hello"));
  game->endAll(false);
  EXPECT_EQ(before.waitForClose(), 4000) << "it broke off";
  WebClient ended(gateway->port());
  ASSERT_TRUE(ended.play() && echoes(ended, "hello"));
  game->broadcast("goodbye");
  game->endAll(true);
  EXPECT_EQ(ended.frame()->payload, "goodbye");
  EXPECT_EQ(ended.waitForClose(), 1000);
  game.reset();
  const auto hello = [](WebClient& b) { b.sendFrame(2, "hello"); };
  EXPECT_EQ(codeAfter(gateway->port(), false, hello), 4000) << "there is none";
  EXPECT_EQ(WebClient(gateway->port()).ask("/")->status, 200);
}

TEST_F(GatewayPlay, BannedVisitorReadsThatTheyMayBeBanned) {
  start();
  game.reset();
  asio::io_context context;
  asio::local::stream_protocol::acceptor none(
      context, asio::local::stream_protocol::endpoint(home.path("visitors").string()));
  std::atomic<bool> over = false;
  std::thread rude([&] {
    while (!over) none.accept();  // accepts and closes the connections
  });
  WebClient dropped(gateway->port());
  ASSERT_TRUE(dropped.play());
  dropped.sendFrame(2, "hello");
  const auto close = dropped.frame();
  ASSERT_TRUE(close && close->opcode == 8);
  EXPECT_EQ(close->closeCode(), 4000);
  EXPECT_TRUE(has(close->payload, "your address may be banned, or no Naiad server runs there."));
  over = true;
  asio::local::stream_protocol::socket(context).connect(none.local_endpoint());
  rude.join();
}

TEST_F(GatewayPlay, ASilentServerIsGivenUp) {
  asio::io_context context;
  asio::local::stream_protocol::acceptor silent(
      context, asio::local::stream_protocol::endpoint(home.path("visitors").string()));
  auto settings = home.settings(*ShortKey::parse("aaaaaaaaaaaaaaaaaaaaaaaaaa"));
  settings.connect_timeout = std::chrono::milliseconds(200);
  gateway = std::make_unique<GatewayRun>(settings);
  EXPECT_EQ(codeAfter(gateway->port(), false, [](WebClient& b) { b.sendFrame(2, "hello"); }), 4000);
}

TEST_F(GatewayPlay, WhenTheGatewayEndsPlayersAreTold) {
  start();
  WebClient ann(gateway->port());
  WebClient waiting(gateway->port());
  ASSERT_TRUE(ann.play() && echoes(ann, "hello"));
  ASSERT_TRUE(waiting.play());
  gateway->stop();
  EXPECT_EQ(ann.waitForClose(), 1001);
  EXPECT_EQ(waiting.waitForClose(), 1001);
  gateway->join();
  EXPECT_TRUE(waitUntil([&] { return game->connections() == 0; }));
}

TEST_F(GatewayPlay, AWebSocketWithoutAHelloEnds) {
  start({}, [](GatewaySettings& settings) { settings.hello_timeout = std::chrono::milliseconds(200); });
  EXPECT_EQ(codeAfter(gateway->port(), false, [](WebClient&) {}), 1008);
  EXPECT_EQ(game->handshakes(), 0u);
}

TEST_F(GatewayPlay, SilentBrowserIsPingedAndDeadOneIsDisconnected) {
  start({}, [](GatewaySettings& settings) { settings.ping_interval = std::chrono::milliseconds(200); });
  WebClient alive(gateway->port());
  WebClient dead(gateway->port());
  ASSERT_TRUE(alive.play() && echoes(alive, "hello"));
  ASSERT_TRUE(dead.play() && echoes(dead, "hello"));
  for (int i = 0; i < 5; ++i) {
    const auto ping = alive.frame();
    ASSERT_TRUE(ping);
    ASSERT_EQ(ping->opcode, 9);
    alive.sendFrame(10, ping->payload);
  }
  EXPECT_TRUE(dead.waitForHangup());
  EXPECT_EQ(gateway->counters().ping_timeouts, 1u);
  EXPECT_TRUE(echoes(alive, "still there"));
}

TEST_F(GatewayPlay, PingFloodDisconnectsTheBrowser) {
  start();
  WebClient ann(gateway->port());
  WebClient flood(gateway->port());
  ASSERT_TRUE(ann.play() && echoes(ann, "hello"));
  ASSERT_TRUE(flood.play() && echoes(flood, "hello"));
  for (int i = 0; i < 100; ++i) flood.sendFrame(9, "ping");
  EXPECT_TRUE(flood.waitForHangup());
  EXPECT_EQ(gateway->counters().control_floods, 1u);
  EXPECT_TRUE(echoes(ann, "still there"));
}

TEST_F(GatewayPlay, PlacesAreLimitedForOneAddressAndInAll) {
  start({}, [](GatewaySettings& settings) {
    settings.max_visitors = 2;
    settings.max_per_address = 1;
  });
  const auto enter = [](WebClient& browser) {
    if (!browser.play()) return -2;
    browser.sendFrame(2, "hello");
    const auto answer = browser.frame();
    return !answer ? -1 : answer->opcode == 8 ? answer->closeCode() : 0;
  };
  auto first = std::make_unique<WebClient>(gateway->port(), "127.0.0.2");
  WebClient second(gateway->port(), "127.0.0.2");
  WebClient third(gateway->port(), "127.0.0.2");
  EXPECT_EQ(enter(*first), 0);
  EXPECT_EQ(enter(second), 0) << "a player's second stream";
  EXPECT_EQ(enter(third), 4003);
  WebClient other(gateway->port(), "127.0.0.3");
  WebClient others_second(gateway->port(), "127.0.0.3");
  EXPECT_EQ(enter(other), 0);
  EXPECT_EQ(enter(others_second), 0);
  WebClient late(gateway->port(), "127.0.0.4");
  EXPECT_EQ(enter(late), 4003);
  first.reset();
  EXPECT_TRUE(waitUntil([&] {
    WebClient again(gateway->port(), "127.0.0.4");
    return enter(again) == 0;
  })) << "a place that was given back";
}

TEST_F(GatewayPlay, ThousandHalfOpenConnectionsDoNotBlockNewPlayers) {
  constexpr int kStrangers = 1200;
  if (raiseOpenFileLimit(3 * kStrangers) < 3 * kStrangers) GTEST_SKIP() << "too few open files are allowed";
  start();
  WebClient ann(gateway->port(), "127.0.9.1");
  ASSERT_TRUE(ann.play() && echoes(ann, "hello"));
  std::vector<std::unique_ptr<WebClient>> strangers;
  for (int i = 0; i < kStrangers; ++i) {
    strangers.push_back(
        std::make_unique<WebClient>(gateway->port(), "127.0.0." + std::to_string(1 + i % 200)));
    if (i % 3 == 1) strangers.back()->send("GET / HTTP/1.1\r\nHost: ");
    if (i % 3 == 2) strangers.back()->requestPlay();
    if (i % 100 == 0) {
      EXPECT_TRUE(echoes(ann, "move " + std::to_string(i)));
    }
  }
  EXPECT_TRUE(waitUntil([&] { return gateway->counters().connections > kStrangers; }));
  EXPECT_LE(gateway->connections(), home.settings(game->key()).max_pending + 1);
  WebClient bob(gateway->port(), "127.0.8.1");
  EXPECT_EQ(bob.ask("/")->status, 200);
  WebClient bobs_game(gateway->port(), "127.0.8.1");
  EXPECT_TRUE(bobs_game.play() && echoes(bobs_game, "hello"));
  EXPECT_TRUE(echoes(ann, "still there"));
  EXPECT_EQ(game->visitors().size(), 2u) << "the game heard of none of them";
}

TEST_F(GatewayPlay, PendingMessagesAreSentInOneWrite) {
  start(ignore);
  WebClient browser(gateway->port());
  ASSERT_TRUE(browser.play());
  browser.sendFrame(2, "hello");
  ASSERT_TRUE(waitUntil([&] { return game->frameCount() == 1; }));
  const GatewayCounters before = gateway->counters();
  std::vector<std::string> messages;
  std::string bytes;
  for (int i = 0; i < 10; ++i) {
    messages.push_back(std::string(static_cast<std::size_t>(20 * i + 1), static_cast<char>('a' + i)));
    bytes += WebClient::frameBytes(2, messages.back());
  }
  browser.send(bytes);
  ASSERT_TRUE(waitUntil([&] { return game->frameCount() == 11; }));
  game->broadcast(messages);
  for (const std::string& message : messages) EXPECT_EQ(browser.frame()->payload, message);
  const auto frames = game->frames();
  EXPECT_TRUE(std::equal(messages.begin(), messages.end(), frames.begin() + 1));
  const GatewayCounters after = gateway->counters();
  EXPECT_EQ(after.messages_up - before.messages_up, 10u);
  EXPECT_EQ(after.messages_down - before.messages_down, 10u);
  EXPECT_EQ(after.writes_up - before.writes_up, 1u);
  EXPECT_EQ(after.writes_down - before.writes_down, 1u);
}

// At most 12,800 bytes may be in flight, which take 400 ms at 256 kbit/s, whatever the game sends.
TEST_F(GatewayPlay, SlowLineGetsFreshPicturesWithoutABacklog) {
  constexpr std::size_t kPicture = 2000;
  constexpr std::size_t kLine = 32'000;  // bytes per second
  constexpr std::size_t kMaxUnderWay = kLine * 4 / 10;
  const auto sent =
      std::make_shared<std::atomic<std::size_t>>(0);  // a shared pointer, because the game outlives the test
  start(ignore);
  WebClient slow(gateway->port(), "127.0.0.1", 2048);
  ASSERT_TRUE(slow.play());
  slow.sendFrame(2, "hello");
  // Like dfserver, skips a picture while the last one is unsent, instead of queueing it.
  game->every(std::chrono::milliseconds(33), [sent](ReliableChannel& channel) {
    if (channel.unsentBytes() > 0) return;
    *sent += kPicture;
    channel.send(std::string(kPicture, 'p'));
  });
  std::size_t received = 0;
  std::size_t worst = 0;
  const auto begin = std::chrono::steady_clock::now();
  while (received < 5 * kLine) {
    const auto time = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    ASSERT_LT(time, 60);
    const auto allowed = static_cast<std::size_t>(time * kLine);
    if (allowed > received) slow.takeSome(std::min<std::size_t>(allowed - received, 640));
    while (const auto frame = slow.takeFrame()) {
      received += frame->payload.size();
      if (received > kLine) worst = std::max(worst, *sent - received);  // not before the line is busy
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));  // the speed of the line
  }
  EXPECT_LE(worst, kMaxUnderWay);
  EXPECT_EQ(gateway->counters().stalled, 0u);
  RecordProperty("bytes_under_way", std::to_string(worst));
}

TEST_F(GatewayPlay, BrowserThatReadsNothingIsDisconnected) {
  start(ignore, [](GatewaySettings& settings) { settings.stall_timeout = std::chrono::milliseconds(300); });
  WebClient stuck(gateway->port(), "127.0.0.1", 2048);
  ASSERT_TRUE(stuck.play());
  stuck.sendFrame(2, "hello");
  game->every(std::chrono::milliseconds(5), [](ReliableChannel& channel) {
    if (channel.unsentBytes() == 0) channel.send(std::string(10'000, 'p'));
  });
  EXPECT_TRUE(waitUntil([&] { return gateway->counters().stalled == 1; }));
  EXPECT_TRUE(waitUntil([&] { return gateway->connections() == 0; })) << "though it never answers the close";
}

TEST_F(GatewayPlay, GatewayStopsReadingWhileTheServerIsSlow) {
  std::promise<void> go_on;
  const auto waited = go_on.get_future().share();
  start([waited](ReliableChannel&, const std::string&) { waited.wait(); });
  WebClient browser(gateway->port());
  ASSERT_TRUE(browser.play());
  browser.sendFrame(2, "hello");
  std::thread sender([&browser] {
    for (int i = 0; i < 5000; ++i)
      browser.sendFrame(2, std::string(kMaxClientFrame, static_cast<char>('a' + i % 26)));
  });
  // Waits until the count is equal before and after many turns of the loop.
  std::uint64_t before = 0;
  EXPECT_TRUE(waitUntil([&] {
    const std::uint64_t now = gateway->counters().messages_up;
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    return now > 1 && std::exchange(before, now) == now;
  }));
  EXPECT_LT(before, 2000u) << "of 5000: the rest waits at the browser";
  go_on.set_value();
  sender.join();
  EXPECT_TRUE(waitUntil([&] { return game->frameCount() == 5001; }));
  const auto frames = game->frames();
  for (std::size_t i = 1; i < frames.size(); ++i)
    ASSERT_EQ(frames[i], std::string(kMaxClientFrame, static_cast<char>('a' + (i - 1) % 26))) << i;
}

class GatewayServer : public testing::Test {
 protected:
  HostOptions optionsOf() const {
    HostOptions options = fastOptions();
    options.insecure = false;
    options.identity = home.path("identity");
    options.visitors = home.path("visitors");
    options.grace = 60;
    return options;
  }

  GatewayHome home;
  TestServer server{[](df::World& world) { populateBusyWorld(world, 5); }, optionsOf()};
  GatewayRun gateway{home.settings(ShortKey::of(*server.fingerprint()))};
};

TEST_F(GatewayServer, BrowsersPlayAndSeeTheWorld) {
  WebClient ann(gateway.port());
  WebClient bob(gateway.port());
  ASSERT_TRUE(ann.join("ann"));
  ASSERT_TRUE(bob.join("bob"));
  wire::ClientMessage chat;
  chat.mutable_chat()->set_text("hello from a browser");
  chat.set_number(1);
  ann.sendMessage(chat);
  bool heard = false;
  bool seen = false;
  while (!heard || !seen) {
    const auto message = bob.message();
    ASSERT_TRUE(message);
    heard = heard || (message->has_chat() && message->chat().text() == "hello from a browser");
    seen = seen || message->has_snapshot();
  }
  server.stop("The test is over.");
  EXPECT_EQ(ann.waitForClose(), 1000) << "it said goodbye";
}

TEST_F(GatewayServer, ASecondWebSocketIsASecondStream) {
  WebClient first(gateway.port());
  ASSERT_TRUE(first.play());
  first.sendMessage(RawClient::hello("ann"));
  const auto welcome = first.message();
  ASSERT_TRUE(welcome && welcome->has_welcome());
  EXPECT_TRUE(welcome->welcome().second_stream());
  WebClient second(gateway.port());
  ASSERT_TRUE(second.play());
  auto hello = RawClient::hello("ann");
  hello.mutable_hello()->set_resume_token(welcome->welcome().resume_token());
  hello.mutable_hello()->set_second_stream(true);
  second.sendMessage(hello);
  const auto again = second.message();
  ASSERT_TRUE(again && again->has_welcome());
  EXPECT_EQ(again->welcome().player(), welcome->welcome().player());
  EXPECT_EQ(server.counters().joined, 1u);
  EXPECT_EQ(gateway.counters().played, 2u);
}

}  // namespace
}  // namespace naiad::test
