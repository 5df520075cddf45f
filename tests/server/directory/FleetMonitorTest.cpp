// FleetMonitor: the list of servers follows the messages of the bus, and stays for some time when the bus is
// down.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "FakeBus.h"
#include "SamplePresence.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

class FleetMonitorTest : public testing::Test {
 protected:
  void hear(const std::string& id) {
    bus.heard.push_back({presenceSubject(id), test::presenceOf(id).payload()});
  }
  /// Updates once a second up to this time.
  void update(std::chrono::seconds at) {
    for (now = std::min(now + 1s, at); now < at; now += 1s) watch.update(FleetMonitor::Time{} + now);
    watch.update(FleetMonitor::Time{} + now);
  }

  std::chrono::seconds now{0};
  std::vector<std::string> lines;
  test::FakeBus* p_bus = new test::FakeBus();
  test::FakeBus& bus = *p_bus;
  FleetMonitor watch{std::unique_ptr<Bus>(p_bus), [this](const std::string& line) { lines.push_back(line); }};
};

TEST_F(FleetMonitorTest, SaysWhichServersComeAndGo) {
  bus.news = "the bus is connected";
  hear("a");
  update(0s);
  hear("a");
  update(2s);
  update(8s);
  EXPECT_EQ(lines,
            (std::vector<std::string>{"the bus is connected", "a joined the fleet", "a left the fleet"}));
}

TEST_F(FleetMonitorTest, WithoutABusTheListStaysForTenMinutes) {
  hear("a");
  update(1s);
  bus.connected = false;
  for (auto at = 2s; at < 600s; at += 1s) update(at);
  EXPECT_EQ(watch.servers().size(), 1u);
  for (auto at = 600s; at < 610s; at += 1s) update(at);
  EXPECT_EQ(watch.servers().size(), 0u);
}

TEST_F(FleetMonitorTest, ServersGetAFullTimeoutAfterABusOutage) {
  hear("a");
  hear("b");
  update(1s);
  bus.connected = false;
  for (auto at = 2s; at < 60s; at += 1s) update(at);
  bus.connected = true;
  update(60s);
  hear("a");
  update(64s);
  EXPECT_EQ(watch.servers().size(), 2u);
  update(65s);
  EXPECT_EQ(watch.servers().size(), 1u) << "b was not heard";
}

TEST_F(FleetMonitorTest, BusThatLosesMessagesExcusesSilenceForThreeMinutes) {
  for (const auto& [begin, loss_interval] : {std::pair(0s, 1s), std::pair(1000s, 5s)}) {
    hear("silent");
    hear("honest");
    now = begin;
    update(begin);
    for (auto at = 1s; at < 180s; at += 1s) {
      if (at % loss_interval == 0s) ++bus.lost;
      if (at == 100s) hear("honest");
      update(begin + at);
      ASSERT_EQ(watch.servers().size(), 2u) << at.count();
    }
    for (auto at = 180s; at < 190s; at += 1s) {
      ++bus.lost;
      update(begin + at);
    }
    EXPECT_EQ(watch.servers().size(), 1u) << "silent for three minutes";
    for (auto at = 190s; at < 196s; at += 1s) update(begin + at);
    EXPECT_EQ(watch.servers().size(), 0u) << "nothing is lost any more";
  }
}

TEST_F(FleetMonitorTest, PauseOfTheMachineRemovesNoServer) {
  hear("a");
  hear("b");
  update(1s);
  now = 100s;
  update(101s);
  EXPECT_EQ(watch.servers().size(), 2u);
  hear("a");
  update(106s);
  EXPECT_EQ(watch.servers().size(), 2u);
  update(107s);
  EXPECT_EQ(watch.servers().size(), 1u) << "b was not heard";
}

TEST_F(FleetMonitorTest, ServerFloodDoesNotFillTheLog) {
  for (int i = 0; i < 1000; ++i) hear("x" + std::to_string(i));
  update(0s);
  EXPECT_EQ(lines.size(), 100u);
  hear("y");
  update(1s);
  EXPECT_EQ(lines.at(100), "900 more servers joined or left");
  EXPECT_EQ(lines.at(101), "y joined the fleet");
}

}  // namespace
}  // namespace naiad
