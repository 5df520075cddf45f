// Chat of a player that leaves and joins again.
#include <gtest/gtest.h>

#include "RawClient.h"
#include "TestClient.h"
#include "TestServer.h"

namespace naiad::test {
namespace {

using Clock = std::chrono::steady_clock;

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
