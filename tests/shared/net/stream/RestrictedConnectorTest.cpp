// Redirects that TCP connectors follow, and addresses to which they connect.
#include <gtest/gtest.h>

#include <asio/io_context.hpp>
#include <functional>
#include <string>

#include "shared/net/stream/TcpConnector.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

/// Tries to connect. Returns the error; empty if it succeeds.
std::string connectError(const std::string& host,
                         const std::function<bool(const asio::ip::address&)>& allowed) {
  asio::io_context context;
  TcpConnector connector(context, {}, TlsContext::forClient());
  connector.restrict(allowed);
  std::string problem = "nothing";
  connector.connect(host, 1, 5s, [&](auto, const std::string& error) { problem = error; });
  context.run_for(60s);
  return problem;
}

TEST(RestrictedConnector, NameResolvingToAForbiddenAddressIsRefused) {
  int asked = 0;
  const auto none = [&asked](const asio::ip::address&) {
    ++asked;
    return false;
  };
  for (const std::string host : {"127.0.0.1", "localhost", "::1"}) {
    const std::string problem = connectError(host, none);
    EXPECT_NE(problem.find("more private network"), std::string::npos) << problem;
  }
  EXPECT_GE(asked, 3) << "after the name was looked up";
  EXPECT_NE(connectError("127.0.0.1", {}).find("connection refused"), std::string::npos);
}

}  // namespace
}  // namespace naiad
