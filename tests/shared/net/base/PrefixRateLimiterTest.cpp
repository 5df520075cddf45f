#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "shared/net/base/PrefixRateLimiter.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

AddressPrefix of(const std::string& text) {
  return AddressPrefix::of(asio::ip::make_address(text));
}

class PrefixRateLimiterTest : public testing::Test {
 protected:
  /// Tries `times` times and returns how many are allowed now.
  int take(PrefixRateLimiter& allowance, const std::string& from, int times) const {
    int taken = 0;
    for (int i = 0; i < times; ++i) taken += allowance.tryConsume(of(from), now) ? 1 : 0;
    return taken;
  }
  PrefixRateLimiter::Time now{1h};
};

TEST_F(PrefixRateLimiterTest, AddressHasItsLimitAndSharesItsNetworks) {
  PrefixRateLimiter allowance({{1, 5}, {2, 8}, std::nullopt});
  EXPECT_EQ(take(allowance, "192.0.2.1", 100), 5);
  EXPECT_EQ(take(allowance, "192.0.2.2", 100), 3);
  EXPECT_EQ(take(allowance, "198.51.100.1", 100), 5);
  now += 1s;
  EXPECT_EQ(take(allowance, "192.0.2.1", 100), 1);
}

TEST_F(PrefixRateLimiterTest, AddressOverItsLimitDoesNotChargeItsNetwork) {
  PrefixRateLimiter allowance({{1, 5}, {2, 8}, BucketRate{1, 9}});
  EXPECT_EQ(take(allowance, "192.0.2.1", 100'000), 5);
  EXPECT_EQ(take(allowance, "192.0.2.2", 100'000), 3);
  EXPECT_EQ(take(allowance, "198.51.100.1", 100), 1) << "of all";
}

TEST_F(PrefixRateLimiterTest, CheckingConsumesNoTokens) {
  PrefixRateLimiter allowance({{1, 2}, {2, 3}, std::nullopt});
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(allowance.canConsume(of("192.0.2.1"), now));
  EXPECT_EQ(take(allowance, "192.0.2.1", 100), 2);
  EXPECT_FALSE(allowance.canConsume(of("192.0.2.1"), now));
  EXPECT_TRUE(allowance.canConsume(of("192.0.2.2"), now));
  EXPECT_EQ(take(allowance, "192.0.2.2", 1), 1);
  EXPECT_FALSE(allowance.canConsume(of("192.0.2.2"), now)) << "of the network";
  now += 1s;
  EXPECT_TRUE(allowance.canConsume(of("192.0.2.1"), now));
}

TEST_F(PrefixRateLimiterTest, ClassOf64JoinsTwiceThenEveryEightSeconds) {
  PrefixRateLimiter handshakes(RateLimits::handshakes(64));
  EXPECT_EQ(take(handshakes, "192.0.2.1", 300), 256);
  for (int i = 0; i < 10; ++i) {
    now += 8s;
    EXPECT_EQ(take(handshakes, "192.0.2.1", 100), 64);
  }
}

TEST_F(PrefixRateLimiterTest, ClassOf64ChatsTogetherThenEveryFourSeconds) {
  PrefixRateLimiter chat(RateLimits::chat(64));
  EXPECT_EQ(take(chat, "192.0.2.1", 64 * 3), 64 * 3);
  EXPECT_EQ(take(chat, "192.0.2.1", 1), 0);
  for (int i = 0; i < 10; ++i) {
    now += 4s;
    EXPECT_EQ(take(chat, "192.0.2.1", 64), 64);
  }
}

TEST_F(PrefixRateLimiterTest, AllowanceGrowsWithPlayersPerAddress) {
  PrefixRateLimiter joins(RateLimits::joins(200));
  EXPECT_EQ(take(joins, "192.0.2.1", 400), 400);
  PrefixRateLimiter few(RateLimits::joins(1));
  EXPECT_EQ(take(few, "192.0.2.1", 400), 128);
}

}  // namespace
}  // namespace naiad
