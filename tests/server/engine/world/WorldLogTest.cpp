#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engine/world/WorldLog.h"

namespace df::test {
namespace {

class Log : public testing::Test {
 protected:
  Log() {
    log.setSink([this](const std::string& line) { lines.push_back(line); });
  }

  std::vector<std::string> lines;
  WorldLog log;
};

TEST_F(Log, ClearForgetsOnceOnlyLines) {
  log.writeOnce("line");
  log.writeOnce("line");
  log.clear();
  log.writeOnce("line");
  EXPECT_EQ(lines.size(), 2u);
  EXPECT_EQ(log.refusals(), 0u);
}

TEST_F(Log, DifferentLinesAreBounded) {
  for (int i = 0; i < 1000; ++i) log.writeOnce(std::to_string(i));
  EXPECT_EQ(lines.size(), 500u);
  log.write("always");
  EXPECT_EQ(lines.back(), "always");
}

TEST_F(Log, ActivityLineWithoutAnActivityPageIsDropped) {
  log.addActivityLineOnce("line");
  log.writeOnce("line");
  EXPECT_EQ(lines, std::vector<std::string>{"line"});
}

}  // namespace
}  // namespace df::test
