#include <gtest/gtest.h>

#include "client/trust/ServerAddress.h"

namespace naiad {
namespace {

TEST(ServerAddress, ParsesHostAndOptionalPort) {
  const struct {
    const char* text;
    const char* host;
    int port;
  } good[] = {{"localhost", "localhost", 9876}, {"localhost:80", "localhost", 80},
              {"127.0.0.1:1", "127.0.0.1", 1},  {"::1", "::1", 9876},
              {"[::1]", "::1", 9876},           {"[::1]:65535", "::1", 65535}};
  for (const auto& g : good) {
    const auto address = ServerAddress::parse(g.text);
    ASSERT_TRUE(address) << g.text;
    EXPECT_EQ(address->host, g.host);
    EXPECT_EQ(address->port, g.port);
  }
  EXPECT_EQ(ServerAddress::parse("[::1]:7")->text(), "[::1]:7");
  EXPECT_EQ(ServerAddress::parse("a")->text(), "a:9876");
}

TEST(ServerAddress, RejectsMalformedAddresses) {
  for (const char* text : {"", ":", ":80", "a:", "a:0", "a:65536", "a:-1", "a:8x", "[::1", "[]:1", "[::1]80",
                           "a b", "a/b", "a\033b", "a..", ".."}) {
    EXPECT_FALSE(ServerAddress::parse(text)) << text;
  }
}

}  // namespace
}  // namespace naiad
