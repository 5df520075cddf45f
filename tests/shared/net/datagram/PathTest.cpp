#include <gtest/gtest.h>

#include <unordered_set>

#include "shared/net/datagram/Path.h"

namespace naiad {
namespace {

TEST(Endpoint, PrintsInStandardNotation) {
  EXPECT_EQ(toString(*makeEndpoint("127.0.0.1", 40'000)), "127.0.0.1:40000");
  EXPECT_EQ(toString(*makeEndpoint("::1", 80)), "[::1]:80");
  EXPECT_EQ(toString(*makeEndpoint("2001:db8::5", 1)), "[2001:db8::5]:1");
  EXPECT_EQ(toString(Path{*makeEndpoint("127.0.0.2", 1), *makeEndpoint("::1", 2)}), "127.0.0.2:1 <- [::1]:2");
}

TEST(Endpoint, RefusesNonNumericAddresses) {
  for (const char* text : {"", "localhost", "1.2.3", "1.2.3.4:5", "::1::2", "256.0.0.1"})
    EXPECT_FALSE(makeEndpoint(text, 1)) << text;
}

TEST(Endpoint, MappedAddressIsTheIPv4Address) {
  EXPECT_EQ(makeEndpoint("::ffff:10.1.2.3", 5), makeEndpoint("10.1.2.3", 5));
  EXPECT_TRUE(makeEndpoint("10.1.2.3", 5)->isIPv4());
  EXPECT_FALSE(makeEndpoint("::10.1.2.3", 5)->isIPv4());
}

TEST(Endpoint, RecognisesTheUnspecifiedAddress) {
  EXPECT_TRUE(makeEndpoint("0.0.0.0", 5)->isAny());
  EXPECT_TRUE(makeEndpoint("::", 5)->isAny());
  EXPECT_TRUE(Endpoint{}.isAny());
  EXPECT_FALSE(makeEndpoint("0.0.0.1", 0)->isAny());
  EXPECT_FALSE(makeEndpoint("::1", 0)->isAny());
}

TEST(Endpoint, EveryPartMattersForEquality) {
  const Endpoint base = *makeEndpoint("fe80::1%1", 5);
  std::unordered_set<Endpoint> all{base};
  for (const char* other : {"fe80::1%2", "fe80::2%1", "fe80:0:0:1::1%1", "::ffff:1.2.3.4"})
    all.insert(*makeEndpoint(other, 5));
  all.insert(*makeEndpoint("fe80::1%1", 6));
  EXPECT_EQ(all.size(), 6u);
  std::unordered_set<Path> paths{{base, base}, {base, {}}, {{}, base}, {{}, {}}, {base, base}};
  EXPECT_EQ(paths.size(), 4u);
}

}  // namespace
}  // namespace naiad
