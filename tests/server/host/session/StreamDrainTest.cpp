#include <gtest/gtest.h>

#include "host/session/StreamDrain.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kPile = StreamDrain::kMuch + 1000;

TEST(StreamDrain, WhoTakesNothingForTenSecondsHasStuck) {
  StreamDrain drain;
  StreamDrain::Time now{1h};
  EXPECT_FALSE(drain.note(kPile, now));
  EXPECT_FALSE(drain.note(kPile, now + 9999ms));
  EXPECT_TRUE(drain.note(kPile, now + 10s));
  EXPECT_TRUE(drain.note(kPile + 5000, now + 11s)) << "more on top is no way out";
}

TEST(StreamDrain, WhoIsSlowHasNot) {
  StreamDrain drain;
  StreamDrain::Time now{1h};
  for (std::size_t left = 900'000; left > 1000; left -= 1000, now += 9s) {
    ASSERT_FALSE(drain.note(left, now)) << left;
  }
}

TEST(StreamDrain, LittleMayLieForEver) {
  StreamDrain drain;
  StreamDrain::Time now{1h};
  for (int i = 0; i < 100; ++i, now += 1s) ASSERT_FALSE(drain.note(StreamDrain::kMuch, now));
}

TEST(StreamDrain, TheTimeBeginsAnewWithEachPile) {
  StreamDrain drain;
  StreamDrain::Time now{1h};
  drain.note(kPile, now);
  drain.note(10, now + 9s);
  EXPECT_FALSE(drain.note(kPile, now + 10s));
  EXPECT_FALSE(drain.note(kPile, now + 19s));
  drain.restart();
  EXPECT_FALSE(drain.note(kPile, now + 20s)) << "another stream";
  EXPECT_TRUE(drain.note(kPile, now + 30s));
}

}  // namespace
}  // namespace naiad
