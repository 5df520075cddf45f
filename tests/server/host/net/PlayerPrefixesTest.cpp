#include <gtest/gtest.h>

#include <array>

#include "host/net/PlayerPrefixes.h"

namespace naiad {
namespace {

AddressPrefix of(const char* text) {
  return AddressPrefix::of(asio::ip::make_address(text));
}

TEST(PlayerPrefixes, CountSessionsFromTheirBeginningToTheirEnd) {
  PlayerPrefixes prefixes;
  prefixes.record(1, of("192.0.2.1"));
  prefixes.record(2, of("192.0.2.1"));
  prefixes.record(3, of("192.0.2.3"));
  EXPECT_EQ(prefixes.count(of("192.0.2.1")), 2u);
  EXPECT_EQ(prefixes.count(of("192.0.2.3")), 1u);
  EXPECT_EQ(prefixes.count(of("192.0.2.2")), 0u);
  prefixes.forget(1);
  prefixes.forget(1);
  prefixes.forget(7);
  EXPECT_EQ(prefixes.count(of("192.0.2.1")), 1u);
  prefixes.forget(2);
  EXPECT_EQ(prefixes.count(of("192.0.2.1")), 0u);
}

TEST(PlayerPrefixes, MovedSessionCountsAtFirstAndCurrentPrefix) {
  PlayerPrefixes prefixes;
  const auto counts = [&] {
    return std::array{prefixes.count(of("192.0.2.1")), prefixes.count(of("192.0.2.2")),
                      prefixes.count(of("192.0.2.3"))};
  };
  prefixes.record(1, of("192.0.2.1"));
  prefixes.record(1, of("192.0.2.1"));
  EXPECT_EQ(counts(), (std::array<std::size_t, 3>{1, 0, 0}));
  prefixes.record(1, of("192.0.2.2"));
  prefixes.record(1, of("192.0.2.2"));
  EXPECT_EQ(counts(), (std::array<std::size_t, 3>{1, 1, 0}));
  prefixes.record(1, of("192.0.2.3"));
  EXPECT_EQ(counts(), (std::array<std::size_t, 3>{1, 0, 1}));
  prefixes.record(1, of("192.0.2.1"));
  EXPECT_EQ(counts(), (std::array<std::size_t, 3>{1, 0, 0}));
  prefixes.record(1, of("192.0.2.2"));
  prefixes.forget(1);
  EXPECT_EQ(counts(), (std::array<std::size_t, 3>{0, 0, 0}));
}

}  // namespace
}  // namespace naiad
