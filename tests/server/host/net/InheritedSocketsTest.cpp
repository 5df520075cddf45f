// Sockets from the service manager: only sockets that a server can use are accepted.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/ip/udp.hpp>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <thread>

#include "WithIdentity.h"
#include "host/net/InheritedSockets.h"
#include "host/net/ServerPort.h"
#include "tests/support/WaitUntil.h"

namespace naiad {
namespace {

using asio::ip::tcp;
using asio::ip::udp;

/// First descriptor of the sockets, far above those that the process has anyway.
constexpr int kFirst = 700;

class InheritedSocketsTest : public WithIdentity {
 protected:
  ~InheritedSocketsTest() override {
    for (int i = 0; i < 3; ++i) ::close(kFirst + i);
  }
  /// Opens a listening socket and a datagram socket on one port, as descriptors from kFirst on.
  std::uint16_t openBoth(const char* address = "127.0.0.1") {
    for (;;) {
      tcp::acceptor streams(context, tcp::endpoint(asio::ip::make_address(address), 0));
      const std::uint16_t port = streams.local_endpoint().port();
      udp::socket datagrams(context);
      const udp::endpoint same(asio::ip::make_address(address), port);
      std::error_code taken;
      datagrams.open(same.protocol());
      datagrams.bind(same, taken);
      if (taken) continue;
      put(streams.native_handle(), 1);
      put(datagrams.native_handle(), 0);
      return port;
    }
  }
  static void put(int socket, int place) { ASSERT_EQ(::dup2(socket, kFirst + place), kFirst + place); }
  std::optional<InheritedSockets> importSockets() {
    return InheritedSockets::importSockets(
        1234,
        [this](const char* p_name) {
          const auto found = variables.find(p_name);
          return found == variables.end() ? nullptr : found->second.c_str();
        },
        kFirst);
  }
  std::string complaint() {
    try {
      importSockets();
    } catch (const ListenError& error) {
      EXPECT_EQ(error.code(), std::errc::invalid_argument);
      return error.what();
    }
    return "";
  }
  static std::string saying(const std::string& what) {
    return "The sockets from the service manager (LISTEN_FDS) cannot be used: " + what + ".";
  }

  asio::io_context context;
  std::map<std::string, std::string> variables{{"LISTEN_PID", "1234"}, {"LISTEN_FDS", "2"}};
};

TEST_F(InheritedSocketsTest, AreFoundByKindAndMadeCloseOnExec) {
  const std::uint16_t port = openBoth();
  const auto sockets = importSockets();
  ASSERT_TRUE(sockets);
  EXPECT_EQ(sockets->streams, kFirst + 1);
  EXPECT_EQ(sockets->datagrams, kFirst);
  EXPECT_EQ(sockets->address, "127.0.0.1");
  EXPECT_EQ(sockets->port, port);
  for (int i = 0; i < 2; ++i) EXPECT_EQ(::fcntl(kFirst + i, F_GETFD), FD_CLOEXEC);
}

TEST_F(InheritedSocketsTest, AreIgnoredForOtherProcessesOrWithoutCount) {
  openBoth();
  variables["LISTEN_PID"] = "12345";
  EXPECT_FALSE(importSockets());
  variables["LISTEN_PID"] = "1234x";
  EXPECT_FALSE(importSockets());
  variables.erase("LISTEN_PID");
  EXPECT_FALSE(importSockets());
  variables = {{"LISTEN_PID", "1234"}};
  EXPECT_FALSE(importSockets());
  variables["LISTEN_FDS"] = "0";
  EXPECT_FALSE(importSockets());
  EXPECT_EQ(::fcntl(kFirst, F_GETFD), 0) << "untouched";
}

TEST_F(InheritedSocketsTest, WrongNumberOrKindIsRefused) {
  variables["LISTEN_FDS"] = "1";
  EXPECT_EQ(complaint(), saying("expected one for TCP and one for UDP, but their number is 1"));
  variables["LISTEN_FDS"] = "-1";
  EXPECT_EQ(complaint(), saying("invalid number \"-1\""));
  variables["LISTEN_FDS"] = "2";
  EXPECT_EQ(complaint(), saying("descriptor 700 is not open"));
  const int null = ::open("/dev/null", O_RDWR);
  put(null, 0);
  ::close(null);
  EXPECT_EQ(complaint(), saying("descriptor 700 is not a TCP or UDP socket"));
  openBoth();
  put(kFirst, 1);
  EXPECT_EQ(complaint(), saying("both are UDP sockets"));
  int pair[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, pair), 0);
  put(pair[0], 0);
  EXPECT_EQ(complaint(), saying("the TCP socket is not listening"));
  for (const int end : pair) ::close(end);
}

TEST_F(InheritedSocketsTest, DifferentOrMissingAddressesAreRefused) {
  openBoth();
  udp::socket other(context, udp::endpoint(asio::ip::make_address("127.0.0.1"), 0));
  put(other.native_handle(), 0);
  EXPECT_EQ(complaint(), saying("they have different addresses or ports"));
  udp::socket unbound(context, udp::v4());
  put(unbound.native_handle(), 0);
  EXPECT_EQ(complaint(), saying("one is not bound to a port"));
  int pair[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_DGRAM, 0, pair), 0);
  put(pair[0], 0);
  EXPECT_EQ(complaint(), saying("one is not an IPv4 or IPv6 socket"));
  for (const int end : pair) ::close(end);
}

// Tests IPv4 and, as with systemd's "[::]:9876", a socket for both address families.
TEST_F(InheritedSocketsTest, ServerPortListensOnInheritedSockets) {
  for (const char* address : {"127.0.0.1", "::"}) {
    const std::uint16_t port = openBoth(address);
    const auto sockets = importSockets();
    ASSERT_TRUE(sockets);
    EXPECT_EQ(sockets->address, address);
    const ServerPort opened =
        adoptServerPort(context, *sockets, [](auto) {}, {}, {.context = identity->tls()});
    EXPECT_EQ(opened.streams->port(), port);
    EXPECT_EQ(opened.datagrams->port(), port);
    udp::socket socket(context, udp::endpoint(asio::ip::address_v4::loopback(), 0));
    socket.send_to(asio::buffer("garbage", 7), {asio::ip::address_v4::loopback(), port});
    tcp::socket stream(context);
    stream.connect({asio::ip::address_v4::loopback(), port});
    stream.write_some(asio::buffer("garbage", 7));
    EXPECT_TRUE(test::waitUntil([&] {
      context.restart();
      context.poll();
      return opened.datagrams->counters().too_short == 1 && opened.streams->counters().handshakes_failed == 1;
    })) << address;
  }
}

TEST_F(InheritedSocketsTest, WithoutEncryptionTheyAreRefused) {
  openBoth();
  const auto sockets = importSockets();
  ASSERT_TRUE(sockets);
  EXPECT_THROW(adoptServerPort(context, *sockets, [](auto) {}, {}, {}), ListenError);
}

constexpr const char* kExpected = "NAIAD_TEST_EXPECTED";  ///< port and is_service, for the next program

/// Call in a forked process: runs this test again, as the next program.
[[noreturn]] void runNextProgram(const InheritedSockets& sockets) {
  ::close_range(3, 15, 0);  // as in a server, low numbers are free
  const std::string expected = std::to_string(sockets.port) + ' ' + std::to_string(sockets.is_service);
  setenv(kExpected, expected.c_str(), 1);
  for (int i = 0; i < 4; ++i) {
    std::thread([] {
      for (;;) ::close(::open("/dev/null", O_RDONLY | O_CLOEXEC));
    }).detach();
  }
  sockets.exportToExec();
  execl("/proc/self/exe", "host_test",
        "--gtest_filter=InheritedSocketsTest.SurviveExecWhileThreadsOpenAndCloseFiles", nullptr);
  _exit(127);
}

void checkNextProgram(const std::string& expected) {
  const auto sockets = InheritedSockets::importSockets();
  ASSERT_TRUE(sockets);
  EXPECT_EQ(std::to_string(sockets->port) + ' ' + std::to_string(sockets->is_service), expected);
  EXPECT_EQ(::fcntl(sockets->streams, F_GETFD), FD_CLOEXEC);
  EXPECT_EQ(::fcntl(sockets->datagrams, F_GETFD), FD_CLOEXEC);
  EXPECT_FALSE(InheritedSockets::importSockets()) << "only once";
}

// Until exec, the threads of a server's log and journal open and close files.
TEST_F(InheritedSocketsTest, SurviveExecWhileThreadsOpenAndCloseFiles) {
  if (const char* p_expected = std::getenv(kExpected)) return checkNextProgram(p_expected);
  openBoth();
  auto sockets = importSockets();
  ASSERT_TRUE(sockets);
  EXPECT_TRUE(sockets->is_service);
  for (int i = 0; i < 20; ++i) {
    sockets->is_service = i % 2 == 0;
    const pid_t child = fork();
    if (child == 0) runNextProgram(*sockets);
    int status = -1;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_EQ(status, 0) << "attempt " << i;
  }
}

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
