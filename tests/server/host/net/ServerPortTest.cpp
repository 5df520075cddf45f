#include <gtest/gtest.h>

#include <asio/io_context.hpp>
#include <asio/ip/udp.hpp>
#include <set>

#include "WithIdentity.h"
#include "host/net/ServerPort.h"
#include "tests/support/WaitUntil.h"

namespace naiad {
namespace {

class ServerPortTest : public WithIdentity {
 protected:
  ServerPort open(const std::string& address, std::uint16_t port = 0) {
    return openServerPort(context, address, port, [](auto) {}, {}, {.context = identity->tls()});
  }
  std::error_code failure(const std::string& address, std::uint16_t port) {
    try {
      open(address, port);
    } catch (const ListenError& error) {
      EXPECT_NE(std::string(error.what()), "");
      return error.code();
    }
    return {};
  }

  asio::io_context context;
};

TEST_F(ServerPortTest, StreamsAndDatagramsShareOnePort) {
  std::set<std::uint16_t> ports;
  std::vector<ServerPort> opened;
  for (int i = 0; i < 10; ++i) {
    opened.push_back(open("127.0.0.1"));
    ASSERT_TRUE(opened.back().datagrams);
    EXPECT_EQ(opened.back().datagrams->port(), opened.back().streams->port());
    ports.insert(opened.back().streams->port());
  }
  EXPECT_EQ(ports.size(), 10u);
}

TEST_F(ServerPortTest, RequestedPortIsUsedOrReportedInUse) {
  std::uint16_t port = 0;
  {
    const ServerPort first = open("127.0.0.1");
    port = first.streams->port();
    EXPECT_EQ(failure("127.0.0.1", port), std::errc::address_in_use);
  }
  const ServerPort again = open("127.0.0.1", port);
  EXPECT_EQ(again.streams->port(), port);
  EXPECT_EQ(again.datagrams->port(), port);
}

TEST_F(ServerPortTest, PortFreeForStreamsOnlyIsRefused) {
  using asio::ip::udp;
  const udp::socket taken(context, udp::endpoint(asio::ip::address_v4::loopback(), 0));
  EXPECT_EQ(failure("127.0.0.1", taken.local_endpoint().port()), std::errc::address_in_use);
}

TEST_F(ServerPortTest, WithoutEncryptionThereAreNoDatagrams) {
  const ServerPort plain = openServerPort(context, "127.0.0.1", 0, [](auto) {}, {}, {});
  EXPECT_NE(plain.streams->port(), 0);
  EXPECT_EQ(plain.datagrams, nullptr);
  EXPECT_THROW(openServerPort(context, "0.0.0.0", 0, [](auto) {}, {}, {}), ListenError);
}

TEST_F(ServerPortTest, WildcardAddressListensOnBothFamilies) {
  const ServerPort all = open("::");
  EXPECT_EQ(all.datagrams->port(), all.streams->port());
  using asio::ip::udp;
  udp::socket socket(context, udp::endpoint(asio::ip::address_v4::loopback(), 0));
  socket.send_to(asio::buffer("garbage", 7), {asio::ip::address_v4::loopback(), all.datagrams->port()});
  EXPECT_TRUE(test::waitUntil([&] {
    context.restart();
    context.poll();
    return all.datagrams->counters().too_short == 1;
  }));
}

TEST_F(ServerPortTest, InvalidOrForeignAddressIsRefused) {
  EXPECT_EQ(failure("localhost", 0), std::errc::invalid_argument);
  EXPECT_TRUE(failure("192.0.2.77", 0)) << "not one of this machine";
}

}  // namespace
}  // namespace naiad
