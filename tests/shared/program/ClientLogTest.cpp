// Clients can cause only a limited number of log lines, and only of their own kinds.
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

#include "shared/program/ClientLog.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

class ClientLogTest : public testing::Test {
 protected:
  std::size_t count(const std::string& part) const {
    std::size_t found = 0;
    for (const std::string& line : lines) found += line.find(part) != std::string::npos ? 1 : 0;
    return found;
  }
  static std::string address(int host) {
    return "192.0." + std::to_string(host / 200) + "." + std::to_string(host % 200 + 1) + ":4000";
  }

  std::vector<std::string> lines;
  ClientLog log{[this](const std::string& line) { lines.push_back(line); }};
  ClientLog::Time now{1h};
};

TEST_F(ClientLogTest, AddressComesFirstAndRefusalIsQuoted) {
  log.logClientEvent("192.0.2.1:4000", "\"Ann\" joined", now);
  log.logRefusal("[2001:db8::1]:4000", "This server plays \"maze\".", now);
  const std::vector<std::string> expected{R"(192.0.2.1:4000 "Ann" joined)",
                                          R"([2001:db8::1]:4000 refused: "This server plays \"maze\".")"};
  EXPECT_EQ(lines, expected);
}

TEST_F(ClientLogTest, AddressAndMessageAreFields) {
  LogEvent::Fields facts;
  ClientLog keeper([&facts](const LogEvent& event) { facts = event.fields; });
  keeper.logClientEvent("192.0.2.1:4000", {"joined", "\"Ann\" joined", {{"player", "Ann"}}}, now);
  EXPECT_EQ(facts, (LogEvent::Fields{{"address", "192.0.2.1:4000"}, {"player", "Ann"}}));
  keeper.logRefusal("192.0.2.1:4000", "No.", now);
  EXPECT_EQ(facts, (LogEvent::Fields{{"address", "192.0.2.1:4000"}, {"sentence", "No."}}));
}

TEST_F(ClientLogTest, RefusalsPerPrefixLogOneLinePerSecond) {
  for (int i = 0; i < 10'000; ++i) {
    log.logRefusal("192.0.2.1:" + std::to_string(1024 + i), "No.", now);
    now += 1ms;
    log.update(now);
  }
  EXPECT_EQ(count("refused"), 10u);
  log.finish();
  EXPECT_EQ(lines.back(), "9990 more refusals were not logged");
}

TEST_F(ClientLogTest, TotalRefusalsLogTwentyLinesPerSecond) {
  for (int i = 0; i < 40'000; ++i) {
    log.logRefusal(address(i % 4000), "No.", now);
    now += 250us;
    log.update(now);
  }
  EXPECT_LE(count("refused"), 20u + 10u * 20u);
  EXPECT_GE(count("refused"), 190u);
  EXPECT_LE(count("not logged"), 2u);
}

TEST_F(ClientLogTest, RepeatedReturnsLogOneLinePerSecond) {
  for (int i = 0; i < 60'000; ++i) {
    log.logClientEvent("192.0.2.1:4000", "\"Ann\" is back", now);
    now += 1ms;
    log.update(now);
  }
  EXPECT_LE(count("is back"), 128u + 60u);
  log.logClientEvent("192.0.2.2:4000", "\"Bob\" joined", now);
  EXPECT_EQ(count("Bob"), 1u) << "others have lines of their own";
}

TEST_F(ClientLogTest, JoinsAndLeavesOfAClassAreAllLogged) {
  for (int i = 0; i < 64; ++i) log.logClientEvent("192.0.2.1:4000", "joined", now);
  for (int i = 0; i < 64; ++i) log.logClientEvent("192.0.2.1:4000", "left", now);
  EXPECT_EQ(lines.size(), 128u);
  log.finish();
  EXPECT_EQ(lines.size(), 128u) << "nothing was left out";
}

}  // namespace
}  // namespace naiad
