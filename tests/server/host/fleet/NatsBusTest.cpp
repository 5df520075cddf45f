// Tests the bus with the real nats-server.
#include <gtest/gtest.h>

#include "host/fleet/Bus.h"
#include "host/fleet/BusQueue.h"
#include "shared/fleet/BusPayloads.h"

#ifdef NAIAD_NATS
#include <nats/nats.h>
#endif

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "NatsServer.h"
#include "tests/support/WaitUntil.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

BusMessage kept(int number) {
  return {"naiad.results.a", "result " + std::to_string(number), "round-0-" + std::to_string(number)};
}

TEST(BusQueue, DropsTheOldestAndKeepsOnlyNewestPresence) {
  BusQueue queue;
  for (int i = 0; i < 100; ++i) queue.push({"naiad.presence.a", std::to_string(i)});
  ASSERT_TRUE(queue.hasBestEffort());
  EXPECT_EQ(queue.popBestEffort().payload, "99");
  EXPECT_FALSE(queue.hasBestEffort());
  for (int i = 0; i < 2000; ++i) queue.push({"naiad.presence." + std::to_string(i), ""});
  EXPECT_EQ(queue.dropped(), 2000 - Bus::kMaxBestEffort);
  for (int i = 0; i < 5000; ++i) queue.push(kept(i));
  EXPECT_EQ(queue.dropped(), 2000 - Bus::kMaxBestEffort + 5000 - Bus::kMaxReliable);
  EXPECT_EQ(queue.frontReliable().id, kept(5000 - Bus::kMaxReliable).id);
  queue.ackReliable("round-0-0");
  EXPECT_EQ(queue.frontReliable().id, kept(5000 - Bus::kMaxReliable).id)
      << "it was dropped while it was on its way";
  queue.ackReliable(queue.frontReliable().id);
  EXPECT_EQ(queue.frontReliable().id, kept(5001 - Bus::kMaxReliable).id);
}

TEST(BusInbox, KeepsNewestPerSubjectAndIgnoresOversizedMessages) {
  BusInbox inbox;
  for (int i = 0; i < 1000; ++i) inbox.put("naiad.presence.loud", std::to_string(i));
  inbox.put("naiad.presence.quiet", "here");
  inbox.put("naiad.presence.long", std::string(kMaxBusPayload + 1, 'x'));
  inbox.put(std::string(BusInbox::kMaxSubject + 1, 'x'), "");
  const std::vector<BusMessage> taken = inbox.popAll();
  ASSERT_EQ(taken.size(), 2u);
  EXPECT_EQ(taken[0].payload, "999");
  EXPECT_EQ(taken[1].payload, "here");
  EXPECT_TRUE(inbox.popAll().empty());
  EXPECT_EQ(inbox.received(), 1003u);
  EXPECT_EQ(inbox.ignored(), 2u);
}

TEST(BusInbox, KnownSubjectKeepsItsPlaceAfterItWasRead) {
  BusInbox inbox;
  inbox.put("honest", "old");
  inbox.popAll();
  for (int pop = 0; pop < 2 * BusInbox::kMaxIdlePops; ++pop) {
    for (std::size_t i = 0; i <= BusInbox::kMaxSubjects; ++i) inbox.put(std::to_string(i), "");
    if (pop % BusInbox::kMaxIdlePops == 0) inbox.put("honest", "new");
    const std::vector<BusMessage> taken = inbox.popAll();
    EXPECT_EQ(taken.back().payload, pop % BusInbox::kMaxIdlePops == 0 ? "new" : "") << pop;
  }
  for (int pop = 0; pop <= BusInbox::kMaxIdlePops; ++pop) inbox.popAll();
  inbox.put("newcomer", "");
  EXPECT_EQ(inbox.popAll().size(), 1u) << "the others were forgotten";
}

TEST(BusInbox, FloodOfSubjectsDoesNotEvictExistingOnes) {
  BusInbox inbox;
  inbox.put("honest", "old");
  for (std::size_t i = 0; i < 2 * BusInbox::kMaxSubjects; ++i) inbox.put(std::to_string(i), "");
  inbox.put("honest", "new");
  EXPECT_EQ(inbox.ignored(), BusInbox::kMaxSubjects + 1);
  const std::vector<BusMessage> taken = inbox.popAll();
  EXPECT_EQ(taken.size(), BusInbox::kMaxSubjects);
  EXPECT_EQ(taken.back().payload, "new");
}

TEST(BusSettings, InvalidAddressesAreRejected) {
#ifdef NAIAD_NATS
  EXPECT_EQ(validateBusSettings({"nats://127.0.0.1:4222", "", ""}), "");
  EXPECT_EQ(validateBusSettings({"tls://bus.example", "file", "ca.pem"}), "");
  EXPECT_NE(validateBusSettings({"nats://bus", "", "ca.pem"}), "");
#endif
  for (const std::string url : {"nats://", "bus.example", "http://bus.example", "tls:/bus"})
    EXPECT_NE(validateBusSettings({url, "", ""}), "") << url;
}

#ifdef NAIAD_NATS

/// Floods the bus, and manages its streams.
class Member {
 public:
  explicit Member(const std::string& url) {
    if (natsConnection_ConnectTo(&m_p_connection, url.c_str()) != NATS_OK) return;
    natsConnection_JetStream(&m_p_stream, m_p_connection, nullptr);
  }
  ~Member() {
    jsCtx_Destroy(m_p_stream);
    natsConnection_Destroy(m_p_connection);
  }
  /// Sends messages as fast as possible, and waits until the bus has them.
  void flood(const std::string& subject, int count, std::size_t bytes) const {
    const std::string text(bytes, 'x');
    for (int i = 0; i < count; ++i) {
      ASSERT_EQ(natsConnection_Publish(m_p_connection, subject.c_str(), text.data(), static_cast<int>(bytes)),
                NATS_OK);
    }
    ASSERT_EQ(natsConnection_FlushTimeout(m_p_connection, 60'000), NATS_OK);
  }
  bool makeResults() const {
    const char* subjects[] = {"naiad.results.>"};
    jsStreamConfig config;
    jsStreamConfig_Init(&config);
    config.Name = "results";
    config.Subjects = subjects;
    config.SubjectsLen = 1;
    return js_AddStream(nullptr, m_p_stream, &config, nullptr, nullptr) == NATS_OK;
  }
  std::uint64_t results() const {
    jsStreamInfo* p_info = nullptr;
    if (js_GetStreamInfo(&p_info, m_p_stream, "results", nullptr, nullptr) != NATS_OK) return 0;
    const std::uint64_t count = p_info->State.Msgs;
    jsStreamInfo_Destroy(p_info);
    return count;
  }
  bool waitForResults(std::uint64_t count) const {
    return test::waitUntil([&] { return results() >= count; }) && results() == count;
  }

 private:
  natsConnection* m_p_connection = nullptr;
  jsCtx* m_p_stream = nullptr;
};

class NatsBusTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::NatsServer::isInstalled()) GTEST_SKIP() << "nats-server is not installed";
    ASSERT_TRUE(server.start()) << server.log();
  }
  static std::unique_ptr<Bus> connect(const std::string& url) { return connectBus({url, "", ""}); }
  std::unique_ptr<Bus> listen() const { return connectBus({server.url(), "", "", {"naiad.presence.*"}}); }

  test::NatsServer server;
};

TEST_F(NatsBusTest, DuplicateResultsAreStoredOnce) {
  const Member member(server.url());
  ASSERT_TRUE(member.makeResults());
  for (int times = 0; times < 2; ++times) {
    const auto bus = connect(server.url());
    ASSERT_TRUE(test::waitUntil([&] { return bus->isConnected(); }));
    for (const int number : {1, 2, 1, 3}) bus->publish(kept(number));
    bus->finish(60s);
    EXPECT_EQ(bus->counters().published, 4u);
    EXPECT_EQ(bus->popLogMessage(), "the bus is connected");
    EXPECT_EQ(bus->popLogMessage(), "");
  }
  EXPECT_EQ(member.results(), 3u);
}

TEST_F(NatsBusTest, BusOutageQueuesMessagesUpToALimit) {
  const auto bus = connect(server.url());
  ASSERT_TRUE(test::waitUntil([&] { return bus->isConnected(); }));
  bus->publish(kept(0));
  EXPECT_TRUE(test::waitUntil([&] { return bus->counters().failures > 0; })) << "there is no stream yet";
  {
    const Member member(server.url());
    ASSERT_TRUE(member.makeResults());
    EXPECT_TRUE(member.waitForResults(1));
  }
  EXPECT_TRUE(test::waitUntil([&] { return bus->counters().published == 1; }));
  server.kill();
  EXPECT_TRUE(test::waitUntil([&] { return !bus->isConnected(); }));
  const auto begin = std::chrono::steady_clock::now();
  for (int number = 1; number <= 4200; ++number) bus->publish(kept(number));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 5s) << "nothing waits";
  EXPECT_EQ(bus->counters().dropped, 4200u - Bus::kMaxReliable);
  EXPECT_TRUE(
      test::waitUntil([&] { return bus->popLogMessage().find("cannot be reached") != std::string::npos; }));
  ASSERT_TRUE(server.start()) << server.log();
  EXPECT_TRUE(test::waitUntil([&] { return bus->counters().published == 1 + Bus::kMaxReliable; }));
  EXPECT_EQ(bus->counters().connections, 2u);
  EXPECT_EQ(Member(server.url()).results(), 1 + Bus::kMaxReliable);
}

TEST_F(NatsBusTest, SubscriptionFiltersMessagesAndSurvivesABusRestart) {
  const auto ear = listen();
  const auto mouth = connect(server.url());
  for (const std::string text : {"here", "back"}) {
    ASSERT_TRUE(test::waitUntil([&] { return ear->isConnected() && mouth->isConnected(); }));
    std::vector<BusMessage> heard;
    // A client may be connected a moment before its subscription is active.
    EXPECT_TRUE(test::waitUntil([&] {
      mouth->publish({"naiad.other.a", "none of its"});
      mouth->publish({"naiad.presence.a", text});
      heard = ear->popMessages();
      return !heard.empty();
    }));
    ASSERT_EQ(heard.size(), 1u);
    EXPECT_EQ(heard[0].subject, "naiad.presence.a");
    EXPECT_EQ(heard[0].payload, text);
    if (text == "back") break;
    server.kill();
    ASSERT_TRUE(test::waitUntil([&] { return !ear->isConnected() && !mouth->isConnected(); }));
    ear->popMessages();
    ASSERT_TRUE(server.start()) << server.log();
  }
}

/// Returns the number of messages that were sent until the first was received: a client may be connected a
/// moment before its subscription is active.
std::uint64_t floodUntilReceived(const Member& members, const Bus& bus) {
  std::uint64_t sent = 0;
  EXPECT_TRUE(test::waitUntil([&] {
    members.flood("naiad.presence.first", 1, 1);
    ++sent;
    return bus.counters().received > 0;
  }));
  return sent;
}

/// Waits for messages until `bus` has had one of the subject.
bool receives(Bus& bus, const std::string& subject) {
  return test::waitUntil(
      [&] { return std::ranges::count(bus.popMessages(), subject, &BusMessage::subject) > 0; });
}

TEST_F(NatsBusTest, FloodCostsOnlyItsSendersMessages) {
  struct Flood {
    int count;
    std::size_t bytes;
    bool is_too_long;
  };
  const auto ear = listen();
  const Member members(server.url());
  floodUntilReceived(members, *ear);
  members.flood("naiad.presence.begin", 1, 1);
  ASSERT_TRUE(receives(*ear, "naiad.presence.begin"));
  for (const auto& [count, bytes, is_too_long] :
       {Flood{20'000, 100, false}, Flood{20'000, kMaxBusPayload, false}, Flood{30, 1'000'000, true}}) {
    const BusCounters before = ear->counters();
    members.flood("naiad.presence.loud", count, bytes);
    const std::string quiet = "naiad.presence.quiet" + std::to_string(bytes);
    members.flood(quiet, 1, 1);
    EXPECT_TRUE(receives(*ear, quiet)) << count << " of " << bytes;
    const BusCounters after = ear->counters();
    EXPECT_EQ(after.received - before.received, static_cast<std::uint64_t>(count) + 1);
    EXPECT_EQ(after.ignored - before.ignored, is_too_long ? 30u : 0u);
    EXPECT_EQ(after.lost, 0u);
  }
}

TEST_F(NatsBusTest, SilentBusIsDisconnectedBeforeServersExpire) {
  const auto ear = listen();
  const Member members(server.url());
  floodUntilReceived(members, *ear);
  for (int times = 0; times < 2; ++times) {
    const auto begin = std::chrono::steady_clock::now();
    server.pause();
    EXPECT_TRUE(test::waitUntil([&] { return !ear->isConnected(); }));
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 3 * Presence::kInterval);
    server.resume();
    EXPECT_TRUE(test::waitUntil([&] { return ear->isConnected(); }));
    const std::string quiet = "naiad.presence.quiet" + std::to_string(times);
    members.flood(quiet, 1, 1);
    EXPECT_TRUE(receives(*ear, quiet));
  }
  EXPECT_EQ(ear->counters().connections, 1u);
}

TEST_F(NatsBusTest, LostMessagesAreCounted) {
  const auto ear = connectBus({server.url(), "", "", {"naiad.presence.*"}}, 1);
  const Member members(server.url());
  std::uint64_t sent = floodUntilReceived(members, *ear);
  std::string logged = ear->popLogMessage();  // the warning, if messages were lost so soon
  const std::uint64_t uncertain = sent;       // before the bus knew the subscription
  EXPECT_TRUE(test::waitUntil([&] {
    members.flood("naiad.presence.loud", 1000, 1);
    sent += 1000;
    return ear->counters().lost > 0;
  }));
  const auto counted = [&] { return ear->counters().received + ear->counters().lost; };
  EXPECT_TRUE(test::waitUntil([&] { return counted() >= sent - uncertain + 1; }))
      << counted() << " of " << sent;
  EXPECT_LE(counted(), sent);
  logged += ear->popLogMessage();
  EXPECT_NE(logged.find("warning: messages of the bus were lost, because too many arrived"),
            std::string::npos);
  EXPECT_TRUE(ear->isConnected());
}

TEST_F(NatsBusTest, RefusedPasswordIsNotLogged) {
  test::NatsServer guarded("authorization {user: a, password: x}");
  ASSERT_TRUE(guarded.start()) << guarded.log();
  const auto stranger = connect(guarded.url("a:wrong"));
  EXPECT_TRUE(test::waitUntil([&] { return stranger->counters().failures > 0; }));
  const std::string news = stranger->popLogMessage();
  EXPECT_NE(news.find("cannot be reached"), std::string::npos) << news;
  EXPECT_EQ(news.find("wrong"), std::string::npos) << "no password in the log";
}

#endif

}  // namespace
}  // namespace naiad
