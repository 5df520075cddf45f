// Bytes that are put into or written to a SecureSocket arrive complete and in order, even if the kernel
// accepts little at a time.
//
// This source uses Boost's Asio, so it must not include headers that include the standalone Asio.
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <boost/asio/local/connect_pair.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <deque>

#include "host/auth/ServerIdentity.h"
#include "server/gateway/SecureSocket.h"
#include "shared/values/SplitMix64.h"
#include "tests/support/TempFolder.h"

namespace naiad::test {
namespace {

namespace net = boost::asio;
using Local = net::basic_stream_socket<net::local::stream_protocol, GatewayExecutor>;

/// Two connected sockets. The kernel's send buffer of `from` is small.
class SocketPair {
 public:
  explicit SocketPair(bool has_tls) {
    Local one(m_context.get_executor());
    Local other(m_context.get_executor());
    net::local::connect_pair(one, other);
    const int room = 4096;
    EXPECT_EQ(setsockopt(one.native_handle(), SOL_SOCKET, SO_SNDBUF, &room, sizeof room), 0);
    from.emplace(SecureSocket::Socket(std::move(one)));
    to.emplace(SecureSocket::Socket(std::move(other)));
    if (has_tls) shakeHands();
  }

  /// Runs the handlers that are ready.
  void turn() {
    m_context.restart();
    m_context.poll();
  }

 private:
  void shakeHands() {
    m_server = ServerIdentity::loadOrMake(TempFolder(), std::chrono::system_clock::now()).tls();
    ASSERT_TRUE(from->startTls(m_server->get(), SecureSocket::Role::kServer));
    ASSERT_TRUE(to->startTls(m_client->get(), SecureSocket::Role::kClient));
    int done = 0;
    const auto note = [&done](error_code error) {
      EXPECT_FALSE(error) << error.message();
      ++done;
    };
    from->asyncHandshake(note);
    to->asyncHandshake(note);
    while (done < 2) {
      m_context.restart();
      ASSERT_GT(m_context.run_one(), 0u);
    }
  }

  net::io_context m_context{1};
  std::shared_ptr<const TlsContext> m_server;
  std::shared_ptr<const TlsContext> m_client = TlsContext::forClient();

 public:
  std::optional<SecureSocket> from;  // destroyed before m_context
  std::optional<SecureSocket> to;
};

/// Returns a record: a letter, a length in two bytes, and this many letters.
std::string record(char letter, std::size_t length) {
  std::string text{letter, static_cast<char>(length >> 8), static_cast<char>(length & 0xff)};
  return text + std::string(length, letter);
}

/// Removes and returns the first record; "" if it is incomplete.
std::string takeRecord(std::string& text) {
  if (text.size() < 3) return {};
  const std::size_t length =
      std::size_t{static_cast<unsigned char>(text[1])} << 8 | static_cast<unsigned char>(text[2]);
  if (text.size() < 3 + length) return {};
  std::string taken = text.substr(0, 3 + length);
  text.erase(0, taken.size());
  return taken;
}

class SecureSocketTest : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(PlainAndTls, SecureSocketTest, testing::Bool());

TEST_P(SecureSocketTest, PutsAndWritesDoNotInterleave) {
  SocketPair pair(GetParam());
  SplitMix64 random(1);
  std::deque<std::string> put;      // put, but not yet received: small letters
  std::deque<std::string> written;  // written, but not yet received: capital letters
  std::string writing;
  std::string received;
  int rounds = 0;
  std::size_t most_kept = 0;
  const auto receive = [&](std::size_t most) {
    std::string bytes(most, '\0');
    std::optional<std::size_t> size;
    pair.to->async_read_some(net::buffer(bytes), [&size](error_code error, std::size_t count) {
      EXPECT_FALSE(error);
      size = count;
    });
    while (!size) {
      ASSERT_TRUE(pair.from->flush());
      pair.turn();
    }
    received.append(bytes, 0, *size);
    for (std::string one = takeRecord(received); !one.empty(); one = takeRecord(received)) {
      std::deque<std::string>& expected = one[0] >= 'a' ? put : written;
      ASSERT_FALSE(expected.empty());
      ASSERT_EQ(one, expected.front());
      expected.pop_front();
    }
  };
  while (rounds < 3000) {
    ++rounds;
    const auto letter = static_cast<char>('A' + random.below(26));
    if (random.below(3) == 0 && writing.empty()) {
      writing = record(letter, random.below(random.below(20) == 0 ? 30'000 : 120));
      written.push_back(writing);
      net::async_write(*pair.from, net::buffer(writing), [&](error_code error, std::size_t) {
        EXPECT_FALSE(error);
        writing.clear();
      });
    } else if (put.size() < 20) {
      put.push_back(
          record(static_cast<char>(letter | 0x20), random.below(random.below(9) == 0 ? 20'000 : 300)));
      pair.from->put(put.back());
      if (random.below(2) == 0) {
        ASSERT_TRUE(pair.from->flush());
      }
    }
    most_kept = std::max(most_kept, pair.from->queuedBytes());
    pair.turn();
    if (put.size() + written.size() > 5 && random.below(3) != 0) receive(1 + random.below(20'000));
    if (HasFatalFailure()) return;
  }
  while (!put.empty() || !written.empty()) {
    receive(20'000);
    if (HasFatalFailure()) return;
  }
  EXPECT_TRUE(received.empty());
  EXPECT_EQ(pair.from->queuedBytes(), 0u);
  EXPECT_GT(most_kept, 4096u) << "the kernel took all of it at once: nothing was tried";
}

TEST_P(SecureSocketTest, FlushFailsAfterClose) {
  SocketPair pair(GetParam());
  pair.from->put("late");
  pair.from->close();
  EXPECT_FALSE(pair.from->flush());
}

}  // namespace
}  // namespace naiad::test
