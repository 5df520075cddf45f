// A player who joins a world that takes many snapshots sees no part of it before all of it has arrived.
#include <gtest/gtest.h>

#include <cstdio>
#include <optional>

#include "TestClient.h"
#include "TestServer.h"
#include "engine/managers/DisplayManager.h"
#include "engine/world/Object.h"

namespace naiad::test {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kObjects = 3000;

/// Draws a unique word, so that the objects do not share a look in the snapshot.
struct Word : df::Object {
  explicit Word(int number) : text("word " + std::to_string(number)) {
    setSolidness(df::SPECTRAL);
    setPosition(df::Vector(number % 70, number % 24));
  }
  int draw() override { return DM.drawString(getPosition(), text, df::LEFT_JUSTIFIED, df::CYAN); }
  std::string text;
};

TEST(FirstPicture, IsTheWholeWorld) {
  TestServer server([](df::World&) {
    for (int i = 0; i < kObjects; ++i) new Word(i);
  });
  asio::io_context context;
  TestClient ann(context, server.port(), "ann");
  std::optional<Clock::time_point> began;
  bool first = true;
  std::size_t at_first = 0;
  std::uint64_t frames = 0;
  ann.connection().onSession([&](ClientSession& session) {
    began = Clock::now();
    session.onAfterSnapshot([&](const SnapshotHeader& header, const AckWindow&) {
      ++frames;
      if (!first) return;
      first = false;
      EXPECT_FALSE(header.complete);
      at_first = session.replica().aliveCount();
    });
  });
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return ann.joined(); }));
  const auto held = std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - *began);
  EXPECT_LT(at_first, kObjects);
  // The snapshots may take longer on a busy machine than kIncompleteTimeout, after which the client shows an
  // incomplete picture. Its wait begins with the first snapshot, and `held` earlier, with the connection.
  if (held < EpochReplicas::kIncompleteTimeout) {
    EXPECT_GE(frames, 3u);
    EXPECT_EQ(ann.session().replica().aliveCount(), kObjects);
  }
  std::printf("snapshots=%llu first_had=%zu joined_with=%zu held_us=%lld\n",
              static_cast<unsigned long long>(frames), at_first, ann.session().replica().aliveCount(),
              static_cast<long long>(held.count()));
}

}  // namespace
}  // namespace naiad::test
