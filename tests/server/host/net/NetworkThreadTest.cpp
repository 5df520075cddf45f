#include <gtest/gtest.h>

#include <asio/io_context.hpp>
#include <string>
#include <thread>
#include <vector>

#include "WithIdentity.h"
#include "host/net/Mailbox.h"
#include "host/net/NetworkThread.h"
#include "host/net/RelayedStream.h"
#include "host/net/TickTimes.h"
#include "shared/net/datagram/SealedLink.h"
#include "shared/net/datagram/UdpSocket.h"
#include "shared/net/stream/TcpConnector.h"
#include "tests/shared/net/Recorder.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// The test plays the tick thread and the client, which has an event loop of its own.
class NetworkThreadTest : public WithIdentity {
 protected:
  void TearDown() override {
    datagrams.reset();
    near.clear();
  }

  void listen(NetworkThread::Limits limits = {}, bool encrypted = false) {
    tls = encrypted;
    network = std::make_unique<NetworkThread>(
        home, "127.0.0.1", std::uint16_t{0},
        [this](std::unique_ptr<ReliableChannel> channel) {
          near.push_back(std::move(channel));
          near.back()->start({[this](std::string_view frame) { heard.emplace_back(frame); },
                              [this](CloseReason reason) { closed.push_back(reason); }});
        },
        TcpOptions{.receive_limit = kMaxClientFrame},
        TlsListenerOptions{encrypted ? identity->tls() : nullptr}, limits);
    network->start();
  }
  /// Runs the client and, unless `deaf`, the tick thread until `done` is true. False after 30 s.
  template <class Done>
  bool runUntil(Done done, bool deaf = false) {
    const auto end = Clock::now() + 30s;
    while (!done()) {
      if (Clock::now() > end) return false;
      client.restart();
      client.run_for(1ms);
      if (!deaf) serve();
    }
    return true;
  }
  void serve() {
    home.restart();
    home.poll();
    network->serve(Clock::now() + 1s);
  }
  struct Far : test::Recorder {
    std::unique_ptr<TcpConnector> connector;
    std::unique_ptr<ReliableChannel> channel;
    bool failed = false;
  };
  /// Connects a client. Unless `deaf`, the tick thread gets its channel.
  std::unique_ptr<Far> connect(bool deaf = false) {
    const std::size_t before = near.size();
    auto far = std::make_unique<Far>();
    far->connector = std::make_unique<TcpConnector>(client, TcpOptions{.receive_limit = kMaxServerFrame},
                                                    tls ? TlsContext::forClient() : nullptr);
    far->connector->connect("127.0.0.1", network->port(), 20s,
                            [p = far.get()](std::unique_ptr<ReliableChannel> channel, const std::string&) {
                              p->failed = channel == nullptr;
                              if (p->failed) return;
                              p->channel = std::move(channel);
                              p->channel->start(p->callbacks());
                            });
    const auto is_done = [&] { return far->channel != nullptr && (deaf || near.size() > before); };
    EXPECT_TRUE(runUntil([&] { return far->failed || is_done(); }, deaf));
    return far;
  }

  bool tls = false;
  asio::io_context home;
  asio::io_context client;
  std::unique_ptr<NetworkThread> network;
  std::vector<std::unique_ptr<ReliableChannel>> near;
  std::unique_ptr<SealedChannel> datagrams;
  std::vector<std::string> heard;
  std::vector<CloseReason> closed;
};

TEST_F(NetworkThreadTest, FramesCrossBothWaysInOrder) {
  listen();
  const auto far = connect();
  for (int i = 0; i < 100; ++i) far->channel->send(std::to_string(i));
  ASSERT_TRUE(runUntil([&] { return heard.size() == 100; }));
  for (int i = 0; i < 100; ++i) EXPECT_EQ(heard[static_cast<std::size_t>(i)], std::to_string(i));
  EXPECT_EQ(near[0]->peerAddress().substr(0, 10), "127.0.0.1:");

  for (int i = 0; i < 100; ++i) near[0]->send(std::to_string(i));
  EXPECT_GE(near[0]->unsentBytes(), 290u) << "on the way";
  network->flush();
  ASSERT_TRUE(runUntil([&] { return far->frames.size() == 100; }));
  for (int i = 0; i < 100; ++i) EXPECT_EQ(far->frames[static_cast<std::size_t>(i)], std::to_string(i));
  EXPECT_TRUE(runUntil([&] { return near[0]->unsentBytes() == 0; }));

  near[0]->send("bye");
  near[0]->close();
  network->flush();
  ASSERT_TRUE(runUntil([&] { return far->closed && !closed.empty(); }));
  EXPECT_EQ(far->frames.back(), "bye");
  EXPECT_EQ(closed, std::vector<CloseReason>{CloseReason::kLocal});
}

TEST_F(NetworkThreadTest, DestroyedChannelClosesItsConnection) {
  listen();
  const auto far = connect();
  near.clear();
  network->flush();
  EXPECT_TRUE(runUntil([&] { return far->closed; }));
}

TEST_F(NetworkThreadTest, UnsentBytesStayWhileAPeerDoesNotRead) {
  listen();
  const auto far = connect();
  // Send until the kernel's buffers, of any size, are full.
  for (std::size_t before = 0, quiet = 0; quiet < 20;) {
    if (near[0]->unsentBytes() < 100'000) near[0]->send(std::string(16'000, 'x'));
    network->flush();
    std::this_thread::sleep_for(1ms);
    const std::size_t now = near[0]->unsentBytes();
    quiet = now == before && now >= 100'000 ? quiet + 1 : 0;
    before = now;
  }
  EXPECT_TRUE(runUntil([&] { return near[0]->unsentBytes() == 0; })) << "now that the peer reads";
}

TEST_F(NetworkThreadTest, InputOverflowClosesOnlyItsStreamAndIsCounted) {
  listen({.stream_in = 10'000});
  const auto loud = connect();
  const auto quiet = connect();
  for (int i = 0; i < 500; ++i) loud->channel->send(std::string(100, 'x'));
  quiet->channel->send("still here");
  ASSERT_TRUE(runUntil([&] { return loud->closed; }, true)) << "although nothing is taken";
  ASSERT_TRUE(runUntil([&] { return closed.size() == 1 && !heard.empty() && heard.back() == "still here"; }));
  EXPECT_EQ(closed[0], CloseReason::kOverflow);
  EXPECT_LE(heard.size(), 10'000u / 100);
  network->stop();
  EXPECT_EQ(network->counters().streams_overflowed, 1u);
}

TEST_F(NetworkThreadTest, OutputOverflowClosesTheStreamAndIsCounted) {
  listen();
  const auto far = connect();
  for (int i = 0; i < 100; ++i) near[0]->send(std::string(16'000, 'x'));  // without flush()
  network->flush();
  ASSERT_TRUE(runUntil([&] { return !closed.empty(); }));
  EXPECT_EQ(closed[0], CloseReason::kOverflow);
  network->stop();
  EXPECT_EQ(network->counters().streams_clogged, 1u);
}

TEST_F(NetworkThreadTest, ConnectionsThatAreNotServedAreBounded) {
  listen({.unaccepted = 3});
  std::vector<std::unique_ptr<Far>> far;
  for (int i = 0; i < 5; ++i) far.push_back(connect(true));
  ASSERT_TRUE(runUntil([&] { return far[3]->closed && far[4]->closed; }, true));
  ASSERT_TRUE(runUntil([&] { return near.size() == 3; }));
  EXPECT_FALSE(far[0]->closed || far[1]->closed || far[2]->closed);
  far.push_back(connect());
  ASSERT_EQ(near.size(), 4u) << "met, they count no longer";
  network->stop();
  EXPECT_EQ(network->counters().unaccepted, 2u);
}

/// The client's end of a session's datagrams.
struct FarDatagrams {
  FarDatagrams(asio::io_context& context, std::uint16_t port, std::uint64_t id)
      : socket(context, UdpOptions{}), link({SealedLink::Role::kClient, ConnectionId{id}, {}, {}}) {
    link.setServerPath({{}, *makeEndpoint("127.0.0.1", port)});
    socket.start([this](const Path& path, std::string_view packet) {
      const auto payload = link.open(path, packet, Clock::now());
      if (!payload) return;
      if (link.needsToSend(Clock::now())) send({});
      if (!payload->empty()) heard.emplace_back(*payload);
    });
  }
  void key(const ReliableChannel& stream, Epoch epoch) {
    const KeyExporter exporter = [&](std::string_view label, std::string_view context, std::size_t bytes) {
      return stream.exportSecret(label, context, bytes);
    };
    ASSERT_TRUE(link.startEpoch(epoch, deriveDatagramKeys(exporter, AeadId::kAes128Gcm, link.id(), epoch),
                                Clock::now()));
  }
  void send(std::string_view payload) {
    const auto outgoing = link.seal(payload, Clock::now());
    ASSERT_TRUE(outgoing);
    socket.send(outgoing->path, outgoing->packet);
    socket.flush();
  }
  UdpSocket socket;
  SealedLink link;
  std::vector<std::string> heard;
};

TEST_F(NetworkThreadTest, DatagramsTakeKeysFromTheirStreamAndItsSuccessor) {
  listen({}, true);
  ASSERT_TRUE(network->hasDatagrams());
  const auto far = connect();
  datagrams = network->openDatagrams(*near[0], AeadId::kAes128Gcm);
  ASSERT_NE(datagrams, nullptr);
  std::vector<std::string> came;
  datagrams->start([&](std::string_view bytes) { came.emplace_back(bytes); });
  EXPECT_FALSE(datagrams->payloadBudget()) << "no address is known yet";
  network->flush();

  FarDatagrams client_end(client, network->port(), datagrams->id());
  client_end.key(*far->channel, datagrams->epoch());
  const auto says = [&](const std::string& what) {
    return runUntil([&] {
      client_end.send(what);  // repeat: the keys may arrive later
      return !came.empty() && came.back() == what;
    });
  };
  ASSERT_TRUE(says("hello"));
  EXPECT_TRUE(runUntil([&] { return datagrams->payloadBudget() == 1172u; }))
      << "once the address has proved itself";
  const auto answers = [&](const std::string& what) {
    datagrams->send(what);
    network->flushTick(Clock::now());
    return runUntil([&] { return !client_end.heard.empty() && client_end.heard.back() == what; });
  };
  EXPECT_TRUE(answers("welcome"));
  EXPECT_GE(network->tickTimes().count(), 1u);

  const auto next = connect();
  EXPECT_FALSE(datagrams->renew(*near[1], datagrams->epoch())) << "not newer";
  ASSERT_TRUE(datagrams->renew(*near[1], datagrams->epoch() + 1));
  network->flush();
  client_end.key(*next->channel, datagrams->epoch());
  EXPECT_TRUE(answers("with new keys"));
  EXPECT_TRUE(says("me, too"));
  network->stop();
  EXPECT_EQ(network->counters().keyless, 0u);
}

TEST_F(NetworkThreadTest, AStreamThatIsGoneGivesNoKeys) {
  listen({}, true);
  auto far = connect();
  far.reset();
  ASSERT_TRUE(runUntil([&] { return !closed.empty(); }));
  datagrams = network->openDatagrams(*near[0], AeadId::kAes128Gcm);
  ASSERT_NE(datagrams, nullptr);
  datagrams->send("to no receiver");
  network->flush();
  network->stop();
  EXPECT_FALSE(datagrams->payloadBudget());
  EXPECT_EQ(network->counters().keyless, 1u);
}

TEST_F(NetworkThreadTest, FullMailboxDropsAndCountsDatagrams) {
  listen({.mailbox = 20'000}, true);
  const auto far = connect();
  datagrams = network->openDatagrams(*near[0], AeadId::kAes128Gcm);
  int came = 0;
  datagrams->start([&](std::string_view) { ++came; });
  network->flush();
  FarDatagrams client_end(client, network->port(), datagrams->id());
  client_end.key(*far->channel, datagrams->epoch());
  ASSERT_TRUE(runUntil([&] {
    client_end.send("hello");
    return came > 0 && datagrams->payloadBudget() == 1172u;
  }));
  for (int i = 0; i < 30; ++i) datagrams->send(std::string(1000, 'x'));  // without flush()
  network->stop();
  EXPECT_GE(network->counters().datagrams_out_dropped, 10u);
  EXPECT_LE(network->counters().datagrams_out_dropped, 12u);
  for (int i = 0; i < 60; ++i) client_end.send(std::string(1000, 'x'));
  EXPECT_TRUE(runUntil(
      [&] {  // the network thread receives, but the tick thread takes nothing
        network->start();
        client.run_for(1ms);
        network->stop();
        return network->counters().datagrams_in_dropped >= 35;
      },
      true));
}

TEST(MailboxTest, NothingIsLostBetweenTwoThreads) {
  constexpr int kCount = 200'000;
  const auto textOf = [](int i) { return i % 3 == 0 ? std::string() : std::to_string(i); };
  Mailbox<int> box;
  std::thread writer([&] {
    Batch<int> batch;
    for (int i = 0; i < kCount; ++i) {
      batch.add(i, textOf(i));
      if (i % 7 == 0) box.push(batch);
    }
    box.push(batch);
    EXPECT_TRUE(batch.empty());
  });
  Batch<int> batch;
  int next = 0;
  while (next < kCount) {
    int header = 0;
    std::string_view bytes;
    while (batch.read(header, bytes)) {
      ASSERT_EQ(header, next);
      ASSERT_EQ(bytes, textOf(next));
      ++next;
    }
    box.popAll(batch);
  }
  writer.join();
  EXPECT_EQ(box.size(), 0u);
}

TEST(TickTimesTest, QuantilesAreRoundedUpByASixteenthAtMost) {
  TickTimes times;
  EXPECT_EQ(times.quantile(0.99), 0us);
  for (int i = 1; i <= 1000; ++i) times.add(std::chrono::microseconds(37 * i));
  EXPECT_EQ(times.count(), 1000u);
  for (const double share : {0.1, 0.5, 0.9, 0.99}) {
    const double exact = 37 * 1000 * share;
    EXPECT_GE(static_cast<double>(times.quantile(share).count()), exact) << share;
    EXPECT_LE(static_cast<double>(times.quantile(share).count()), exact * 17 / 16 + 38) << share;
  }
  times.reset();
  EXPECT_EQ(times.count(), 0u);
}

TEST(TickTimesTest, ExtremeDurationsHaveABucket) {
  TickTimes times;
  times.add(-5ns);
  times.add(0ns);
  EXPECT_EQ(times.quantile(1), 1us);
  times.add(48h);
  EXPECT_GT(times.quantile(1), 1h);
}

}  // namespace
}  // namespace naiad
