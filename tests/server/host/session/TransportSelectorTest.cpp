#include <gtest/gtest.h>

#include "host/session/TransportSelector.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

class TransportSelectorTest : public testing::Test {
 protected:
  TransportSelectorTest() : selector(now) {}

  std::uint32_t send(bool as_datagram) {
    selector.markSent(++number, as_datagram, now);
    return number;
  }
  void hear(std::uint32_t newest, std::uint64_t mask = 0) { selector.acknowledge({newest, mask}, true, now); }
  void hearOnStream(std::uint32_t newest) { selector.acknowledge({newest, 0}, false, now); }
  void open() {
    send(true);
    hear(number);
    ASSERT_TRUE(selector.isOpen(now));
  }
  /// Runs ticks at 30 Hz with datagrams, each acknowledged after `round_trip`. Returns the last interval.
  std::uint32_t run(std::chrono::milliseconds time, std::chrono::milliseconds round_trip, double loss = 0) {
    std::uint32_t interval = 0;
    for (const auto end = now + time; now < end;) {
      const std::uint32_t sent = send(true);
      now += round_trip;
      hear(sent);
      interval = selector.interval(loss, now);
      if (round_trip < 33ms) now += 33ms - round_trip;
    }
    return interval;
  }

  TransportSelector::Time now{std::chrono::hours(1)};
  TransportSelector selector;
  std::uint32_t number = 0;
};

TEST_F(TransportSelectorTest, BeginsClosedAndProbesSoonThenEverySecond) {
  EXPECT_FALSE(selector.isOpen(now));
  int early = 0;
  int late = 0;
  for (int ms = 0; ms < 5000; ms += 10, now += 10ms) {
    if (!selector.wantsProbe(now)) continue;
    send(true);
    ++(ms < 1000 ? early : late);
  }
  EXPECT_EQ(early, 10);
  EXPECT_EQ(late, 4);
}

TEST_F(TransportSelectorTest, OneAcknowledgedProbeOpensIt) {
  const std::uint32_t probe = send(true);
  const std::uint32_t streamed = send(false);
  hear(streamed);
  EXPECT_FALSE(selector.isOpen(now)) << "what went on the stream says nothing of datagrams";
  hear(streamed, 1);
  EXPECT_EQ(probe + 1, streamed);
  EXPECT_TRUE(selector.isOpen(now));
  EXPECT_FALSE(selector.wantsProbe(now));
}

TEST_F(TransportSelectorTest, AcknowledgementOnTheStreamDoesNotOpenDatagrams) {
  const std::uint32_t probe = send(true);
  now += 20ms;
  hearOnStream(probe);
  EXPECT_FALSE(selector.isOpen(now));
  EXPECT_EQ(selector.roundTrip(), 20ms);
  now += 20ms;
  hear(probe);
  EXPECT_TRUE(selector.isOpen(now)) << "whichever came first";
  EXPECT_EQ(selector.roundTrip(), 20ms);
  for (int i = 0; i < 10; ++i) {
    now += 100ms;
    hearOnStream(send(true));
  }
  EXPECT_FALSE(selector.isOpen(now));
}

TEST_F(TransportSelectorTest, RepeatedAcknowledgementDoesNotKeepDatagramsOpen) {
  open();
  for (int i = 0; i < 12; ++i) {
    now += 100ms;
    hear(number);
  }
  EXPECT_FALSE(selector.isOpen(now));
}

TEST_F(TransportSelectorTest, AcknowledgementAfterTwoSecondsDoesNotOpenDatagrams) {
  const std::uint32_t old = send(true);
  now += 2000ms;
  hear(old);
  EXPECT_FALSE(selector.isOpen(now));
  const std::uint32_t recent = send(true);
  now += 1999ms;
  hear(recent);
  EXPECT_TRUE(selector.isOpen(now));
}

TEST_F(TransportSelectorTest, NewStreamTriggersAProbe) {
  now += 10s;
  send(true);
  now += 100ms;
  EXPECT_FALSE(selector.wantsProbe(now));
  selector.renew(now);
  EXPECT_TRUE(selector.wantsProbe(now));
}

TEST_F(TransportSelectorTest, ProbesEagerlyForAWhileAfterItWasOpen) {
  open();
  now += PathProbe::kOpenTime;
  int eager = 0;
  int late = 0;
  for (int ms = 1000; ms < 20'000; ms += 10, now += 10ms) {
    if (!selector.wantsProbe(now)) continue;
    send(true);
    ++(ms < 10'000 ? eager : late);
  }
  EXPECT_NEAR(eager, 36, 1);
  EXPECT_NEAR(late, 10, 1);
}

TEST_F(TransportSelectorTest, ProbesEagerlyWithoutAStream) {
  now += 60s;
  send(true);
  now += 250ms;
  EXPECT_FALSE(selector.wantsProbe(now, false));
  EXPECT_TRUE(selector.wantsProbe(now, true));
}

TEST_F(TransportSelectorTest, AcknowledgementOfUnsentNumbersIsIgnored) {
  hear(77, ~std::uint64_t{0});
  EXPECT_FALSE(selector.isOpen(now));
  EXPECT_EQ(selector.roundTrip().count(), 0);
}

TEST_F(TransportSelectorTest, MeasuresTheRoundTripOfTheNewest) {
  const std::uint32_t first = send(true);
  now += 30ms;
  const std::uint32_t second = send(true);
  now += 40ms;
  hear(second, 1);
  EXPECT_EQ(first + 1, second);
  EXPECT_EQ(selector.roundTrip(), 40ms);
  EXPECT_EQ(selector.shortestRoundTrip(), 40ms);
}

TEST_F(TransportSelectorTest, QueueingDelayLowersTheRateStepByStep) {
  EXPECT_EQ(run(2s, 20ms), 1u);
  EXPECT_EQ(run(900ms, 150ms), 1u);
  EXPECT_EQ(run(1s, 150ms), 2u);
  EXPECT_EQ(run(1s, 150ms), 3u);
  EXPECT_EQ(run(1s, 150ms), 6u);
  EXPECT_EQ(run(1s, 150ms), 6u);
}

TEST_F(TransportSelectorTest, RateRisesAStepAfterFiveGoodSeconds) {
  run(2s, 20ms);
  EXPECT_EQ(run(1300ms, 20ms, 0.3), 2u);
  EXPECT_EQ(run(1100ms, 20ms, 0.3), 3u);
  EXPECT_EQ(run(4900ms, 20ms), 3u);
  EXPECT_EQ(run(300ms, 20ms), 2u);
  EXPECT_EQ(run(4700ms, 20ms), 2u);
  EXPECT_EQ(run(400ms, 20ms), 1u);
}

TEST_F(TransportSelectorTest, LossUpTo15PercentKeepsTheRate) {
  EXPECT_EQ(run(20s, 20ms, 0.05), 1u);
  EXPECT_EQ(run(20s, 20ms, 0.15), 1u);
}

TEST_F(TransportSelectorTest, LossBurstsUnderASecondKeepTheRate) {
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(run(800ms, 20ms, 0.5), 1u);
    EXPECT_EQ(run(100ms, 20ms), 1u);
  }
}

}  // namespace
}  // namespace naiad
