#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <asio/io_context.hpp>
#include <asio/local/connect_pair.hpp>
#include <asio/local/stream_protocol.hpp>
#include <asio/write.hpp>
#include <filesystem>
#include <fstream>
#include <optional>

#include "shared/net/stream/Framing.h"
#include "shared/net/stream/ProxyHeader.h"
#include "shared/net/stream/ProxyListener.h"
#include "shared/net/stream/TcpListener.h"
#include "tests/shared/net/Loopback.h"
#include "tests/support/TempFolder.h"
#include "tests/support/Text.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;
using Local = asio::local::stream_protocol;
namespace fs = std::filesystem;

const tcp::endpoint kVisitor(asio::ip::make_address("192.0.2.7"), 50312);

class ProxyListenerTest : public testing::Test {
 protected:
  ProxyListenerTest() { m_options.path = m_folder / "visitors"; }

  void listen() {
    m_listener.emplace(m_context, m_options, [this](ByteStream::Socket socket, const tcp::endpoint& visitor) {
      m_sockets.push_back(std::move(socket));
      m_visitors.push_back(visitor);
    });
  }
  Local::socket connect() {
    Local::socket socket(m_context);
    socket.connect(Local::endpoint(m_options.path.string()));
    return socket;
  }
  /// Connects and sends this text.
  Local::socket say(const std::string& text) {
    Local::socket socket = connect();
    asio::write(socket, asio::buffer(text));
    return socket;
  }
  bool shouldRetryHandshake(Local::socket& socket) {
    socket.non_blocking(true);
    return runUntil(m_context, [&socket] {
      char byte = 0;
      std::error_code error;
      socket.read_some(asio::buffer(&byte, 1), error);
      return error && error != asio::error::would_block;
    });
  }
  bool waitFor(const std::uint64_t& counter) {
    return runUntil(m_context, [&counter] { return counter == 1; });
  }
  const ProxyListener::Counters& counters() const { return m_listener->counters(); }
  std::error_code failure() {
    return codeOf<ListenError>([this] { listen(); });
  }

  asio::io_context m_context;
  TempFolder m_folder;
  ProxyListenerOptions m_options;
  std::optional<ProxyListener> m_listener;
  std::vector<ByteStream::Socket> m_sockets;
  std::vector<tcp::endpoint> m_visitors;
};

TEST_F(ProxyListenerTest, ConnectionArrivesWithItsAddressAndUnreadBytes) {
  listen();
  const auto door = say(proxyHeader(kVisitor) + "hello");
  ASSERT_TRUE(runUntil(m_context, [this] { return !m_sockets.empty(); }));
  EXPECT_EQ(m_visitors.front(), kVisitor);
  char text[16] = {};
  EXPECT_EQ(m_sockets.front().read_some(asio::buffer(text)), 5u);
  EXPECT_STREQ(text, "hello");
  EXPECT_EQ(m_listener->waiting(), 0u);
}

TEST_F(ProxyListenerTest, AHeaderMayComeByteByByte) {
  listen();
  auto door = connect();
  for (const char byte : proxyHeader(kVisitor)) {
    EXPECT_TRUE(m_sockets.empty());
    asio::write(door, asio::buffer(&byte, 1));
    runReady(m_context);
  }
  ASSERT_TRUE(runUntil(m_context, [this] { return !m_sockets.empty(); }));
  EXPECT_EQ(m_visitors.front(), kVisitor);
}

TEST_F(ProxyListenerTest, InvalidHeaderIsDroppedWithoutAReply) {
  listen();
  std::string oversized = proxyHeader(kVisitor);
  oversized[14] = static_cast<char>(0xff);
  const std::string none = proxyHeader({asio::ip::make_address("0.0.0.0"), 9});
  std::uint64_t bad = 0;
  for (const std::string& text : {std::string("GET / HTTP/1.1\r\n\r\n"), oversized, none,
                                  std::string("PROXY TCP4 192.0.2.7 192.0.2.8 9 9\r\n")}) {
    auto door = say(text);
    EXPECT_TRUE(shouldRetryHandshake(door)) << text;
    EXPECT_EQ(counters().bad_headers, ++bad);
  }
  EXPECT_TRUE(m_sockets.empty());
}

TEST_F(ProxyListenerTest, ConnectionEndingWithinItsHeaderIsDropped) {
  listen();
  say(proxyHeader(kVisitor).substr(0, 20)).close();
  EXPECT_TRUE(waitFor(counters().bad_headers));
}

TEST_F(ProxyListenerTest, SlowHeaderIsDropped) {
  m_options.header_timeout = 50ms;
  listen();
  auto door = say(proxyHeader(kVisitor).substr(0, 20));
  EXPECT_TRUE(shouldRetryHandshake(door));
  EXPECT_EQ(counters().late_headers, 1u);
}

TEST_F(ProxyListenerTest, WaitingConnectionsAreLimited) {
  m_options.max_waiting = 2;
  listen();
  auto first = connect();
  auto second = connect();
  ASSERT_TRUE(runUntil(m_context, [this] { return m_listener->waiting() == 2; }));
  auto third = connect();
  EXPECT_TRUE(shouldRetryHandshake(third));
  EXPECT_EQ(counters().crowded, 1u);
  asio::write(first, asio::buffer(proxyHeader(kVisitor)));
  EXPECT_TRUE(runUntil(m_context, [this] { return m_sockets.size() == 1; }));
  const auto fourth = say(proxyHeader(kVisitor));
  EXPECT_TRUE(runUntil(m_context, [this] { return m_sockets.size() == 2; })) << "a place is free again";
}

TEST_F(ProxyListenerTest, CompleteHeadersAreAcceptedDespiteTheLimit) {
  m_options.max_waiting = 1;
  listen();
  const auto slow = connect();
  ASSERT_TRUE(runUntil(m_context, [this] { return m_listener->waiting() == 1; }));
  std::vector<Local::socket> doors;
  for (int i = 0; i < 100; ++i) doors.push_back(say(proxyHeader(kVisitor)));
  EXPECT_TRUE(runUntil(m_context, [this] { return m_sockets.size() == 100; }));
  EXPECT_EQ(counters().crowded, 0u);
  EXPECT_EQ(m_listener->waiting(), 1u);
}

TEST_F(ProxyListenerTest, ForbiddenProcessIsDropped) {
  pid_t asked = 0;
  m_options.is_refused = [&asked](pid_t process) {
    asked = process;
    return true;
  };
  listen();
  auto door = say(proxyHeader(kVisitor));
  EXPECT_TRUE(shouldRetryHandshake(door));
  EXPECT_EQ(counters().refused_peers, 1u);
  EXPECT_EQ(asked, getpid());
  EXPECT_TRUE(m_sockets.empty());
}

TEST_F(ProxyListenerTest, SurvivesRunningOutOfDescriptors) {
  listen();
  runReady(m_context);
  const Local::socket door = say(proxyHeader(kVisitor));
  {
    const NoDescriptorsLeft shortage;
    EXPECT_TRUE(runUntil(m_context, [this] { return counters().failed_accepts >= 2; }));
    EXPECT_TRUE(m_visitors.empty());
  }
  EXPECT_TRUE(runUntil(m_context, [this] { return m_visitors.size() == 1; }));
}

TEST_F(ProxyListenerTest, OnlyUserAndGroupMayOpenIt) {
  listen();
  struct stat facts {};
  ASSERT_EQ(stat(m_options.path.c_str(), &facts), 0);
  EXPECT_EQ(facts.st_mode & 07777, 0660u);
}

TEST_F(ProxyListenerTest, StaleSocketIsReplacedButNotALiveOne) {
  { Local::acceptor killed(m_context, Local::endpoint(m_options.path.string())); }
  ASSERT_TRUE(fs::exists(m_options.path));
  listen();
  ProxyListener* p_first = &*m_listener;
  EXPECT_THROW(ProxyListener(m_context, m_options, [](auto&&...) {}), ListenError);
  const auto door = say(proxyHeader(kVisitor));
  EXPECT_TRUE(waitFor(p_first->counters().visitors));
  m_listener.reset();
  EXPECT_FALSE(fs::exists(m_options.path));
}

TEST_F(ProxyListenerTest, NonSocketFileIsNotReplaced) {
  std::ofstream(m_options.path) << "mine";
  EXPECT_EQ(failure(), std::errc::file_exists);
  EXPECT_TRUE(fs::is_regular_file(m_options.path));
  fs::remove(m_options.path);
  fs::create_symlink(m_folder / "elsewhere", m_options.path);
  EXPECT_EQ(failure(), std::errc::file_exists);
  m_options.path = m_folder / std::string(120, 'x');
  EXPECT_EQ(failure(), std::errc::filename_too_long);
  m_options.path = m_folder / "missing" / "visitors";
  EXPECT_EQ(failure(), std::errc::no_such_file_or_directory);
}

TEST_F(ProxyListenerTest, AnotherProgramsSocketIsNotRemoved) {
  listen();
  fs::remove(m_options.path);
  const Local::acceptor other(m_context, Local::endpoint(m_options.path.string()));
  m_listener.reset();
  EXPECT_TRUE(fs::exists(m_options.path));
}

/// A server skips snapshots while bytes are unsent, so these must also be counted on a visitors' socket.
TEST(VisitorsChannel, BytesUnreadByTheProxyCountAsUnsent) {
  asio::io_context context;
  Local::socket near(context);
  Local::socket far(context);
  asio::local::connect_pair(near, far);
  const auto channel = makeTcpChannel(std::make_unique<PlainStream>(std::move(near), "192.0.2.7:50312"));
  EXPECT_EQ(channel->peerAddress(), "192.0.2.7:50312");
  channel->start({});
  EXPECT_EQ(channel->unsentBytes(), 0u);
  channel->send(std::string(3000, 'x'));
  runReady(context);
  EXPECT_GE(channel->unsentBytes(), 3000u);
  std::string read(4000, '\0');
  EXPECT_EQ(far.read_some(asio::buffer(read)), 3000 + kFrameHeaderSize);
  EXPECT_EQ(channel->unsentBytes(), 0u);
}

}  // namespace
}  // namespace naiad::test
