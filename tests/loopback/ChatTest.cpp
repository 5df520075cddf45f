// Chat floods, and receivers of chat that are slow or disconnected. No other player loses the session.
#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>

#include "BusyWorld.h"
#include "Home.h"
#include "RawClient.h"
#include "StreamProxy.h"
#include "TestServer.h"
#include "Valve.h"

namespace naiad::test {
namespace {

using Clock = std::chrono::steady_clock;

/// Sends as much chat as possible, and reconnects with its token as often as possible to send more.
class Chatterer {
 public:
  explicit Chatterer(std::uint16_t port) : m_port(port), m_thread([this] { run(); }) {}
  ~Chatterer() { stop(); }
  void stop() {
    m_stopping = true;
    if (m_thread.joinable()) m_thread.join();
  }
  int attempts() const { return m_attempts; }
  int joins() const { return m_joins; }

 private:
  void run() {
    std::string wide;
    for (int i = 0; i < 200; ++i) wide += "\u2588";  // three bytes each
    std::uint32_t number = 0;
    while (!m_stopping) {
      ++m_attempts;
      RawClient client(m_port, RawClient::Line::kTls);
      wire::ClientMessage hello = RawClient::hello("chatter");
      hello.mutable_hello()->set_resume_token(m_token);
      client.send(hello);
      const auto answer = client.receive();
      if (!answer || !answer->has_welcome()) continue;
      m_joins += answer->welcome().resumed() ? 0 : 1;
      m_token = answer->welcome().resume_token();
      wire::ClientMessage line;
      line.mutable_chat()->set_text(wide);
      for (int i = 0; i < 50; ++i) {
        line.set_number(++number);
        client.send(line);
      }
      client.finish();
    }
  }

  std::uint16_t m_port;
  std::atomic<int> m_attempts = 0;
  std::atomic<int> m_joins = 0;
  std::atomic<bool> m_stopping = false;
  std::string m_token;
  std::thread m_thread;
};

TEST(Chat, ChatFloodThroughResumesIsLimitedWithoutDisconnects) {
  Home home;
  Census census;
  TestServer server(busyWorld(20, &census), home.server());
  asio::io_context context;
  StreamProxy far_line(context, server.port());
  StreamProxy broken_line(context, server.port());
  const auto no_datagrams = std::make_shared<Valve>();
  no_datagrams->up = no_datagrams->down = false;
  const auto setup = [&](const std::string& name) {
    ClientSetup made = home.player(name);
    made.options.open_socket = through(context, no_datagrams);
    return made;
  };
  far_line.setDelay(std::chrono::milliseconds(100));
  TestClient far(context, far_line.port(), setup("far"));
  TestClient away(context, broken_line.port(), setup("away"));
  ASSERT_TRUE(serveUntil(context, {&far, &away}, [&] { return far.joined() && away.joined(); }));
  const std::uint32_t id = away.player();
  broken_line.setOpen(false);
  broken_line.cut();
  ASSERT_TRUE(serveUntil(context, {&far, &away}, [&] { return server.counters().detached == 1; }));

  const auto began = Clock::now();
  Chatterer chatterer(server.port());
  ASSERT_TRUE(serveUntil(context, {&far, &away}, [&] {
    return chatterer.attempts() >= 100 && far.session().counters().chat_lines >= 12;
  }));
  chatterer.stop();
  const auto seconds = std::chrono::duration<double>(Clock::now() - began).count();
  broken_line.setOpen(true);
  ASSERT_TRUE(serveUntil(context, {&far, &away}, [&] {
    return away.joined() && !away.session().isDetached() &&
           away.session().counters().chat_lines == far.session().counters().chat_lines;
  }));
  EXPECT_EQ(away.player(), id) << "the same session";
  EXPECT_TRUE(far.joined());
  EXPECT_LE(static_cast<double>(far.session().counters().chat_lines), 3 + 3 * seconds);
  const Counters counters = server.counters();
  EXPECT_GT(counters.resumes_deferred, 20u);
  EXPECT_LE(static_cast<double>(counters.resumed), 3 + seconds + 1) << "one of these was away's";
  EXPECT_EQ(chatterer.joins(), 1) << "it went on with the session that it had";
  EXPECT_EQ(census.joins, 3);
  EXPECT_EQ(census.leaves, 0);
}

TEST(Chat, RejoiningDoesNotRaiseTheChatLimitPerAddress) {
  constexpr std::uint64_t kVisits = 200;
  TestServer server([](df::World&) {});
  asio::io_context context;
  TestClient ann(context, server.port(), insecurely("ann"));
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return ann.joined(); }));
  const auto began = Clock::now();
  std::uint64_t joins = 0;
  for (std::uint64_t i = 0; i < kVisits; ++i) {
    ann.connection().update(Clock::now());
    context.restart();
    context.poll();
    RawClient client(server.port());
    client.send(RawClient::hello("revenant"));
    const auto answer = client.receive();
    if (!answer || !answer->has_welcome()) continue;
    ++joins;
    wire::ClientMessage line, leave;
    line.mutable_chat()->set_text("again");
    for (std::uint32_t number = 1; number <= 3; ++number) {  // as many as a new player may send
      line.set_number(number);
      client.send(line);
    }
    leave.mutable_leave();
    client.send(leave);
    client.waitForHangup();
  }
  const auto seconds = std::chrono::duration<double>(Clock::now() - began).count();
  const Counters counters = server.counters();
  EXPECT_LE(static_cast<double>(joins), 128 + 2 * seconds);
  EXPECT_EQ(counters.refused_busy, kVisits - joins);
  const std::uint64_t lines = 3 * joins - counters.chat_dropped;
  EXPECT_LE(static_cast<double>(lines), 192 + 16 * seconds);
  EXPECT_GE(lines, 192u);
  EXPECT_TRUE(serveUntil(context, {&ann}, [&] { return ann.session().counters().chat_lines >= lines; }));
  EXPECT_EQ(ann.session().counters().chat_lines, lines) << "what she heard";
}

}  // namespace
}  // namespace naiad::test
