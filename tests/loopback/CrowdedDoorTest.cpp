// Many clients connect at once to a server with default settings: hostile ones neither keep out nor
// disconnect players, and honest ones get in.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <asio/steady_timer.hpp>
#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "Compare.h"
#include "LoopbackFixture.h"
#include "RawClient.h"
#include "SilentCrowd.h"
#include "StreamProxy.h"
#include "client/session/Connection.h"
#include "client/session/TcpStreamOpener.h"
#include "host/auth/PasswordQueue.h"
#include "shared/net/base/Limits.h"
#include "shared/net/stream/TcpChannel.h"
#include "shared/net/stream/TlsStream.h"

namespace naiad::test {
namespace {

using asio::ip::tcp;
using namespace std::chrono_literals;

std::vector<std::string> addresses(int count, const std::function<std::string(int)>& nth) {
  std::vector<std::string> all;
  for (int i = 0; i < count; ++i) all.push_back(nth(i));
  return all;
}

/// Created once because it reads all of the machine's certificates.
const std::shared_ptr<const TlsContext>& clientTls() {
  static const std::shared_ptr<const TlsContext> made = TlsContext::forClient();
  return made;
}

/// A client that sends hello and then only listens, so a thousand of them fit into a test. Each can have its
/// own address.
class LightClient {
 public:
  enum class State { kIdle, kJoining, kWelcome, kRefused, kHungUp };

  /// `address` is the client's own address, in 127/8. Runs in `context`, which must outlive this client.
  LightClient(asio::io_context& context, std::uint16_t server, const std::string& address)
      : m_context(context),
        m_server(asio::ip::address_v4::loopback(), server),
        m_own(asio::ip::make_address(address), 0),
        m_timer(context) {}
  ~LightClient() {
    m_on_judged = nullptr;
    drop();
  }
  LightClient(const LightClient&) = delete;
  LightClient& operator=(const LightClient&) = delete;

  /// Connects with TLS and sends hello, with the token of the last welcome if there was one.
  void join() {
    drop();
    m_state = State::kJoining;
    const auto socket = std::make_shared<tcp::socket>(m_context, m_own);
    m_socket = socket;
    socket->async_connect(m_server, [this, socket](const std::error_code& error) {
      if (m_socket != socket) return;  // drop() was called
      m_socket.reset();
      if (error) return end(State::kHungUp);
      m_handshake = std::make_shared<TlsHandshake>(
          std::make_unique<TlsStream>(std::move(*socket), clientTls(), "127.0.0.1"));
      m_handshake->run(30s, [this](TlsHandshake::End result, std::unique_ptr<TlsStream> stream, const auto&) {
        m_handshake.reset();
        if (!stream || result != TlsHandshake::End::kDone) return end(State::kHungUp);
        sayHello(std::move(stream));
      });
    });
  }
  /// Calls join() after a pause.
  void joinAfter(std::chrono::milliseconds pause) {
    m_timer.expires_after(pause);
    m_timer.async_wait([this](const std::error_code& error) {
      if (!error) join();
    });
  }
  /// Joins and, like Connection, retries until it is accepted: after 0.25 s, 0.5 s and so on up to 2 s.
  void joinUntilWelcome() {
    m_insists = true;
    m_backoff = 250ms;
    join();
  }
  /// Closes the connection without a goodbye.
  void drop() {
    m_timer.cancel();
    m_socket.reset();
    if (m_handshake) m_handshake->cancel();
    m_handshake.reset();
    m_channel.reset();
    m_state = State::kIdle;
  }

  State state() const { return m_state; }
  const wire::Welcome& welcome() const { return m_welcome; }
  /// Sets a function that is called when a join succeeds or fails.
  void onJudged(std::function<void(LightClient&)> callback) { m_on_judged = std::move(callback); }

 private:
  void sayHello(std::unique_ptr<TlsStream> stream) {
    m_channel = makeTcpChannel(std::move(stream), TcpOptions{.receive_limit = kMaxServerFrame});
    m_channel->start({[this](std::string_view frame) { onFrame(frame); },
                      [this](CloseReason) {
                        if (m_state == State::kJoining) end(State::kHungUp);
                      }});
    wire::ClientMessage message = RawClient::hello("light");
    message.mutable_hello()->set_resume_token(m_welcome.resume_token());
    m_channel->send(message.SerializeAsString());
  }
  void onFrame(std::string_view frame) {
    wire::ServerMessage message;
    if (m_state != State::kJoining || !message.ParseFromArray(frame.data(), static_cast<int>(frame.size())))
      return;
    if (message.has_welcome()) {
      m_welcome = message.welcome();
      m_insists = false;
      end(State::kWelcome);
    } else if (message.has_refused()) {
      end(State::kRefused);
    }
  }
  void end(State state) {
    m_state = state;
    if (m_insists)
      joinAfter(std::exchange(m_backoff, std::min<std::chrono::milliseconds>(m_backoff * 2, 2s)));
    if (m_on_judged) m_on_judged(*this);
  }

  asio::io_context& m_context;
  tcp::endpoint m_server;
  tcp::endpoint m_own;
  asio::steady_timer m_timer;
  std::shared_ptr<tcp::socket> m_socket;  ///< set while the client connects
  std::shared_ptr<TlsHandshake> m_handshake;
  std::unique_ptr<ReliableChannel> m_channel;
  State m_state = State::kIdle;
  wire::Welcome m_welcome;
  std::function<void(LightClient&)> m_on_judged;
  bool m_insists = false;
  std::chrono::milliseconds m_backoff{250};
};

class CrowdedDoor : public LoopbackFixture {
 protected:
  /// A player whose stream comes from its own address.
  struct Visitor {
    Visitor(asio::io_context& context, const TestServer& server, const std::string& address)
        : proxy(context, server.port()) {
      proxy.setOwnAddress(address);
    }
    void join(asio::io_context& context, const ClientSetup& setup) {
      client = std::make_unique<TestClient>(context, proxy.port(), setup);
      client->keepPictures(false);
    }
    bool isJudged() { return client->joined() || client->connection().isOver(); }

    StreamProxy proxy;
    std::unique_ptr<TestClient> client;
  };
  bool seesTheTruth(TestClient& client, TestServer& server, std::initializer_list<TestClient*> all) {
    server.keepTruth(true);
    client.keepPictures(true);
    return serveUntil(context, all, [&] { return showsTheTruth(client, server); });
  }
  std::unique_ptr<Visitor> visitor(const TestServer& server, const std::string& address) {
    return std::make_unique<Visitor>(context, server, address);
  }
  std::vector<std::unique_ptr<LightClient>> lightClients(const TestServer& server,
                                                         const std::vector<std::string>& from) {
    std::vector<std::unique_ptr<LightClient>> all;
    for (const std::string& address : from)
      all.push_back(std::make_unique<LightClient>(context, server.port(), address));
    return all;
  }
  static std::size_t countWelcome(const std::vector<std::unique_ptr<LightClient>>& clients) {
    return static_cast<std::size_t>(std::ranges::count_if(
        clients, [](const auto& client) { return client->state() == LightClient::State::kWelcome; }));
  }
  using LoopbackFixture::serve;
  bool serve(const std::function<bool()>& done) { return serveUntil(context, {}, done); }
};

// ---- half-open connections --------------------------------------------------------------------------------

struct Flood {
  const char* name;
  SilentCrowd::Kind kind;
  int addresses;
  const char* form;  ///< printf format of the addresses; %d counts from 1
  int connections = 400;
  int max_players = HostOptions().max_players;
};

std::ostream& operator<<(std::ostream& out, const Flood& flood) {
  return out << flood.name;
}

class HalfOpenCrowd : public CrowdedDoor, public testing::WithParamInterface<Flood> {};

TEST_P(HalfOpenCrowd, DoesNotBlockOrDisconnectPlayers) {
  const Flood& flood = GetParam();
  HostOptions options = home.server();
  options.max_players = flood.max_players;
  TestServer server(busyWorld(20), options);
  server.keepTruth(false);
  TestClient ann(context, server.port(), home.player("ann"));
  ann.keepPictures(false);
  const auto bob = visitor(server, "127.8.8.8");
  bob->join(context, home.player("bob"));
  ASSERT_TRUE(
      serveUntil(context, {&ann, bob->client.get()}, [&] { return ann.joined() && bob->client->joined(); }));

  const auto from = addresses(flood.addresses, [&](int i) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), flood.form, i + 1);
    return std::string(text.data());
  });
  SilentCrowd crowd(server.port(), from, flood.connections / flood.addresses, flood.kind);
  const auto all = {&ann, bob->client.get()};
  ASSERT_TRUE(serveUntil(context, all, [&] { return crowd.hungUp() > 100; })) << "the crowd is at the limit";

  const std::uint32_t began = ann.newestTick();
  for (int i = 0; i < 3; ++i) {
    const auto newcomer = visitor(server, "127.9." + std::to_string(i) + ".9");
    newcomer->join(context, home.player("cid"));
    TestClient& cid = *newcomer->client;
    const auto took =
        timeUntil(context, {&ann, bob->client.get(), &cid}, [&] { return newcomer->isJudged(); });
    ASSERT_TRUE(took && cid.joined()) << cid.connection().message();
    EXPECT_LT(*took, kSlowness * 1s);

    const std::uint64_t resumed = server.counters().resumed;
    bob->proxy.cut();
    const auto back = timeUntil(context, {&ann, bob->client.get(), &cid},
                                [&] { return server.counters().resumed > resumed && bob->client->joined(); });
    ASSERT_TRUE(back) << bob->client->connection().message();
    EXPECT_LT(*back, kSlowness * 1s);
  }
  ASSERT_TRUE(serveUntil(context, all, [&] { return ann.newestTick() > began + 100; }));
  EXPECT_TRUE(seesTheTruth(ann, server, all));
  EXPECT_EQ(server.counters().divergences, 0u);
  EXPECT_EQ(ann.session().state(), ClientSession::State::kPlaying);
  EXPECT_EQ(server.counters().joined, 5u);
  EXPECT_EQ(server.counters().reconnect_timeouts, 0u);
  if (flood.kind == SilentCrowd::Kind::kNoHello) {
    EXPECT_GT(server.counters().connections_rejected, 100u);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Floods, HalfOpenCrowd,
    testing::Values(Flood{"OfFourSilentAddresses", SilentCrowd::Kind::kSilent, 4, "127.%d.1.1"},
                    Flood{"OfFourAddressesThatBeginAHello", SilentCrowd::Kind::kBegunHello, 4, "127.%d.1.1"},
                    Flood{"OfFourAddressesThatSayHello", SilentCrowd::Kind::kWholeHello, 4, "127.%d.1.1"},
                    Flood{"OfOneNeighbourhood", SilentCrowd::Kind::kBegunHello, 200, "127.1.1.%d"},
                    Flood{"OfOneNeighbourhoodThatSaysHello", SilentCrowd::Kind::kWholeHello, 200,
                          "127.1.1.%d"},
                    Flood{"OfTwoHundredNetworks", SilentCrowd::Kind::kBegunHello, 200, "127.1.%d.1"},
                    // max_players = 6 allows 28 sessions at once; five are players.
                    Flood{"OfFortyNetworksThatFinishTlsAndSayNoMore", SilentCrowd::Kind::kNoHello, 40,
                          "127.1.%d.1", 40, 6},
                    Flood{"OfOneNeighbourhoodThatFinishesTlsAndSaysNoMore", SilentCrowd::Kind::kNoHello, 40,
                          "127.1.1.%d", 40, 6}),
    [](const auto& flood) { return flood.param.name; });

// ---- honest crowds ----------------------------------------------------------------------------------------

TEST_F(CrowdedDoor, ThousandPlayersReconnectWithinTenSeconds) {
  HostOptions options = home.server();
  options.frame_micros = 0;
  options.max_players = 1000;
  TestServer server(busyWorld(0), options);
  server.keepTruth(false);
  const auto players =
      lightClients(server, addresses(1000 / kSlowness, [](int i) {
                     return "127.7." + std::to_string(i / 250) + "." + std::to_string(1 + i % 250);
                   }));
  for (std::size_t joined = 0; joined < players.size(); joined += 50) {
    for (std::size_t i = joined; i < joined + 50; ++i) players[i]->join();
    ASSERT_TRUE(serve([&] { return countWelcome(players) == joined + 50; }));
  }
  for (const auto& player : players) player->drop();
  ASSERT_TRUE(serve([&] { return server.counters().detached == players.size(); }));

  for (const auto& player : players) player->joinUntilWelcome();
  const auto took = timeUntil(context, {}, [&] { return countWelcome(players) == players.size(); });
  ASSERT_TRUE(took) << countWelcome(players);
  EXPECT_LT(*took, 10s);
  EXPECT_EQ(server.counters().resumed, players.size());
  EXPECT_TRUE(std::ranges::all_of(players, [](const auto& p) { return p->welcome().resumed(); }));
}

TEST_F(CrowdedDoor, TwoHundredPlayersOfOneAddressJoinAtOnce) {
  HostOptions options = home.server();
  options.max_players = options.max_per_address = 200;
  TestServer server(busyWorld(0), options);
  server.keepTruth(false);
  const auto players = lightClients(server, addresses(200, [](int) { return "127.7.7.7"; }));
  for (const auto& player : players) player->join();
  ASSERT_TRUE(serve([&] {
    return std::ranges::none_of(players,
                                [](const auto& p) { return p->state() == LightClient::State::kJoining; });
  }));
  EXPECT_EQ(countWelcome(players), players.size());
}

// ---- handshakes -------------------------------------------------------------------------------------------

TEST_F(CrowdedDoor, HandshakesOfOneAddressAreLimitedWithoutDelayingOthers) {
  TestServer server(busyWorld(20), home.server());
  server.keepTruth(false);
  const auto crowd = lightClients(server, addresses(16, [](int) { return "127.1.1.1"; }));
  TestClient ann(context, server.port(), home.player("ann"));
  ann.keepPictures(false);
  ASSERT_TRUE(serve(ann, [&] { return ann.joined(); }));
  const auto began = Clock::now();
  int hung_up = 0;
  for (const auto& one : crowd) {
    one->onJudged([&hung_up](LightClient& client) {
      if (client.state() == LightClient::State::kHungUp) ++hung_up;
      client.joinAfter(20ms);
    });
    one->join();
  }
  ASSERT_TRUE(serve(ann, [&] { return hung_up > 300; }));

  const std::uint32_t tick = ann.newestTick();
  for (const std::string address : {"127.1.1.2", "127.9.9.9"}) {
    const auto newcomer = visitor(server, address);
    newcomer->join(context, home.player("cid"));
    const auto took =
        timeUntil(context, {&ann, newcomer->client.get()}, [&] { return newcomer->isJudged(); });
    ASSERT_TRUE(took && newcomer->client->joined()) << newcomer->client->connection().message();
    EXPECT_LT(*took, kSlowness * 1s);
  }
  ASSERT_TRUE(serve(ann, [&] { return ann.newestTick() > tick + 100; }));
  const std::uint64_t handshakes = server.counters().connections;
  const std::chrono::duration<double> elapsed = Clock::now() - began;
  EXPECT_LE(static_cast<double>(handshakes), 256 + 8 * elapsed.count() + 3 + 1) << "ann, two newcomers";
  EXPECT_GT(handshakes, 200u);
  EXPECT_EQ(ann.session().state(), ClientSession::State::kPlaying);
}

// ---- passwords --------------------------------------------------------------------------------------------

static_assert(Connection::kMaxBackoff + TcpStreamOpener::kConnectTimeout < PasswordQueue::kMaxPause,
              "a client that retries makes no pause that ends its wait");

}  // namespace
}  // namespace naiad::test
