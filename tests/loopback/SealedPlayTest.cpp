// Encrypted play: a stream in TLS and sealed datagrams. Also covers networks that block datagrams.
#include <gtest/gtest.h>

#include "Compare.h"
#include "LoopbackFixture.h"
#include "StreamProxy.h"

namespace naiad::test {
namespace {

class SealedPlay : public LoopbackFixture {
 protected:
  static std::uint64_t datagrams(TestClient& client) { return client.session().counters().datagrams_in; }
  /// Returns the number of snapshots received on the stream.
  static std::uint64_t streamed(TestClient& client) {
    const SessionCounters& counters = client.session().counters();
    return counters.snapshots + counters.stale_snapshots - counters.datagrams_in;
  }
};

TEST_F(SealedPlay, PicturesEqualTheTruthOverDatagrams) {
  TestServer server(busyWorld(200), home.server());
  TestClient ann(context, server.port(), home.player("ann"));
  ASSERT_TRUE(settles(ann));
  // Datagrams may overtake a snapshot on the stream, which may change pictures recorded before. Forgets
  // those.
  std::uint64_t on_stream = streamed(ann);
  ann.forgetPictures();
  std::uint32_t pressed = 0;
  ASSERT_TRUE(serve(ann, [&] {
    if (streamed(ann) != on_stream) ann.forgetPictures();
    on_stream = streamed(ann);
    if (ann.newestTick() > pressed + 10) {
      pressed = ann.newestTick();
      ann.session().sendKey(df::Keyboard::LEFTARROW, df::KEY_PRESSED, Clock::now());
    }
    return ann.pictures().size() >= 500;
  }));
  expectSame(ann, server, 500);
  EXPECT_TRUE(isOnDatagrams(ann));
  // The connection seems full on a very busy machine, and then the server skips ticks.
  EXPECT_GT(datagrams(ann) + server.skippedTicks(ann.player()), 400u);
  EXPECT_EQ(server.counters().divergences, 0u);
}

TEST_F(SealedPlay, WithDatagramsBlockedASecondStreamIsOpened) {
  valve->up = valve->down = false;
  TestServer server(busyWorld(50), home.server());
  TestClient ann(context, server.port(), playerWithValve("ann"));
  ASSERT_TRUE(joins(ann));
  EXPECT_FALSE(ann.session().hasSecondStream()) << "it may be that datagrams will pass in a moment";
  const auto has_second = [&] { return ann.session().hasSecondStream(); };
  ASSERT_TRUE(serve(ann, has_second));
  EXPECT_EQ(server.counters().second_streams, 1u);
  EXPECT_EQ(server.counters().joined, 1u);
  ann.forgetPictures();
  EXPECT_TRUE(keyWorks(ann));
  EXPECT_TRUE(hears(ann, 400));
  expectSame(ann, server, 200);
  EXPECT_TRUE(ann.session().hasSecondStream());
  EXPECT_EQ(server.counters().divergences, 0u);
  EXPECT_EQ(server.counters().resets, 0u);

  valve->up = valve->down = true;
  const auto returns = [&] { return isOnDatagrams(ann) && !ann.session().hasSecondStream(); };
  ASSERT_TRUE(serve(ann, returns)) << "it is not needed any more";
  EXPECT_TRUE(keyWorks(ann));
}

TEST_F(SealedPlay, ReconnectedClientReopensTheSecondStream) {
  valve->up = valve->down = false;
  TestServer server(busyWorld(50), home.server());
  StreamProxy proxy(context, server.port());
  ClientSetup setup = playerWithValve("ann");
  setup.rejoin = true;
  TestClient ann(context, proxy.port(), setup);
  const auto has_second = [&](std::uint64_t times) {
    return serve(ann, [&] {
      return ann.joined() && ann.session().hasSecondStream() && server.counters().second_streams == times;
    });
  };
  ASSERT_TRUE(joins(ann) && has_second(1));
  const std::uint32_t id = ann.player();
  proxy.cut();
  ASSERT_TRUE(serve(ann, [&] { return server.counters().resumed == 1; }));
  ASSERT_TRUE(has_second(2));
  EXPECT_EQ(ann.player(), id);
  EXPECT_TRUE(keyWorks(ann));
  EXPECT_EQ(server.counters().joined, 1u);
  EXPECT_EQ(server.counters().divergences, 0u);
}

TEST_F(SealedPlay, StalledStreamDoesNotBlockTheGame) {
  valve->up = valve->down = false;
  TestServer server(busyWorld(50), home.server());
  StreamProxy proxy(context, server.port());
  TestClient ann(context, proxy.port(), playerWithValve("ann"));
  ASSERT_TRUE(joins(ann));
  ASSERT_TRUE(serve(ann, [&] { return ann.session().hasSecondStream(); }));
  ann.forgetPictures();
  ann.keepWholePictures();  // a snapshot is lost if it was sent only on the stalled stream, because the other
                            // one was full
  proxy.stallOldest();
  EXPECT_TRUE(hears(ann, 200));
  expectSame(ann, server, 100);
  EXPECT_EQ(server.counters().repeated_inputs, 0u);
  ann.session().sendKey(df::Keyboard::RIGHTARROW, df::KEY_PRESSED, Clock::now());
  const auto taken = [&] { return ann.session().replica().newest().input != 0; };
  EXPECT_TRUE(serve(ann, taken)) << "the key goes that way, too";
  EXPECT_EQ(server.counters().detached, 0u);
}

TEST_F(SealedPlay, FallsBackWithinTwoSecondsAndReturns) {
  for (const auto& [up, down] : {std::pair{false, false}, {false, true}, {true, false}}) {
    valve = std::make_shared<Valve>();
    valve->up = up;
    valve->down = down;
    TestServer server(busyWorld(50), home.server());
    TestClient ann(context, server.port(), playerWithValve("ann"));
    const auto returns = [&] {
      valve->up = valve->down = true;
      return serve(ann, [&, before = datagrams(ann)] {
        return isOnDatagrams(ann) && !ann.session().hasSecondStream() && datagrams(ann) > before + 100;
      });
    };
    ASSERT_TRUE(joins(ann)) << up << down;
    EXPECT_TRUE(keyWorks(ann)) << up << down;
    EXPECT_TRUE(hears(ann, 400));
    EXPECT_EQ(datagrams(ann), 0u) << up << down;
    expectSame(ann, server, 200);
    ASSERT_TRUE(returns()) << up << down;

    const std::uint64_t on_stream = streamed(ann);
    valve->up = up;
    valve->down = down;
    const auto blocked = timeUntil(context, {&ann}, [&] { return streamed(ann) > on_stream + 5; });
    ASSERT_TRUE(blocked) << up << down;
    EXPECT_LT(*blocked, kSlowness * std::chrono::seconds(2)) << up << down;
    EXPECT_TRUE(keyWorks(ann)) << up << down;
    ASSERT_TRUE(returns()) << up << down;
    EXPECT_TRUE(keyWorks(ann));
    EXPECT_EQ(server.counters().divergences, 0u);
    EXPECT_EQ(server.counters().detached, 0u);
  }
}

TEST_F(SealedPlay, ExhaustedKeysMoveTheSessionToANewStream) {
  TestServer server(busyWorld(50), home.server());
  ClientSetup setup = playerWithValve("ann");
  setup.options.seal_limits.new_epoch_after = 300;
  TestClient ann(context, server.port(), setup);
  ASSERT_TRUE(settles(ann));
  for (std::uint64_t times = 1; times <= 3; ++times) {
    ASSERT_TRUE(serve(ann, [&] { return server.counters().resumed >= times; }));
    const std::uint64_t before = datagrams(ann);
    ASSERT_TRUE(serve(ann, [&] { return datagrams(ann) > before + 50; }));
    EXPECT_TRUE(keyWorks(ann));
  }
  const Counters counters = server.counters();
  EXPECT_LE(counters.resumed, datagrams(ann) / 300 + 1) << "once for each epoch";
  EXPECT_EQ(counters.detached, counters.resumed);
  EXPECT_EQ(counters.joined, 1u);
  EXPECT_EQ(counters.divergences, 0u);
  EXPECT_EQ(counters.malformed_messages, 0u);
}

TEST_F(SealedPlay, PortChangeIsFollowedWithinASecond) {
  TestServer server(busyWorld(50), home.server());
  TestClient ann(context, server.port(), playerWithValve("ann"));
  ASSERT_TRUE(settles(ann));
  for (int i = 0; i < 3; ++i) {
    const std::uint16_t port = valve->p_socket->localEndpoint().port;
    valve->rebind();
    ASSERT_NE(valve->p_socket->localEndpoint().port, port);
    const std::uint64_t before = datagrams(ann);
    const auto moved = timeUntil(context, {&ann}, [&] { return datagrams(ann) > before + 5; });
    ASSERT_TRUE(moved);
    EXPECT_LT(*moved, kSlowness * std::chrono::seconds(1));
    EXPECT_TRUE(keyWorks(ann));
  }
  EXPECT_EQ(server.counters().detached, 0u);
  EXPECT_EQ(server.counters().divergences, 0u);
}

}  // namespace
}  // namespace naiad::test
